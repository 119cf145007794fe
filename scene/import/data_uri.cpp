// SPDX-License-Identifier: Apache-2.0
#include "scene/import/data_uri.h"

#include <algorithm>
#include <array>

namespace vernier {
namespace {

constexpr int not_a_digit = -1, white_space = -2;

int hex_digit(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  return c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
}

bool equal_in_any_case(std::string_view text, std::string_view lower) {
  return std::equal(text.begin(), text.end(), lower.begin(), lower.end(),
                    [](char a, char b) { return (a >= 'A' && a <= 'Z' ? a - 'A' + 'a' : a) == b; });
}

std::string_view without_spaces_at_end(std::string_view text) {
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

/// "...;base64", spaces allowed about the word.
bool says_base64(std::string_view header) {
  header = without_spaces_at_end(header);
  constexpr std::string_view word = "base64";
  if (header.size() < word.size() || !equal_in_any_case(header.substr(header.size() - word.size()), word))
    return false;
  return without_spaces_at_end(header.substr(0, header.size() - word.size())).ends_with(';');
}

std::array<int, 256> base64_table() {
  std::array<int, 256> table;
  table.fill(not_a_digit);
  const std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (size_t i = 0; i < digits.size(); ++i) table[uint8_t(digits[i])] = int(i);
  for (const char c : {' ', '\t', '\n', '\f', '\r'}) table[uint8_t(c)] = white_space;
  return table;
}

/// RFC 4648, section 4. Returns false on a character outside the alphabet or an impossible length.
bool decode_base64(std::string_view text, Bytes& bytes) {
  static const std::array<int, 256> table = base64_table();
  const auto is_padding = [](char c) { return c == '=' || table[uint8_t(c)] == white_space; };
  while (!text.empty() && is_padding(text.back())) text.remove_suffix(1);
  bytes = Bytes(text.size() * 3 / 4);
  uint32_t bits = 0;
  int held = 0;
  size_t written = 0, digits = 0;
  for (const char c : text) {
    const int digit = table[uint8_t(c)];
    if (digit == white_space) continue;
    if (digit == not_a_digit) return false;
    ++digits;
    bits = bits << 6 | uint32_t(digit);
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.data[written++] = uint8_t(bits >> held);
  }
  bytes.size = written;
  return digits % 4 != 1;
}

}  // namespace

bool is_data_uri(std::string_view uri) {
  constexpr std::string_view scheme = "data:";
  return equal_in_any_case(uri.substr(0, scheme.size()), scheme);
}

std::string percent_decoded(std::string_view text) {
  std::string decoded;
  decoded.reserve(text.size());
  for (size_t i = 0; i < text.size(); ++i) {
    if (text[i] == '%' && i + 2 < text.size() && hex_digit(text[i + 1]) >= 0 && hex_digit(text[i + 2]) >= 0) {
      decoded += char(hex_digit(text[i + 1]) * 16 + hex_digit(text[i + 2]));
      i += 2;
    } else {
      decoded += text[i];
    }
  }
  return decoded;
}

std::string decode_data_uri(std::string_view uri, Bytes& bytes) {
  uri = uri.substr(0, uri.find('#'));
  const size_t comma = uri.find(',');
  if (comma == std::string_view::npos) return "data URI without a comma";
  std::string_view data = uri.substr(comma + 1);
  std::string decoded;
  if (data.find('%') != std::string_view::npos) data = decoded = percent_decoded(data);
  if (says_base64(uri.substr(0, comma))) {
    if (!decode_base64(data, bytes)) return "data URI is not valid base64";
  } else {
    bytes = Bytes(data.size());
    std::copy(data.begin(), data.end(), bytes.data.get());
  }
  return bytes.size == 0 ? "data URI holds no data" : "";
}

}  // namespace vernier
