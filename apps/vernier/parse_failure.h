// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace vernier::apps {

/// Why a command line could not be parsed, in one line: what is wrong with it and what was probably meant.
std::string parse_failure(const CLI::App& app, const CLI::ParseError& error);

}  // namespace vernier::apps
