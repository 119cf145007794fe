// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/checkpointing.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/vernier/flags.h"
#include "core/base/atomic_file.h"
#include "core/base/quantities.h"
#include "integrators/render/checkpoint.h"

namespace vernier::apps {
namespace {

/// So that a job that may be killed and started again is one command.
bool begins_anew(const RenderFlags& flags) {
  std::error_code error;
  return flags.resume == flags.checkpoint && !std::filesystem::exists(flags.resume, error);
}

}  // namespace

void add_checkpoint_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Long renders");
  command
      .add_option("--checkpoint", flags.checkpoint,
                  "keep the state of the render in this file: now and then, and at its end (docs/resume.md)")
      ->type_name("FILE");
  command.add_option("--checkpoint-every", flags.checkpoint_every, "how often: 60s, 10m, 1h")
      ->check(parsed_by(parse_seconds))
      ->type_name("TIME")
      ->capture_default_str();
  command
      .add_option("--resume", flags.resume,
                  "go on from this checkpoint, to the limits given now; they count from the beginning")
      ->type_name("FILE");
  command.add_flag("--drop-checkpoint", flags.drop_checkpoint,
                   "remove the checkpoint when the picture is finished and written");
}

void require_resumable(const RenderFlags& flags) {
  if (!flags.resume.empty() && !begins_anew(flags)) require_checkpoint(flags.resume);
}

Checkpointing::Checkpointing(const RenderFlags& flags, NoticeLog& log) : flags_(flags), log_(log) {
  if (!flags.checkpoint.empty()) lock_.emplace(flags.checkpoint);
  if (flags.resume.empty()) return;
  require_resumable(flags);
  resumes_ = !begins_anew(flags);
  if (!resumes_)
    log.add({Notice::Severity::info,
             {},
             fmt::format("{} is not there yet; rendering from the beginning", flags.resume)});
}

void Checkpointing::attach(RenderSession& session) {
  if (resumes_) {
    log_.add(session.load(flags_.resume));
    resumed_ = session.status();
    log_.add({Notice::Severity::info,
              {},
              fmt::format("going on from {}: {:.4g} samples a pixel and {} are done", flags_.resume,
                          resumed_->samples_per_pixel, format_seconds(resumed_->seconds))});
  }
  if (!flags_.checkpoint.empty())
    session.on_checkpoint([this, &session] { write(session); }, parse_seconds(flags_.checkpoint_every));
}

void Checkpointing::write(const RenderSession& session) {
  const auto start = std::chrono::steady_clock::now();
  failure_.clear();
  try {
    session.save(flags_.checkpoint);
    ++written_;
  } catch (const Error& error) {
    failure_ = error.what();
    log_.add({Notice::Severity::warning, {}, failure_ + "; the render is not affected"});
  }
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Checkpointing::add_to(nlohmann::ordered_json& stats) const {
  if (resumed_)
    stats["resumed"] = {{"file", flags_.resume},
                        {"samples", resumed_->samples},
                        {"samples_per_pixel", resumed_->samples_per_pixel},
                        {"seconds", resumed_->seconds}};
  if (flags_.checkpoint.empty()) return;
  std::error_code error;
  const auto bytes = std::filesystem::file_size(flags_.checkpoint, error);
  stats["checkpoint"] = {{"file", flags_.checkpoint},
                         {"bytes", error ? 0 : bytes},
                         {"written", written_},
                         {"seconds", seconds_}};
}

void Checkpointing::require_written() const {
  if (!failure_.empty()) throw Error(ErrorKind::output, failure_);
}

void Checkpointing::drop_if_asked() const {
  std::error_code error;  // a file that stays does no harm
  if (flags_.drop_checkpoint) std::filesystem::remove(flags_.checkpoint, error);
}

}  // namespace vernier::apps
