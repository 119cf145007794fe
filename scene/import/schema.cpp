// SPDX-License-Identifier: Apache-2.0
#include "scene/import/schema.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string_view>

#include "vernier/error.h"

namespace vernier {
namespace {

using nlohmann::json;
using Kind = ValueRule::Kind;

std::string describe(const json& value) {
  if (value.is_structured())
    return value.is_array() ? fmt::format("an array of {}", value.size()) : "an object";
  std::string text = value.dump(-1, ' ', true, json::error_handler_t::replace);
  if (text.size() > 60) text = text.substr(0, 57) + "...";
  return text;
}

/// Where a value is; spelled out as a JSON pointer only when something is wrong with it.
struct Place {
  const Place* parent = nullptr;
  std::string_view name;
  size_t index = 0;

  std::string pointer() const {
    if (!parent) return "";
    return parent->pointer() + "/" + (name.empty() ? std::to_string(index) : std::string(name));
  }
};

std::string range_text(const ValueRule& rule) {
  const bool below = std::isfinite(rule.lower), above = std::isfinite(rule.upper);
  if (below && above) return fmt::format(" from {} to {}", rule.lower, rule.upper);
  if (below) return fmt::format(" of at least {}", rule.lower);
  return above ? fmt::format(" of at most {}", rule.upper) : "";
}

/// A number beyond single precision becomes its largest.
void clamp_to_float(json& number) {
  constexpr double largest = std::numeric_limits<float>::max();
  if (std::abs(number.get<double>()) > largest) number = std::copysign(largest, number.get<double>());
}

bool is_in_range(const json& number, const ValueRule& rule) {
  return number.get<double>() >= rule.lower && number.get<double>() <= rule.upper;
}

/// An empty list allows any value.
template <typename Value, typename Listed>
bool is_listed(const Value& value, const std::vector<Listed>& list) {
  return list.empty() ||
         std::any_of(list.begin(), list.end(), [&](const Listed& l) { return value == Value(l); });
}

/// Why a value stands for none where it may be left out; empty: it does not. Anything else that is wrong with
/// it is an error.
std::string reason_to_drop(const json& value, const ValueRule& rule) {
  if (value.is_null()) return "null is no value";
  if (rule.kind == Kind::array && rule.items[0].kind == Kind::number && value.is_array())
    for (const json& item : value)
      if (item.is_null()) return "null is no number";
  if (rule.kind == Kind::number && value.is_number() && !is_in_range(value, rule))
    return fmt::format("{} is not a number{}", describe(value), range_text(rule));
  // Extensions may add to enumerations.
  if (rule.kind == Kind::text && value.is_string() && !is_listed(value.get<std::string>(), rule.names))
    return fmt::format("{} is none of {}", describe(value), fmt::join(rule.names, ", "));
  if (rule.kind == Kind::integer && value.is_number() && !is_listed(value.get<double>(), rule.values))
    return fmt::format("{} is none of {}", describe(value), fmt::join(rule.values, ", "));
  return {};
}

class Checker {
 public:
  Checker(const json& root, const std::string& file) : root_(root), file_(file) {}

  void check_object(json& value, const ObjectSchema& schema, const Place& place) {
    if (!value.is_object()) fail(place, "expected an object", value);
    for (const auto& property : schema.properties) {
      const auto found = value.find(property.name);
      if (found == value.end()) {
        if (property.required)
          throw Error(ErrorKind::input, file_, place.parent ? place.pointer() : "/",
                      fmt::format("'{}' is missing", property.name));
      } else if (property.required || is_kept(value, found, property.value, place)) {
        check(*found, property.value, {&place, property.name});
      }
    }
    if (schema.others.empty()) return;
    for (auto member = value.begin(); member != value.end();) {
      const auto current = member++;
      if (is_kept(value, current, schema.others[0], place))
        check(*current, schema.others[0], {&place, current.key()});
    }
  }

  /// One warning for each property that counts as absent somewhere.
  std::vector<Notice> notices() const {
    std::vector<Notice> list;
    for (const auto& [name, first] : dropped_) {
      std::string text = first.reason + ", so the property counts as absent";
      if (first.count > 1)
        text += fmt::format("; {} more places have a '{}' like that", first.count - 1, name);
      list.push_back({Notice::Severity::warning, first.place, text});
    }
    return list;
  }

