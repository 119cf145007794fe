// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/one_line.h"
#include "vernier/error.h"

// What the program says on standard error: one line each, "error: ...", "warning: ..." or "note: ...".

namespace vernier::apps {

void print_error(std::string_view text);

/// "warning: PLACE: TEXT" or "note: ..."
std::string describe(const Notice& notice);

/// The words of a command line as a shell would read them back: quoted where that is needed.
std::string shell_quoted(std::span<const char* const> words);
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace vernier::apps
