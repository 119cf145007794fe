// SPDX-License-Identifier: Apache-2.0
#include "apps/farm/farm_plan.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "vernier/error.h"

namespace vernier::apps {
namespace {

constexpr int format = 1;

}  // namespace

/// Without objects in it: Open Job Description takes two braces in a row for its own.
nlohmann::ordered_json to_json(const FarmPlan& plan) {
  nlohmann::ordered_json json{{"farm", format},
                              {"command", plan.command_line},
                              {"work", plan.work},
                              {"output", plan.output},
                              {"parts", plan.parts}};
  if (plan.is_animation()) {
    json["frames"] = plan.frames;
    return json;
  }
  json["first_seed"] = plan.seeds.first_seed;
  json["spp"] = plan.seeds.spp;
  json["most_spp"] = plan.seeds.most_spp;
  json["rounds"] = plan.seeds.rounds;
  json["error"] = plan.seeds.error;
  return json;
}

FarmPlan read_farm_plan(const std::string& path) {
  std::ifstream file(path);
  if (!file) throw Error(ErrorKind::input, path, {}, fmt::format("cannot be read: {}", std::strerror(errno)));
  FarmPlan plan;
  try {
    const auto json = nlohmann::json::parse(file);
    if (json.at("farm") != format)
      throw Error(ErrorKind::input, path, {}, "is of another version of Vernier; write the script again");
    json.at("command").get_to(plan.command_line);
    json.at("work").get_to(plan.work);
    json.at("output").get_to(plan.output);
    json.at("parts").get_to(plan.parts);
    if (json.contains("frames")) {
      json.at("frames").get_to(plan.frames);
    } else {
      json.at("first_seed").get_to(plan.seeds.first_seed);
      json.at("spp").get_to(plan.seeds.spp);
      json.at("most_spp").get_to(plan.seeds.most_spp);
      json.at("rounds").get_to(plan.seeds.rounds);
      json.at("error").get_to(plan.seeds.error);
    }
  } catch (const nlohmann::json::exception& error) {
    throw Error(ErrorKind::input, path, {},
                fmt::format("is no plan of 'vernier farm': {:.200}", error.what()));
  }
  constexpr int most_parts = 1'000'000;
  if (plan.parts < 1 || plan.parts > most_parts)
    throw Error(ErrorKind::input, path, {},
                fmt::format("is no plan of 'vernier farm': {} parts", plan.parts));
  return plan;
}

}  // namespace vernier::apps
