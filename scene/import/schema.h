// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "vernier/error.h"

namespace vernier {

struct ObjectSchema;

/// What a JSON value must be for the importer to use it.
struct ValueRule {
  enum class Kind { boolean, integer, index, number, text, object, array };

  Kind kind = Kind::object;
  double lower = -std::numeric_limits<double>::infinity();  ///< integer, number
  double upper = std::numeric_limits<double>::infinity();
  std::vector<std::string> names{};      ///< text: the values there are; empty: any
  std::vector<int> values{};             ///< integer: the values there are; empty: any in range
  std::string target{};                  ///< index: JSON pointer of the array it counts in
  const ObjectSchema* object = nullptr;  ///< object: its properties
  std::vector<ValueRule> items{};        ///< array: one rule for every item
  size_t min_items = 0, max_items = std::numeric_limits<size_t>::max();
};

struct PropertyRule {
  std::string name;
  ValueRule value;
  bool required = false;
};

/// Properties not listed are left alone, unless `others` (one rule) is there for them.
struct ObjectSchema {
  std::vector<PropertyRule> properties;
  std::vector<ValueRule> others;
};

/// Throws Error(input) with the JSON pointer of the first value that is missing or is not what `schema` says.
/// Three things are put right instead:
/// - whole numbers written as 3.0 where an integer is expected become integers;
/// - numbers beyond single precision become its largest ones;
/// - an optional property that is null, which is how JavaScript writes numbers that are not finite, a number
///   outside its range, or a value that is none of those there are, counts as absent, with a warning in
///   `notices`.
void check_against_schema(nlohmann::json& document, const ObjectSchema& schema, const std::string& file,
                          std::vector<Notice>& notices);

/// glTF 2.0 and the extensions that the importer reads (gltf_schema.cpp). After the check every type is right
/// and every index is in range.
const ObjectSchema& gltf_schema();

}  // namespace vernier
