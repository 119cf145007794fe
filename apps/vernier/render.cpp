// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/checkpointing.h"
#include "apps/vernier/commands.h"
#include "apps/vernier/job_run.h"
#include "apps/vernier/render_run.h"

namespace vernier::apps {
namespace {

ExitCode run_render(const RenderFlags& flags, const CLI::App& command, const Program& program) {
  if (print_requested_list(flags)) return ExitCode::done;
  if (!flags.run.jobs.empty()) return run_jobs(flags, program.words);
  RenderRequest request = check_render_flags(flags);
  RunPlan plan = make_plan(request.flags);
  check_files(request.flags, plan);
  RunResources resources;
  RenderRun run(std::move(request), std::move(plan), PictureCommand(command), program.command_line,
                resources);
  return run.execute();
}

}  // namespace

void register_render(Program& program) {
  CLI::App* command = program.app.add_subcommand("render", "Render glTF scenes to pictures");
  auto flags = std::make_shared<RenderFlags>();
  add_render_flags(*command, *flags);
  add_jobs_flag(*command, flags->run);
  add_checkpoint_flags(*command, *flags);
  command->footer("Example: vernier render scene.glb -o out.exr -o out.png --time 1m");
  command->callback([&program, flags, command] {
    program.run = [&program, flags, command] { return run_render(*flags, *command, program); };
  });
}

}  // namespace vernier::apps
