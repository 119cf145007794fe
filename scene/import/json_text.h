// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

namespace vernier {

/// Parses a scene file's JSON. Numbers that no double holds become the largest of their sign. Throws
/// Error(input) about `file`, by name when the text is UTF-16 or UTF-32, and when it is nested so deep that
/// walking it would need too much stack.
nlohmann::json parse_json(std::span<const uint8_t> text, const std::string& file);

}  // namespace vernier
