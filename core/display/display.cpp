// SPDX-License-Identifier: Apache-2.0
#include "core/display/display.h"

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "core/display/agx.h"
#include "core/display/display_config.h"
#include "vernier/error.h"

namespace vernier {
namespace {

constexpr float largest_half = 65504;

// Finite values that no view transform overflows on: OpenColorIO promises nothing for others.
float usable(float value, float scale) {
  const float scaled = value * scale;
  if (std::isnan(scaled)) return 0;
  return std::clamp(scaled, -largest_half, largest_half);
}

// Khronos PBR Neutral tone mapper, for values of any size (Khronos Group 2024, "PBR Neutral Tone Mapper",
// ToneMapping repository, PBR_Neutral/pbrNeutral.glsl). Negative values, which it does not define, count as
// zero.
void khronos_neutral(float* rgb) {
  constexpr float start_compression = 0.8f - 0.04f, desaturation = 0.15f;
  for (int c = 0; c < 3; ++c) rgb[c] = std::max(0.f, rgb[c]);
  const float smallest = std::min({rgb[0], rgb[1], rgb[2]});
  const float offset = smallest < 0.08f ? smallest - 6.25f * smallest * smallest : 0.04f;
  for (int c = 0; c < 3; ++c) rgb[c] -= offset;
  const float peak = std::max({rgb[0], rgb[1], rgb[2]});
  if (peak < start_compression) return;
  constexpr float d = 1 - start_compression;
  const float new_peak = 1 - d * d / (peak + d - start_compression);
  const float whitening = 1 - 1 / (desaturation * (peak - new_peak) + 1);
  for (int c = 0; c < 3; ++c) rgb[c] = lerp(whitening, rgb[c] * new_peak / peak, new_peak);
}

uint8_t to_byte(float value) {
  return std::isnan(value) ? uint8_t(0) : uint8_t(std::lround(std::clamp(value, 0.f, 1.f) * 255));
}

}  // namespace

std::vector<std::string> display_views(const DisplayOptions& options) {
  return DisplayConfig(options.config).views();
}

DisplayOptions with_chosen_view(DisplayOptions options) {
  const std::vector<std::string> views = display_views(options);
  options.view = options.view.empty() ? views.front() : find_by_prefix("view", options.view, views);
  return options;
}

Image8 to_display(const Image& scene_linear, const DisplayOptions& options) {
  if (scene_linear.channels < 3) throw Error(ErrorKind::usage, "a picture to display needs three channels");
  const DisplayConfig config(options.config);
  const auto& views = config.views();
  const std::string view = options.view.empty() ? views.front() : options.view;
  if (std::find(views.begin(), views.end(), view) == views.end()) throw_unknown_name("view", view, views);
  const bool neutral = config.built_in() && view == "neutral", is_agx = config.built_in() && view == "AgX";
  const auto transform = config.transform(view);

  const float scale = std::exp2(options.exposure);
  const bool has_alpha = scene_linear.channels == 4;
  Image8 result(scene_linear.width, scene_linear.height, has_alpha ? 4 : 3);
  parallel_for(size_t(scene_linear.height), [&](size_t row) {
    const int y = int(row);
    std::vector<float> pixels(size_t(scene_linear.width) * 3);
    for (int x = 0; x < scene_linear.width; ++x) {
      float* rgb = &pixels[size_t(x) * 3];
      const float* value = scene_linear.pixel(x, y);
      const float cover = has_alpha && value[3] > 0 ? value[3] : 1;
      for (int c = 0; c < 3; ++c) rgb[c] = usable(value[c], scale / cover);
      if (neutral) khronos_neutral(rgb);
      if (is_agx) agx(rgb);
    }
    transform(pixels);
    for (int x = 0; x < scene_linear.width; ++x) {
      uint8_t* shown =
          std::transform(&pixels[size_t(x) * 3], &pixels[size_t(x) * 3] + 3, result.pixel(x, y), to_byte);
      if (has_alpha) *shown = to_byte(scene_linear.pixel(x, y)[3]);
    }
  });
  return result;
}

}  // namespace vernier
