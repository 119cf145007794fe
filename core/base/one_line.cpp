// SPDX-License-Identifier: Apache-2.0
#include "core/base/one_line.h"

#include <algorithm>
#include <boost/locale/utf.hpp>

namespace vernier {
namespace {

namespace utf = boost::locale::utf;

bool is_printable_ascii(char c) { return c >= 0x20 && c < 0x7f; }

/// Controls of ASCII and Latin-1, line and paragraph separators, and the directional marks of Unicode's
/// bidirectional algorithm (UAX 9, 2), which make text read otherwise than it is.
bool is_control(utf::code_point c) {
  return c < 0x20 || (c >= 0x7f && c < 0xa0) || c == 0x200e || c == 0x200f || (c >= 0x2028 && c <= 0x202e) ||
         (c >= 0x2066 && c <= 0x2069);
}

}  // namespace

std::string one_line(std::string_view text) {
  std::string line;
  if (std::all_of(text.begin(), text.end(), is_printable_ascii)) {
    line = text;
  } else {
    for (auto at = text.begin(); at != text.end();) {
      const auto start = at;
      const utf::code_point c = utf::utf_traits<char>::decode(at, text.end());
      if (c == utf::illegal || c == utf::incomplete) {
        // What follows a bad byte may be good, so only that one is passed over.
        at = start + 1;
        line += "\xEF\xBF\xBD";
      } else if (is_control(c)) {
        line += ' ';
      } else {
        line.append(start, at);
      }
    }
  }
  line.erase(line.find_last_not_of(' ') + 1);
  return line;
}

}  // namespace vernier
