// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "apps/vernier/commands.h"
#include "scene/accel/accelerator.h"

// What `vernier bench` measures: one file a bench. A bench is added by writing its file, declaring its
// registration function here and listing it in bench.cpp.

namespace vernier::apps {

// Each adds one subcommand to `bench`, with a callback that sets `program.run`, as commands.h says of
// commands.
void register_bench_rays(CLI::App& bench, Program& program);
void register_bench_convergence(CLI::App& bench, Program& program);
void register_bench_stability(CLI::App& bench, Program& program);
void register_bench_calibration(CLI::App& bench, Program& program);
void register_bench_bias(CLI::App& bench, Program& program);
void register_bench_scale(CLI::App& bench, Program& program);
void register_bench_profile(CLI::App& bench, Program& program);

/// The lines of accelerators() called by `names`, in the table's order; "all" is every one.
std::vector<const AcceleratorEntry*> accelerators_named(const std::vector<std::string>& names);

/// What a report says of the program, the machine and the day.
nlohmann::ordered_json bench_header(const Program& program);

/// Rows of equal length as lines of text, columns aligned: the first to the left, the others to the right.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

/// The middle value; of an even number, the mean of the two.
double median(std::vector<double> values);

}  // namespace vernier::apps
