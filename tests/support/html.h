// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <utility>
#include <vector>

// Reads pages that this program has written.

namespace vernier::test {

/// What stands in <script type="application/json" id="ID">; empty when there is no such element.
std::string script_data(const std::string& page, const std::string& id);

/// Width and height of each PNG inside the page, as their own headers have it, in order.
std::vector<std::pair<int, int>> inline_pictures(const std::string& page);

/// Whether the page asks for no other file.
bool is_self_contained(const std::string& page);

}  // namespace vernier::test
