// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <span>
#include <string_view>

namespace vernier::apps {

/// A file of the page, compiled into the program by CMake.
struct WebFile {
  std::string_view path;  ///< in the page's address
  std::string_view type;
  std::string_view content;
};

std::span<const WebFile> web_files();

}  // namespace vernier::apps
