// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <string_view>

namespace vernier {

/// `text` as one line of valid UTF-8 that a terminal shows and does not obey, whatever bytes a file put into
/// it: what is not UTF-8 becomes U+FFFD; line breaks, other control characters (escape sequences begin with
/// one) and marks that turn the direction of writing become spaces. Spaces at the end are dropped.
std::string one_line(std::string_view text);

}  // namespace vernier
