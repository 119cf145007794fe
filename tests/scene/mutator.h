// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

namespace vernier::test {

/// Random damage, a function of the seed alone.
class Mutator {
 public:
  explicit Mutator(uint64_t seed) : engine_(seed) {}

  /// One value of the document becomes another, goes, or trades places with its neighbors' kind.
  void change(nlohmann::json& document) {
    using nlohmann::json;
    const json::json_pointer place = above(any_leaf(document));
    static const json values = {nullptr,
                                true,
                                -1,
                                0,
                                1,
                                2,
                                255,
                                65536,
                                2147483647,
                                4294967295u,
                                9007199254740993,
                                1e30,
                                3.5e38,
                                1.7e308,
                                0.5,
                                -1e-30,
                                "",
                                "VEC3",
                                "SCALAR",
                                "../x",
                                "data:,",
                                json::array(),
                                json::object(),
                                {0, 0, 0},
                                {{"index", 7}}};
    if (below(4) == 0 && !place.empty()) {
      json& parent = document[place.parent_pointer()];
      if (parent.is_object())
        parent.erase(place.back());
      else
        parent.erase(std::stoul(place.back()));
    } else if (below(3) == 0) {
      document[place] = json(document[any_leaf(document)]);
    } else {
      document[place] = values[below(values.size())];
    }
  }

  /// One stretch of bytes is turned, doubled or lost.
  void change(std::string& bytes) {
    const size_t at = below(bytes.size()), count = std::min(1 + below(8), bytes.size() - at);
    const size_t kind = below(4);
    if (kind == 0) bytes.erase(at, count);
    if (kind == 1) bytes.insert(at, bytes.substr(at, count));
    if (kind == 2) bytes[at] = char(bytes[at] ^ (1 << below(8)));
    if (kind == 3) bytes.replace(at, count, count, below(2) == 0 ? '\xff' : '\0');
  }

  size_t below(size_t n) { return size_t(engine_() % n); }

 private:
  /// What has no parts, and what is empty.
  static size_t leaves(const nlohmann::json& tree) {
    if (!tree.is_structured() || tree.empty()) return 1;
    size_t sum = 0;
    for (const auto& part : tree) sum += leaves(part);
    return sum;
  }
  /// Any of them is as likely as any other.
  nlohmann::json::json_pointer any_leaf(const nlohmann::json& document) {
    nlohmann::json::json_pointer place;
    const nlohmann::json* tree = &document;
    for (size_t left = below(leaves(document)); tree->is_structured() && !tree->empty();) {
      auto part = tree->begin();
      for (; left >= leaves(*part); ++part) left -= leaves(*part);
      if (tree->is_object())
        place.push_back(part.key());
      else
        place.push_back(std::to_string(part - tree->begin()));
      tree = &*part;
    }
    return place;
  }
  /// The place itself, or sometimes something that holds it.
  nlohmann::json::json_pointer above(nlohmann::json::json_pointer place) {
    while (!place.empty() && !place.parent_pointer().empty() && below(4) == 0) place = place.parent_pointer();
    return place;
  }

  std::mt19937_64 engine_;
};

}  // namespace vernier::test
