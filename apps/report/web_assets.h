// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string_view>

// Files that HTML pages contain, compiled into the program by CMake.

namespace vernier::apps::web_assets {

extern const std::string_view page_css;   ///< apps/report/page.css
extern const std::string_view chart_js;   ///< Chart.js, minified, from the system's package
extern const std::string_view charts_js;  ///< apps/report/charts.js
extern const std::string_view viewer_js;  ///< apps/report/viewer.js
extern const std::string_view cards_js;   ///< apps/report/cards.js

}  // namespace vernier::apps::web_assets
