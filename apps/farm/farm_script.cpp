// SPDX-License-Identifier: Apache-2.0
#include "apps/farm/farm_script.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "apps/farm/farm_assets.h"
#include "apps/vernier/messages.h"
#include "core/base/one_line.h"
#include "vernier/error.h"
#include "vernier/version.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;

/// A file of scripts without the comment that it begins with, which is for those who read the program.
std::string_view body(std::string_view asset) { return asset.substr(asset.find("\n\n") + 1); }

std::string array(const std::string& name, const std::vector<std::string>& words) {
  return fmt::format("{}=({})\n", name, shell_quoted(words));
}

std::string text(const std::string& name, const std::string& value) {
  return fmt::format("{}={}\n", name, shell_quoted({value}));
}

/// What all scripts of a plan begin with: `about` says how this one is used.
std::string head(const FarmPlan& plan, std::string_view about) {
  std::string script = fmt::format("#!/usr/bin/env bash\n# Written by vernier {}: {}\n", version(),
                                   one_line(plan.command_line));
  script += about;
  script += "set -euo pipefail\n\n";
  // Machines that have it elsewhere say so in their environment.
  script += fmt::format("vernier=${{VERNIER:-{}}}\n", shell_quoted({plan.vernier}));
  script += text("folder", plan.folder);
  script += text("plan", to_json(plan).dump(-1, ' ', true, Json::error_handler_t::replace));
  script += array("render", plan.render);
  if (plan.is_animation()) return script + array("frames", plan.frames);
  const SeedParts& seeds = plan.seeds;
  script += fmt::format("parts={}\nfirst_seed={}\nspp={}\nmost_spp={}\nrounds={}\n", plan.parts,
                        seeds.first_seed, seeds.spp, seeds.most_spp, seeds.rounds);
  return script + array("merge", seeds.merge);
}

/// For animations the number of parts and rounds has no use in the parts' commands.
std::string counts(const FarmPlan& plan) {
  return plan.is_animation() ? fmt::format("parts={}\nrounds=1\n", plan.parts) : "";
}

std::string bodies(const FarmPlan& plan, std::string_view scheduler) {
  std::string script;
  for (const std::string_view asset :
       {farm_assets::common_sh, plan.is_animation() ? farm_assets::frames_sh : farm_assets::seeds_sh,
        scheduler})
    script += body(asset);
  return script;
}

/// Where no scheduler says how many threads a part has, the plan does.
FarmPlan with_threads(FarmPlan plan) {
  if (plan.threads > 0) plan.render.insert(plan.render.end(), {"--threads", fmt::format("{}", plan.threads)});
  return plan;
}

/// One step: a task for each part, or one task.
Json step(const std::string& name, const std::string& script, std::vector<std::string> arguments, int parts,
          const std::string& after) {
  Json json{{"name", name}};
  if (!after.empty()) json["dependencies"] = Json::array({{{"dependsOn", after}}});
  arguments.insert(arguments.begin(), {"{{Task.File.Script}}", "{{Param.Folder}}"});
  if (parts > 0) {
    json["parameterSpace"]["taskParameterDefinitions"] =
        Json::array({{{"name", "Part"}, {"type", "INT"}, {"range", fmt::format("1-{}", parts)}}});
    arguments.emplace_back("{{Task.Param.Part}}");
  }
  // Vernier needs the time to write its checkpoint.
  constexpr int notice_seconds = 120;
  json["script"] = {
      {"actions",
       {{"onRun",
         {{"command", "bash"},
          {"args", arguments},
          {"cancelation", {{"mode", "NOTIFY_THEN_TERMINATE"}, {"notifyPeriodInSeconds", notice_seconds}}}}}}},
      {"embeddedFiles", Json::array({{{"name", "Script"}, {"type", "TEXT"}, {"data", script}}})}};
  return json;
}

}  // namespace

std::string shell_script(const FarmPlan& plan) {
  return head(with_threads(plan),
              "#   bash SCRIPT              all of it on this machine; run it again to go on where it ended\n"
              "#   HOSTS=a,b bash SCRIPT    the same on these machines, by GNU parallel and ssh; they see "
              "this "
              "folder\n"
              "#   bash SCRIPT part NUMBER  one part, on any machine that sees this folder\n") +
         text("work", plan.work) + counts(plan) +
         fmt::format("skip_missing={}\n", int(plan.seeds.skip_missing)) + bodies(plan, farm_assets::sh_sh);
}

std::string slurm_script(const FarmPlan& plan) {
  std::vector<std::string> sbatch;
  if (plan.threads > 0) sbatch.push_back(fmt::format("--cpus-per-task={}", plan.threads));
  sbatch.insert(sbatch.end(), plan.sbatch.begin(), plan.sbatch.end());
  std::string script = head(plan, "#   bash SCRIPT   submits all of it; again, to go on where it ended\n") +
                       text("work", plan.work) + counts(plan) + text("name", plan.output);
  script += text("merge_when", plan.seeds.skip_missing ? "afterany" : "afterok");
  return script + array("sbatch", sbatch) + bodies(plan, farm_assets::slurm_sh);
}

std::string openjd_template(const FarmPlan& plan) {
  if (plan.seeds.skip_missing)
    throw Error(
        ErrorKind::usage,
        "--skip-missing: steps of Open Job Description wait for all of the tasks before them; leave it "
        "out, and merge what is there by 'vernier merge --skip-missing'");
  const std::string script = head(with_threads(plan), "") + bodies(plan, farm_assets::openjd_sh);
  if (script.find("{{") != std::string::npos || script.find("}}") != std::string::npos)
    throw Error(ErrorKind::usage,
                "Open Job Description takes {{ and }} for its own, and a flag has them; use another name");
  Json steps = Json::array();
  if (plan.is_animation()) {
    steps.push_back(step("Frames", script, {"part", "1"}, plan.parts, ""));
  } else {
    std::string after;
    for (int round = 1; round <= plan.seeds.rounds; ++round) {
      const std::string number = fmt::format("{}", round), suffix = plan.seeds.rounds > 1 ? number : "";
      steps.push_back(step("Parts" + suffix, script, {"part", number}, plan.parts, after));
      steps.push_back(step("Merge" + suffix, script, {"merge", number}, 0, "Parts" + suffix));
      after = "Merge" + suffix;
    }
  }
  // A default has to be relative; it counts from the folder of the template.
  const Json folder{{"name", "Folder"},
                    {"type", "PATH"},
                    {"objectType", "DIRECTORY"},
                    {"dataFlow", "INOUT"},
                    {"default", "."},
                    {"description", "All commands are run in it; the machines share it. It was " + plan.work +
                                        ", which has to be said unless the template is there."}};
  const Json job{{"specificationVersion", "jobtemplate-2023-09"},
                 {"name", fmt::format("vernier {:.100}", one_line(plan.output))},
                 {"parameterDefinitions", Json::array({folder})},
                 {"steps", steps}};
  return job.dump(2, ' ', true, Json::error_handler_t::replace) + "\n";
}

}  // namespace vernier::apps
