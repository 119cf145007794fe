// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>

#include "apps/farm/farm_script.h"
#include "apps/farm/farm_status.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/farm_flags.h"
#include "apps/vernier/messages.h"
#include "apps/vernier/picture_output.h"
#include "core/base/atomic_file.h"

namespace vernier::apps {
namespace {

struct Scheduler {
  const char* name;
  const char* description;
  std::string (*write)(const FarmPlan&);
  bool can_submit;
};
constexpr Scheduler schedulers[] = {
    {"slurm", "Write a script that submits a render to Slurm", slurm_script, true},
    {"sh", "Write a script that renders in parts on this machine, or on several by GNU parallel",
     shell_script, false},
    {"openjd", "Write a template for Open Job Description, as AWS Deadline Cloud takes it", openjd_template,
     false},
};

/// The program by its name, where $PATH finds it, else by its whole path.
std::string as_found_elsewhere(const std::string& program) {
  if (program.find('/') == std::string::npos) return program;
  return std::filesystem::absolute(program).lexically_normal().string();
}

/// Becomes the script, whose exit code is then this program's.
[[noreturn]] void submit(const FarmPlan& plan, const std::string& script) {
  const std::string file = plan.folder + "/farm.sh";
  make_folder_of(file);
  write_file(file, script);
  ::execlp("bash", "bash", file.c_str(), nullptr);
  throw Error(ErrorKind::input, fmt::format("bash cannot be run: {}", std::strerror(errno)));
}

ExitCode run_farm(const FarmFlags& flags, const CLI::App& command, const Scheduler& scheduler,
                  const Program& program) {
  if (print_requested_list(flags.render)) return ExitCode::done;
  FarmPlan plan = make_farm_plan(flags, command);
  plan.command_line = program.command_line;
  plan.vernier = as_found_elsewhere(program.name);
  const std::string script = scheduler.write(plan);
  if (flags.submit) submit(plan, script);
  fmt::print("{}", script);
  return ExitCode::done;
}

void register_scheduler(CLI::App& farm, Program& program, const Scheduler& scheduler) {
  CLI::App* command = farm.add_subcommand(scheduler.name, scheduler.description);
  auto flags = std::make_shared<FarmFlags>();
  add_farm_flags(*command, *flags, scheduler.can_submit);
  command->footer(fmt::format("Example: vernier farm {} scene.glb -o out.exr --spp 4096 --parts 64 > farm.{}",
                              scheduler.name, scheduler.write == openjd_template ? "json" : "sh"));
  command->callback([&program, flags, command, &scheduler] {
    program.run = [&program, flags, command, &scheduler] {
      return run_farm(*flags, *command, scheduler, program);
    };
  });
}

void register_status(CLI::App& farm, Program& program) {
  CLI::App* command = farm.add_subcommand("status", "Say how far the parts of a farm are");
  auto folder = std::make_shared<std::string>();
  command->add_option("FOLDER", *folder, "folder of the parts: out.parts for out.exr")->type_name("");
  command->callback([&program, folder] {
    program.run = [folder] {
      if (folder->empty())
        throw Error(ErrorKind::usage, "missing FOLDER of the parts; see vernier farm status --help");
      fmt::print("{}", farm_status(*folder));
      return ExitCode::done;
    };
  });
}

}  // namespace

void register_farm(Program& program) {
  CLI::App* farm = program.app.add_subcommand("farm", "Share a render out to many machines");
  farm->require_subcommand(1);
  for (const Scheduler& scheduler : schedulers) register_scheduler(*farm, program, scheduler);
  register_status(*farm, program);
}

}  // namespace vernier::apps
