// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/one_line.h"
#include "vernier/error.h"

// What the program says on standard error: one line each, "error: ...", "warning: ..." or "note: ...". After
// speak_json() everything there is for a program instead: one JSON object a line (docs/progress.md).

namespace vernier::apps {

/// From here on, in this process, with what is first said: `started`.
void speak_json(nlohmann::ordered_json started);
bool speaks_json();

/// While it lives, all that is said is about one job of several: lines begin with its place in their list,
/// and events have its number.
class JobScope {
 public:
  JobScope(std::string place, size_t job, size_t jobs);
  ~JobScope();
  JobScope(const JobScope&) = delete;
  JobScope& operator=(const JobScope&) = delete;
};

/// Says an event, an object with a field "event", if standard error is for a program; else nothing.
void print_event(const nlohmann::ordered_json& event);

/// Says an error, which is the event "failed".
void print_error(std::string_view text);

/// Says a warning or a note, which are events of these names.
void print_notice(const Notice& notice);

/// "warning: PLACE: TEXT" or "note: ..."
std::string describe(const Notice& notice);

/// The words of a command line as a shell would read them back: quoted where that is needed.
std::string shell_quoted(std::span<const char* const> words);
std::string shell_quoted(const std::vector<std::string>& words);

}  // namespace vernier::apps
