// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/display_flags.h"

#include <fmt/format.h>

#include "apps/vernier/flags.h"

namespace vernier::apps {

void add_display_flags(CLI::App& command, DisplayOptions& options) {
  command.add_option("--exposure", options.exposure, "stops, for PNG and JPEG")
      ->transform(real_number(-most_stops, most_stops))
      ->type_name("EV");
  command.add_option("--view", options.view, "display view for PNG and JPEG; 'help' lists them")
      ->type_name("NAME");
  command.add_option("--ocio", options.config, "OpenColorIO config ($OCIO, else a built-in one)")
      ->type_name("FILE");
}

bool print_requested_views(const DisplayOptions& options) {
  if (options.view != "help") return false;
  for (const auto& name : display_views(options)) fmt::print("{}\n", name);
  return true;
}

}  // namespace vernier::apps
