// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/backdrop.h"

#include <fmt/format.h>

#include "core/base/fingerprint.h"
#include "core/image/fill_frame.h"
#include "core/image/image_io.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// Scene-linear, and without values that a film refuses.
Image read_background(const std::string& file) {
  const LayeredImage read = read_layers(file);
  Image picture = whole_picture(read.rgb(), read.place);
  for (float& value : picture.values) {
    if (!read.linear) value = srgb_to_linear(value);
    value = std::isfinite(value) ? std::max(value, 0.f) : 0.f;
  }
  return picture;
}

}  // namespace

Backdrop::Backdrop(const RenderSettings& settings) : background_(settings.background) {
  if (background_.kind == Background::Kind::picture)
    picture_ = fill_frame(read_background(background_.file), settings.width, settings.height);
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
}

}  // namespace vernier
