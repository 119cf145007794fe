// SPDX-License-Identifier: Apache-2.0
#include "vernier/error.h"

#include "core/base/one_line.h"

namespace vernier {
namespace {

std::string join(const std::string& file, const std::string& place, const std::string& problem) {
  std::string line = file;
  if (!place.empty()) line += (line.empty() ? "" : ": ") + place;
  line += (line.empty() ? "" : ": ") + problem;
  // File names, bytes of broken files and libraries' own messages are quoted in it.
  return one_line(line);
}

}  // namespace

Error::Error(ErrorKind kind, const std::string& file, const std::string& place, const std::string& problem)
    : std::runtime_error(join(file, place, problem)), kind_(kind) {}

}  // namespace vernier
