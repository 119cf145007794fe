// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/frame.h"

#include <fmt/format.h>

#include <algorithm>

#include "apps/report/page_parts.h"
#include "core/display/colormap.h"
#include "core/image/image_io.h"

namespace vernier::apps {

void develop(Frame& frame, const DisplayOptions& display) {
  const bool has_alpha = frame.color.channels == 4;
  frame.type = has_alpha ? "image/png" : "image/jpeg";
  frame.file = encode_image8(has_alpha ? "png" : "jpg", to_display(frame.color, display));
}

std::optional<ErrorMap> error_map(const Frame& frame) {
  if (!frame.error) return std::nullopt;
  const Image map = relative_error(frame.color, *frame.error);
  const double largest = round_scale(map);
  return ErrorMap{encode_image8("jpg", colormap(map, float(largest))),
                  fmt::format("{:.3g} %", 100 * largest)};
}

void fill_gaps(Image& color, const Image& coarse, int step, const std::vector<bool>& covered) {
  for (int y = 0; y < color.height; ++y)
    for (int x = 0; x < color.width; ++x) {
      if (covered[size_t(y) * size_t(color.width) + size_t(x)]) continue;
      const int i = std::min(x / step, coarse.width - 1), j = std::min(y / step, coarse.height - 1);
      std::copy_n(coarse.pixel(i, j), color.channels, color.pixel(x, y));
    }
}

}  // namespace vernier::apps
