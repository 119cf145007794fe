// SPDX-License-Identifier: Apache-2.0
#include "tests/support/html.h"

#include <cstdint>
#include <regex>

namespace vernier::test {
namespace {

/// Bytes of the first `count` of a base64 text.
std::vector<uint8_t> decode_base64(const std::string& text, size_t count) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::vector<uint8_t> bytes;
  uint32_t bits = 0;
  int held = 0;
  for (size_t i = 0; i < text.size() && bytes.size() < count; ++i) {
    bits = bits << 6 | uint32_t(digits.find(text[i]));
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(uint8_t(bits >> held));
  }
  return bytes;
}

int big_endian(const uint8_t* p) { return p[0] << 24 | p[1] << 16 | p[2] << 8 | p[3]; }

}  // namespace

std::string script_data(const std::string& page, const std::string& id) {
  const std::string tag = "<script type=\"application/json\" id=\"" + id + "\">";
  const size_t begin = page.find(tag);
  if (begin == std::string::npos) return {};
  const size_t end = page.find("</script>", begin);
  return page.substr(begin + tag.size(), end - begin - tag.size());
}

std::vector<std::pair<int, int>> inline_pictures(const std::string& page) {
  const std::string start = "src=\"data:image/png;base64,";
  std::vector<std::pair<int, int>> sizes;
  for (size_t at = page.find(start); at != std::string::npos; at = page.find(start, at + 1)) {
    // A PNG's signature has 8 bytes; width and height follow 8 bytes of the first chunk's head.
    const auto bytes = decode_base64(page.substr(at + start.size(), 64), 24);
    const bool is_png = bytes.size() == 24 && bytes[0] == 0x89 && bytes[1] == 'P';
    sizes.emplace_back(is_png ? big_endian(&bytes[16]) : 0, is_png ? big_endian(&bytes[20]) : 0);
  }
  return sizes;
}

bool is_self_contained(const std::string& page) {
  const std::regex outside(R"re((src|href)="(?!data:)|@import|url\()re");
  // The program that draws charts is left out: it is long, and draws from the page's own data.
  const std::string markup = page.substr(0, page.rfind("</main>"));
  return !std::regex_search(markup, outside);
}

}  // namespace vernier::test
