// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace vernier::test {

/// Names of the fields of `json`, and of the objects in it, that a page of docs/ does not name in a code
/// span: `a.name`, `.name` or `name`. What `free` names holds names of its own and is not looked into.
std::vector<std::string> undocumented_fields(const nlohmann::json& json, const std::string& page,
                                             const std::vector<std::string>& free = {});

}  // namespace vernier::test
