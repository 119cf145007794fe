// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "apps/bench/bench.h"
#include "apps/validation/cases.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/outputs.h"
#include "core/base/atomic_file.h"
#include "core/base/names.h"
#include "core/base/quantities.h"

namespace vernier::apps {
namespace {

using Json = nlohmann::ordered_json;
using validation::Figure;
using validation::HardCase;

struct BenchStabilityFlags {
  int rays = 1'000'000;
  std::vector<std::string> accelerators{"all"};
  std::vector<std::string> cases;
  std::string json, markdown;
};

/// A case as measured.
struct Row {
  const HardCase* hard_case;
  uint64_t rays;                ///< asked for; 0 where the case has a fixed number of its own
  std::vector<Figure> figures;  ///< by accelerator
};

std::vector<const HardCase*> cases_named(const std::vector<std::string>& names) {
  std::vector<const HardCase*> cases;
  cases.reserve(validation::hard_cases().size() + names.size());
  for (const auto& name : names) cases.push_back(&find_by_name(validation::hard_cases(), "case", name));
  if (names.empty())
    for (const HardCase& hard_case : validation::hard_cases()) cases.push_back(&hard_case);
  return cases;
}

std::string figure_text(double value) {
  if (!std::isfinite(value)) return "none";
  return value >= 1000 && value < 1e7 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

std::string rays_text(const Row& row) { return row.rays ? format_count(double(row.rays)) : "-"; }

std::string markdown_table(const std::vector<Row>& rows,
                           const std::vector<const AcceleratorEntry*>& entries) {
  std::string head = "| case | figure | rays |", rule = "|---|---|---|";
  for (const AcceleratorEntry* entry : entries) {
    head += fmt::format(" {} |", entry->name);
    rule += "---|";
  }
  std::string text = head + "\n" + rule + "\n";
  for (const Row& row : rows) {
    text += fmt::format("| `{}` | {} | {} |", row.hard_case->name, row.hard_case->figure, rays_text(row));
    for (const Figure& figure : row.figures) text += fmt::format(" {} |", figure_text(figure.value));
    text += '\n';
  }
  return text;
}

Json row_json(const Row& row, const std::vector<const AcceleratorEntry*>& entries) {
  Json json = {{"case", row.hard_case->name}, {"figure", row.hard_case->figure}};
  if (row.rays) json["rays"] = row.rays;
  for (size_t i = 0; i < entries.size(); ++i) {
    const Figure& figure = row.figures[i];
    // JSON has no infinity: a gap that is never kept is null.
    Json cell = {{"value", std::isfinite(figure.value) ? Json(figure.value) : Json(nullptr)}};
    if (figure.count) cell.update({{"events", figure.count->events}, {"trials", figure.count->trials}});
    json["accelerators"][std::string(entries[i]->name)] = cell;
  }
  return json;
}

/// Measures one case and prints its line as it comes.
Row measure(const HardCase& hard_case, const std::vector<const AcceleratorEntry*>& entries, uint64_t rays) {
  const uint64_t most = hard_case.most_rays;
  Row row{&hard_case, most == 1 ? 0 : std::min(rays, most), {}};
  fmt::print("{:<20} {:>7}", hard_case.name, rays_text(row));
  for (const AcceleratorEntry* entry : entries) {
    row.figures.push_back(hard_case.measure(*entry, std::min(rays, most)));
    fmt::print(" {:>12}", figure_text(row.figures.back().value));
    std::fflush(stdout);
  }
  fmt::print("  {}\n", hard_case.figure);
  return row;
}

ExitCode run_bench_stability(const BenchStabilityFlags& flags, const Program& program) {
  const auto entries = accelerators_named(flags.accelerators);
  const auto cases = cases_named(flags.cases);
  for (const auto& path : {flags.json, flags.markdown})
    if (!path.empty()) check_writable(path);

  fmt::print("{:<20} {:>7}", "case", "rays");
  for (const AcceleratorEntry* entry : entries) fmt::print(" {:>12}", entry->name);
  fmt::print("\n");
  std::vector<Row> rows;
  rows.reserve(cases.size());
  for (const HardCase* hard_case : cases)
    rows.push_back(measure(*hard_case, entries, static_cast<uint64_t>(flags.rays)));

  Outputs outputs;
  if (!flags.json.empty()) {
    Json json = bench_header(program);
    for (const Row& row : rows) json["cases"].push_back(row_json(row, entries));
    outputs.attempt(
        [&] { write_file(flags.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n"); });
  }
  if (!flags.markdown.empty())
    outputs.attempt([&] { write_file(flags.markdown, markdown_table(rows, entries)); });
  return outputs.have_failed() ? ExitCode::input : ExitCode::done;
}

}  // namespace

void register_bench_stability(CLI::App& bench, Program& program) {
  CLI::App* command = bench.add_subcommand(
      "stability", "What each accelerator makes of the hard cases of ray geometry (docs/accuracy.md)");
  auto flags = std::make_shared<BenchStabilityFlags>();
  command->add_option("--rays", flags->rays, "at most, for each case and accelerator")
      ->transform(whole_number(1000, 1 << 30))
      ->type_name("N")
      ->capture_default_str();
  command->add_option("--accelerator", flags->accelerators, "which to measure, separated by commas, or all")
      ->delimiter(',')
      ->type_name("NAMES")
      ->capture_default_str();
  command->add_option("--cases", flags->cases, "which to measure, separated by commas (all)")
      ->delimiter(',')
      ->type_name("NAMES");
  command->add_option("--json", flags->json, "write the figures as JSON")->type_name("FILE");
  command->add_option("--markdown", flags->markdown, "write them as a Markdown table")->type_name("FILE");
  command->callback([&program, flags] {
    program.run = [&program, flags] { return run_bench_stability(*flags, program); };
  });
}

}  // namespace vernier::apps
