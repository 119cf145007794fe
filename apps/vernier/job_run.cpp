// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/job_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <new>
#include <nlohmann/json.hpp>

#include "apps/vernier/checkpointing.h"
#include "apps/vernier/job_list.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/parse_failure.h"
#include "apps/vernier/picture_output.h"
#include "apps/vernier/render_run.h"
#include "apps/vernier/stopwatch.h"

namespace vernier::apps {
namespace {

namespace fs = std::filesystem;

/// The words that are beside the list, which is named by one of them or by two.
std::vector<std::string> without_list(const std::vector<std::string>& words) {
  std::vector<std::string> others;
  for (size_t i = 0; i < words.size(); ++i) {
    if (words[i] == "--jobs") {
      ++i;
    } else if (!words[i].starts_with("--jobs=")) {
      others.push_back(words[i]);
    }
  }
  return others;
}

std::vector<JobLine> read_list(const std::string& list) {
  if (is_standard_stream(list)) return read_job_list(std::cin, "stdin");
  std::error_code unknown;
  std::ifstream stream(list);
  if (!stream)
    throw Error(ErrorKind::input, list, {}, fmt::format("cannot be read: {}", std::strerror(errno)));
  if (fs::is_directory(list, unknown))
    throw Error(ErrorKind::input, list, {}, "is a folder; expected a list");
  return read_job_list(stream, list);
}

/// What a list says that is the whole run's to say.
void refuse_run_flags(const JobLine& line) {
  for (const std::string& word : line.words)
    for (const char* flag : {"--jobs", "--progress"})
      if (word.substr(0, word.find('=')) == flag)
        throw Error(ErrorKind::usage, fmt::format("{} is for all jobs; give it beside the list", flag));
}

class JobRun {
 public:
  JobRun(const RenderFlags& flags, const std::vector<std::string>& words)
      : list_(flags.run.jobs),
        name_(is_standard_stream(list_) ? "stdin" : list_),
        keeps_going_(flags.run.keep_going),
        words_(without_list(words)) {}

  ExitCode execute() {
    lines_ = read_list(list_);
    if (lines_.empty())
      throw Error(ErrorKind::input, name_, {},
                  "has no jobs; expected scenes and flags of vernier render on a line");
    runs_.resize(lines_.size());
    for (size_t job = 0; job < lines_.size(); ++job)
      attempt(job, [&] { runs_[job] = make_run(lines_[job]); });
    for (size_t job = 0; job < lines_.size() && !is_over_; ++job)
      if (runs_[job]) attempt(job, [&] { render(job); });
    if (failed_ > 0) print_error(fmt::format("{} of {} jobs failed", failed_, lines_.size()));
    return is_stopped_ && code_ == ExitCode::done ? ExitCode::stopped : code_;
  }

 private:
  /// Where a job fails, that is told with its line, at once and going on or as the run's only error.
  template <typename Action>
  void attempt(size_t job, const Action& action) {
    const std::string line = place_of(lines_[job]);
    try {
      try {
        const JobScope scope(fmt::format("{}: {}", name_, line), job + 1, lines_.size());
        action();
      } catch (const Error& error) {
        throw Error(error.kind(), name_, line, error.what());
      } catch (const std::bad_alloc&) {
        throw Error(ErrorKind::memory, name_, line, "out of memory");
      }
    } catch (const Error& error) {
      if (!keeps_going_) throw;
      print_error(error.what());
      fail(exit_code(error.kind()));
    }
  }

