// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include "vernier/export.h"

namespace vernier {

/// What went wrong, as far as a caller's exit code cares.
enum class ErrorKind {
  usage,   ///< the request itself: an unknown name, an impossible size
  input,   ///< a scene, image or other file that cannot be used
  output,  ///< a file that cannot be written
  memory,  ///< out of memory
};

/// The one exception that Vernier throws. `what()` is a single line of UTF-8 that a terminal can be given as
/// it is: "FILE: PLACE: PROBLEM", parts left out where there is none.
class VERNIER_API Error : public std::runtime_error {
 public:
  /// file: path as the user knows it. place: JSON pointer ("/accessors/3/count"), line, or empty.
  /// problem: what was expected, what was found, and what to do about it.
  Error(ErrorKind kind, const std::string& file, const std::string& place, const std::string& problem);

  Error(ErrorKind kind, const std::string& problem) : Error(kind, {}, {}, problem) {}

  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

/// Something a user should know that did not stop the work. `place` as in Error.
struct Notice {
  enum class Severity { info, warning };
  Severity severity = Severity::warning;
  std::string place;
  std::string text;
};

}  // namespace vernier
