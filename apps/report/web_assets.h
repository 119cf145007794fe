// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// Files that HTML pages contain, compiled into the program by CMake.

namespace vernier::apps::web_assets {

extern const std::string_view page_css;  ///< apps/web/page.css
extern const std::string_view page_js;   ///< apps/web/page.js
extern const std::string_view chart_js;  ///< Chart.js, minified, from the system's package

}  // namespace vernier::apps::web_assets