  /// All that can be checked of a job before it is rendered.
  std::unique_ptr<RenderRun> make_run(const JobLine& line) {
    refuse_run_flags(line);
    std::vector<std::string> words = words_;
    words.insert(words.end(), line.words.begin(), line.words.end());
    CLI::App app;
    app.name("vernier");
    CLI::App* command = app.add_subcommand("render");
    RenderFlags flags;
    add_render_flags(*command, flags);
    add_checkpoint_flags(*command, flags);
    for (CLI::Option* option : command->get_options())  // what a line says stands in place of what all have
      if (option->get_items_expected_max() <= 1) option->take_last();
    try {
      app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
    } catch (const CLI::ParseError& error) {
      throw Error(ErrorKind::usage, parse_failure(app, error));
    }
    RenderRequest request = check_render_flags(flags);
    RunPlan plan = make_plan(request.flags);
    check_files(request.flags, plan);
    claim_files(line, request.flags, plan);
    words.insert(words.begin(), "vernier");
    return std::make_unique<RenderRun>(std::move(request), std::move(plan), PictureCommand(*command),
                                       shell_quoted(words), resources_);
  }

  /// Jobs may read the same files, but none may write what another reads or writes.
  void claim_files(const JobLine& line, const RenderFlags& flags, const RunPlan& plan) {
    const auto claim = [&](const std::string& file, bool writes) {
      if (file.empty() || (!writes && is_standard_stream(file))) return;
      std::error_code unknown;
      const fs::path whole = is_standard_stream(file) ? fs::path(file) : fs::weakly_canonical(file, unknown);
      const auto [first, is_new] = claims_.try_emplace(unknown ? file : whole.string(), Claim{&line, writes});
      if (is_new || (!first->second.writes && !writes) || first->second.line == &line) return;
      throw Error(ErrorKind::usage, file, {},
                  fmt::format("is {} by the job of {}; {}", first->second.writes ? "written" : "read",
                              place_of(*first->second.line),
                              writes ? "name another output" : "read it in a run of its own"));
    };
    for (const std::string& file : files_read(flags, plan)) {
      if (is_standard_stream(file) && is_standard_stream(list_))
        throw Error(ErrorKind::usage, "- cannot be a scene: standard input is the list of jobs");
      claim(file, false);
    }
    for (const std::string& file : files_written(flags, plan)) claim(file, true);
  }

  void render(size_t job) {
    RenderRun& run = *runs_[job];
    Stopwatch watch;
    print_event({{"event", "job"}, {"line", lines_[job].number}, {"command", run.command_line()}});
    const auto next = std::find_if(runs_.begin() + ptrdiff_t(job) + 1, runs_.end(),
                                   [](const auto& r) { return r != nullptr; });
    run.set_next(next == runs_.end() ? nullptr : next->get());
    place_.pictures_after = 0;
    for (auto later = next; later != runs_.end(); ++later)
      if (*later) place_.pictures_after += (*later)->planned();
    const ExitCode code = run.execute(place_);
    place_.pictures_before += run.done();
    place_.rendered_before += run.rendered();
    is_stopped_ = run.is_stopped();
    is_over_ = is_stopped_ || (code != ExitCode::done && !keeps_going_);
    print_event({{"event", "job_finished"}, {"exit_code", int(code)}, {"seconds", watch.lap()}});
    if (code != ExitCode::done && !is_stopped_) fail(code);
  }

  /// The first failure makes the exit code.
  void fail(ExitCode code) {
    if (code_ == ExitCode::done) code_ = code;
    ++failed_;
  }

  struct Claim {
    const JobLine* line;
    bool writes;
  };

  const std::string list_, name_;
  const bool keeps_going_;
  const std::vector<std::string> words_;
  std::vector<JobLine> lines_;
  RunResources resources_;
  std::vector<std::unique_ptr<RenderRun>> runs_;  ///< null: what failed before
  std::map<std::string, Claim> claims_;
  PlaceAmongRuns place_;
  ExitCode code_ = ExitCode::done;
  size_t failed_ = 0;
  bool is_stopped_ = false, is_over_ = false;
};

}  // namespace

ExitCode run_jobs(const RenderFlags& flags, const std::vector<std::string>& words) {
  return JobRun(flags, words).execute();
}

}  // namespace vernier::apps
