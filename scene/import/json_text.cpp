// SPDX-License-Identifier: Apache-2.0
#include "scene/import/json_text.h"

#include <fmt/format.h>

#include <charconv>
#include <nlohmann/json.hpp>

#include "vernier/error.h"

namespace vernier {
namespace {

using nlohmann::json;

// tinygltf walks nested values recursively; real files stay below twenty levels.
constexpr int max_json_depth = 128;

/// Calls visit(i) for each byte that is outside of strings, until it returns false.
template <typename Visit>
void for_each_outside_strings(std::string_view text, const Visit& visit) {
  bool in_string = false;
  for (size_t i = 0; i < text.size(); ++i) {
    if (in_string && text[i] == '\\')
      ++i;
    else if (text[i] == '"')
      in_string = !in_string;
    else if (!in_string && !visit(i))
      return;
  }
}

/// Throws Error(input) when arrays and objects are nested deeper than max_json_depth.
void check_depth(std::string_view text, const std::string& file) {
  int depth = 0;
  for_each_outside_strings(text, [&](size_t i) {
    if (text[i] == '}' || text[i] == ']') --depth;
    if (text[i] != '{' && text[i] != '[') return true;
    if (++depth > max_json_depth)
      throw Error(ErrorKind::input, file, fmt::format("byte {}", i),
                  fmt::format("JSON nested deeper than {} levels", max_json_depth));
    return true;
  });
}

/// The text with numbers that overflow a double replaced by the largest of their sign.
std::string without_overflow(std::string_view text) {
  std::string result;
  size_t copied = 0;
  for_each_outside_strings(text, [&](size_t i) {
    const auto is_part = [&](size_t at) {
      return at < text.size() && std::string_view("+-.eE0123456789").find(text[at]) != std::string_view::npos;
    };
    if (i < copied || !is_part(i)) return true;
    size_t end = i;
    while (is_part(end)) ++end;
    double value = 0;
    const auto [stop, error] = std::from_chars(&text[i], &text[i] + (end - i), value);
    // Numbers that underflow are out of range as well; the parser makes them 0.
    const std::string_view digits = text.substr(i, end - i);
    const bool is_small = digits.find("e-") != digits.npos || digits.find("E-") != digits.npos ||
                          digits.starts_with("0.") || digits.starts_with("-0.");
    result.append(text, copied, i - copied);
    if (error == std::errc::result_out_of_range && !is_small)
      result += fmt::format("{}", std::numeric_limits<double>::max() * (text[i] == '-' ? -1 : 1));
    else
      result += digits;
    copied = end;
    return true;
  });
  return result.append(text, copied, text.npos);
}

/// Name of the encoding when the text is not UTF-8, by byte order mark or by where the zeros of ASCII are.
const char* foreign_encoding(std::string_view text) {
  using std::string_view_literals::operator""sv;
  if (text.starts_with("\xFF\xFE\0\0"sv) || text.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32";
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) return "UTF-16";
  if (text.size() < 4) return nullptr;
  const bool zeros[] = {text[0] == 0, text[1] == 0, text[2] == 0, text[3] == 0};
  const int count = zeros[0] + zeros[1] + zeros[2] + zeros[3];
  if (count == 3) return "UTF-32";
  return count == 2 && zeros[0] != zeros[1] ? "UTF-16" : nullptr;
}

}  // namespace

json parse_json(std::span<const uint8_t> bytes, const std::string& file) {
  const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  if (const char* encoding = foreign_encoding(text))
    throw Error(ErrorKind::input, file, "JSON",
                fmt::format("the text is {}; glTF is UTF-8, so save it as that", encoding));
  check_depth(text, file);
  try {
    try {
      return json::parse(text);
    } catch (const json::out_of_range&) {
      return json::parse(without_overflow(text));
    }
  } catch (const json::exception& e) {
    // "[json.exception.parse_error.101] parse error at line 3, column 5: ..." and the like.
    std::string message = e.what();
    if (const size_t end = message.find("] "); end != std::string::npos) message.erase(0, end + 2);
    if (message.size() > 300) message = message.substr(0, 297) + "...";
    throw Error(ErrorKind::input, file, "JSON", message);
  }
}

}  // namespace vernier
