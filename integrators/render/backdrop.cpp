// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/backdrop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/base/fingerprint.h"
#include "core/image/fill_frame.h"
#include "vernier/error.h"

namespace vernier {

Image read_background(const std::string& file, const ImageLimits& limits) {
  const LayeredImage read = read_layers(file, limits);
  Image picture = whole_picture(read.rgb(), read.place);
  for (float& value : picture.values) {
    if (!read.linear) value = srgb_to_linear(value);
    value = std::isfinite(value) ? std::max(value, 0.f) : 0.f;
  }
  return picture;
}

Backdrop::Backdrop(const RenderSettings& settings) : background_(settings.background) {
  if (background_.kind != Background::Kind::picture) return;
  const std::shared_ptr<const Image> read = std::exchange(background_.picture, nullptr);
  picture_ = fill_frame(read ? *read : read_background(background_.file), settings.width, settings.height);
}

std::string Backdrop::fingerprint() const {
  return picture_.empty() ? "" : vernier::fingerprint(std::as_bytes(std::span(picture_.values)));
}

IntegratorOptions options_for(const Background& background, IntegratorOptions options) {
  options.background_apart = background.kind != Background::Kind::surroundings;
  return options;
}

void check(const Background& background) {
  const Rgb& color = background.color;
  if (!is_finite(color) || std::min({color.x, color.y, color.z}) < 0)
    throw Error(ErrorKind::usage, fmt::format("a background of colour {},{},{}; expected numbers from 0 on",
                                              color.x, color.y, color.z));
  if (background.kind == Background::Kind::picture && background.file.empty())
    throw Error(ErrorKind::usage, "a background picture needs Background::file");
  if (!background.picture) return;
  const Image& picture = *background.picture;
  const auto is_sound = [](float value) { return value >= 0 && std::isfinite(value); };
  if (picture.empty() || picture.channels != 3 ||
      !std::all_of(picture.values.begin(), picture.values.end(), is_sound))
    throw Error(ErrorKind::usage,
                "Background::picture must have three channels of finite numbers from 0 on, and pixels");
}

}  // namespace vernier
