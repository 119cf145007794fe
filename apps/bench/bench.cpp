// SPDX-License-Identifier: Apache-2.0
#include "apps/bench/bench.h"
#include "vernier/version.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <nlohmann/json.hpp>

#include "apps/vernier/machine.h"
#include "core/base/names.h"
#include "core/base/parallel.h"

namespace vernier::apps {
namespace {

/// Every bench, in the order of `vernier bench --help`.
constexpr void (*benches[])(CLI::App&, Program&) = {
    register_bench_rays, register_bench_convergence, register_bench_stability, register_bench_calibration,
    register_bench_bias, register_bench_scale,       register_bench_profile,
};

}  // namespace

void register_bench(Program& program) {
  CLI::App* command = program.app.add_subcommand("bench", "Measure Vernier itself");
  command->require_subcommand(1);
  for (const auto add : benches) add(*command, program);
}

std::vector<const AcceleratorEntry*> accelerators_named(const std::vector<std::string>& names) {
  const bool all = std::find(names.begin(), names.end(), "all") != names.end();
  for (const auto& name : names)
    if (name != "all") find_by_name(accelerators(), "accelerator", name);
  std::vector<const AcceleratorEntry*> entries;
  for (const AcceleratorEntry& entry : accelerators())
    if (all || std::find(names.begin(), names.end(), entry.name) != names.end()) entries.push_back(&entry);
  return entries;
}

nlohmann::ordered_json bench_header(const Program& program) {
  return {{"vernier", version()},
          {"command", program.command_line},
          {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
          {"machine", {{"cpu", cpu_name()}, {"threads", thread_count()}}},
          {"built_with", build_versions()}};
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<size_t> widths;
  for (const auto& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows) {
    for (size_t i = 0; i < row.size(); ++i)
      text += i == 0 ? fmt::format("{:<{}}", row[i], widths[i]) : fmt::format("  {:>{}}", row[i], widths[i]);
    text += '\n';
  }
  return text;
}

double median(std::vector<double> values) {
  const size_t middle = values.size() / 2;
  std::sort(values.begin(), values.end());
  return values.size() % 2 ? values[middle] : (values[middle - 1] + values[middle]) / 2;
}

}  // namespace vernier::apps
