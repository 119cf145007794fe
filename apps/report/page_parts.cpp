// SPDX-License-Identifier: Apache-2.0
#include "apps/report/page_parts.h"
#include "vernier/version.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/display/colormap.h"

namespace vernier::apps {

int shrink_factor(const Image& image, int longest) {
  return (std::max(image.width, image.height) + longest - 1) / longest;
}

Image shrink(const Image& image, int longest) {
  const int side = shrink_factor(image, longest);
  if (side <= 1) return image;
  Image small((image.width + side - 1) / side, (image.height + side - 1) / side, image.channels);
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      const int x1 = std::min((x + 1) * side, image.width), y1 = std::min((y + 1) * side, image.height);
      for (int c = 0; c < image.channels; ++c) {
        double sum = 0;
        for (int j = y * side; j < y1; ++j)
          for (int i = x * side; i < x1; ++i) sum += image.pixel(i, j)[c];
        small.pixel(x, y)[c] = float(sum / (double(x1 - x * side) * (y1 - y * side)));
      }
    }
  return small;
}

Image cut(const Image& image, int x, int y, int width, int height) {
  Image part(width, height, image.channels);
  for (int row = 0; row < height; ++row)
    std::copy_n(image.pixel(x, y + row), size_t(width) * image.channels, part.pixel(0, row));
  return part;
}

Image relative_error(const Image& picture, const Image& error) {
  Image map(picture.width, picture.height, 1);
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x) {
      double sum = 0;
      for (int c = 0; c < 3; ++c) {
        const double value = picture.pixel(x, y)[c], off = error.pixel(x, y)[c];
        sum += off * off / (value * value + 0.01);
      }
      *map.pixel(x, y) = float(std::sqrt(sum / 3));
    }
  return map;
}

double round_scale(const Image& map) {
  std::vector<float> values;
  std::copy_if(map.values.begin(), map.values.end(), std::back_inserter(values),
               [](float v) { return std::isfinite(v); });
  if (values.empty()) return 1;
  const auto high = values.begin() + std::ptrdiff_t(double(values.size() - 1) * 0.99);
  std::nth_element(values.begin(), high, values.end());
  if (!(*high > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(*high)));
  for (const double step : {1, 2, 5})
    if (*high <= step * power) return step * power;
  return 10 * power;
}

Figure map_figure(const Image& map, double largest, std::string_view caption, bool as_percent) {
  const std::string end =
      as_percent ? fmt::format("{:.3g} %", 100 * largest) : fmt::format("{:.4g}", largest);
  return {colormap(map, float(largest)), fmt::format("{}. Black 0, pale yellow {} and more.", caption, end),
          false};
}

Curve square_root_guide(const Curve& curve) {
  Curve guide{"slope -1/2", {}, {}, true};
  for (const auto& [x, y] : curve.points) {
    if (!(x > 0 && y > 0)) continue;
    const double last = curve.points.back()[0];
    guide.points = {{x, y}, {last, y * std::sqrt(x / last)}};
    break;
  }
  return guide;
}

void add_machine(HtmlPage& page, const nlohmann::ordered_json& machine,
                 const nlohmann::ordered_json& built_with) {
  std::string libraries;
  for (const auto& [name, version] : built_with.items())
    libraries += fmt::format("{}{} {}", libraries.empty() ? "" : ", ", name, version.get<std::string>());
  page.facts({{"processor", machine["cpu"]},
              {"threads", fmt::format("{}", machine["threads"].get<unsigned>())},
              {"version", fmt::format("vernier {}", version())},
              {"built with", libraries}});
}

}  // namespace vernier::apps
