// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/texture_filter.h"

#include <fmt/format.h>

#include <array>
#include <charconv>

#include "core/base/names.h"
#include "integrators/integrator.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr float least_width = 0.1f, most_width = 16;

void check_width(float width) {
  if (!(width >= least_width && width <= most_width))
    throw Error(ErrorKind::usage, {}, "--texture-filter",
                fmt::format("an area {} pixels wide; expected {} to {}", width, least_width, most_width));
}

}  // namespace

TextureFilter parse_texture_filter(std::string_view text) {
  const std::array<std::string, 2> names{"none", "mip"};
  const size_t colon = text.find(':');
  const std::string_view name = text.substr(0, colon);
  TextureFilter filter;
  if (name == names[1])
    filter.kind = TextureFilter::Kind::mip;
  else if (name != names[0])
    throw_unknown_name("--texture-filter", name, names);
  if (colon == std::string_view::npos) return filter;
  const std::string_view number = text.substr(colon + 1);
  const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), filter.width);
  if (!filter.is_on() || error != std::errc{} || end != number.data() + number.size())
    throw Error(ErrorKind::usage, {}, "--texture-filter",
                fmt::format("'{}' is no filter; expected none, mip, or mip with a width in pixels, such as "
                            "mip:0.5",
                            text));
  check_width(filter.width);
  return filter;
}

std::string texture_filter_text(const TextureFilter& filter) {
  return filter.is_on() ? fmt::format("mip:{}", filter.width) : "none";
}

void check_texture_filter(const RenderSettings& settings) {
  if (!settings.texture_filter.is_on()) return;
  check_width(settings.texture_filter.width);
  if (!find_by_name(integrators(), "integrator", settings.integrator).follows_cones)
    throw Error(ErrorKind::usage, {}, "--texture-filter",
                fmt::format("the integrator {} reads textures at points; use none, or --integrator path",
                            settings.integrator));
}

}  // namespace vernier