 private:
  struct Dropped {
    std::string place, reason;
    size_t count = 0;
  };

  /// Erases an optional member that stands for no value, which is counted.
  bool is_kept(json& object, json::iterator member, const ValueRule& rule, const Place& place) {
    const std::string reason = reason_to_drop(*member, rule);
    if (reason.empty()) return true;
    Dropped& dropped = dropped_[member.key()];
    if (dropped.count++ == 0) {
      dropped.place = Place{&place, member.key()}.pointer();
      dropped.reason = reason;
    }
    object.erase(member);
    return false;
  }

  void check(json& value, const ValueRule& rule, const Place& place) {
    switch (rule.kind) {
      case Kind::boolean:
        if (!value.is_boolean()) fail(place, "expected true or false", value);
        break;
      case Kind::integer:
        check_integer(value, rule, place);
        break;
      case Kind::index:
        check_index(value, rule, place);
        break;
      case Kind::number:
        if (!value.is_number() || !is_in_range(value, rule))
          fail(place, "expected a number" + range_text(rule), value);
        clamp_to_float(value);
        break;
      case Kind::text:
        check_text(value, rule, place);
        break;
      case Kind::object:
        check_object(value, *rule.object, place);
        break;
      case Kind::array:
        check_array(value, rule, place);
        break;
    }
  }

  void check_integer(json& value, const ValueRule& rule, const Place& place) const {
    const double largest = 9007199254740992.0;  // 2^53: every integer below is exact in a double
    if (value.is_number_float() && value.get<double>() == std::floor(value.get<double>()) &&
        std::abs(value.get<double>()) < largest)
      value = int64_t(value.get<double>());
    // The parser stores what is not negative as unsigned, which is what readers of sizes look for.
    if (value.is_number_integer() && !value.is_number_unsigned() && value.get<int64_t>() >= 0)
      value = uint64_t(value.get<int64_t>());
    if (!value.is_number_integer() || !is_in_range(value, rule))
      fail(place, "expected an integer" + range_text(rule), value);
    if (is_listed(value.get<double>(), rule.values)) return;
    fail(place, fmt::format("expected one of {}", fmt::join(rule.values, ", ")), value);
  }

  void check_index(json& value, const ValueRule& rule, const Place& place) {
    const auto [size, is_new] = sizes_.try_emplace(rule.target, 0);
    if (is_new) {
      const json::json_pointer target(rule.target);
      if (root_.contains(target)) size->second = root_.at(target).size();
    }
    if (size->second == 0)
      fail(place, fmt::format("{}, which it refers to, is missing or empty", rule.target), value);
    ValueRule range;
    range.lower = 0;
    range.upper = double(size->second) - 1;
    check_integer(value, range, place);
  }

  void check_text(const json& value, const ValueRule& rule, const Place& place) const {
    if (!value.is_string()) fail(place, "expected a string", value);
    if (is_listed(value.get<std::string>(), rule.names)) return;
    fail(place, fmt::format("expected one of {}", fmt::join(rule.names, ", ")), value);
  }

  void check_array(json& value, const ValueRule& rule, const Place& place) {
    if (!value.is_array()) fail(place, "expected an array", value);
    if (value.size() < rule.min_items || value.size() > rule.max_items)
      fail(place,
           fmt::format("expected {}{} items", rule.min_items == rule.max_items ? "" : "at least ",
                       rule.min_items),
           value);
    for (size_t i = 0; i < value.size(); ++i) check(value[i], rule.items[0], {&place, {}, i});
  }

  [[noreturn]] void fail(const Place& place, const std::string& expected, const json& found) const {
    throw Error(ErrorKind::input, file_, place.parent ? place.pointer() : "/",
                expected + ", found " + describe(found));
  }

  const json& root_;
  const std::string& file_;
  std::map<std::string, size_t> sizes_;
  std::map<std::string, Dropped> dropped_;  ///< by name of the property
};

}  // namespace

void check_against_schema(json& document, const ObjectSchema& schema, const std::string& file,
                          std::vector<Notice>& notices) {
  Checker checker(document, file);
  checker.check_object(document, schema, {});
  for (auto& notice : checker.notices()) notices.push_back(std::move(notice));
}

}  // namespace vernier
