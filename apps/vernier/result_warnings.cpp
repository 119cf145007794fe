// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/result_warnings.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>

#include "apps/vernier/display_flags.h"
#include "apps/vernier/missing_text.h"
#include "apps/vernier/render_options.h"
#include "integrators/render/texture_filter.h"
#include "integrators/render/visible_light.h"
#include "scene/camera.h"

namespace vernier::apps {
namespace {

void warn_of_bad_samples(const RenderResult& result, const RenderFlags& flags, NoticeLog& log) {
  if (result.bad_samples == 0) return;
  std::string replay;
  if (!result.bad_sample_examples.empty()) {
    const BadSample& first = result.bad_sample_examples.front();
    replay = fmt::format("; pixel {},{} has one", first.x, first.y);
    // Of a single pixel there are no differences to others, which may be what was not finite.
    if (!result.film.is_reconstructed())
      replay += fmt::format(
          ", and the same command with --crop 1x1+{}+{} --spp {} --adaptive off --seed {} replays it",
          first.x, first.y, 2 * (first.index + 1), flags.seed);
  }
  log.add({Notice::Severity::warning,
           {},
           fmt::format("{} of {} samples were not finite or were negative, and were left out{}",
                       result.bad_samples, result.samples, replay)});
}

void warn_of_bad_light_paths(const RenderResult& result, NoticeLog& log) {
  if (result.bad_light_paths == 0) return;
  log.add({Notice::Severity::warning,
           {},
           fmt::format("{} light paths were not finite or were negative, and were left out",
                       result.bad_light_paths)});
}

/// What was added without being asked for, since it takes time of its own.
void note_caustics(const RenderResult& result, const RenderFlags& flags, NoticeLog& log) {
  if (result.light_path_kind != LightPathKind::caustics || flags.caustics != "auto") return;
  log.add(
      {Notice::Severity::info,
       {},
       "lamps shine on mirrors or glass that bends their light: what these cast (caustics) comes by paths "
       "that begin at the lamps; --caustics off leaves it out, and takes less time"});
}

/// What an error figure means less for than one of other integrators.
void note_reconstruction(const RenderResult& result, NoticeLog& log) {
  if (!result.film.is_reconstructed()) return;
  log.add({Notice::Severity::info,
           {},
           "neighboring pixels err together in a picture that is made of differences between pixels: the "
           "interval of its error is told by blocks of 8x8 pixels, and what averages pixels gains less than "
           "of path's pictures"});
}

/// An approximation, and what becomes of it.
void note_texture_filter(const RenderSettings& settings, NoticeLog& log) {
  if (!settings.texture_filter.is_on()) return;
  log.add({Notice::Severity::info,
           {},
           fmt::format("colors of textures are averaged over what a sample stands for (--texture-filter {}): "
                       "the blur is not in the error, and is less the more samples a pixel has",
                       texture_filter_text(settings.texture_filter))});
}

/// The stops that make a luminance a middle gray, as far as --exposure goes.
double exposure_to_gray(double luminance) {
  return std::clamp(std::log2(0.18 / luminance), -most_stops, most_stops);
}

/// Says so when what the camera sees of the scene comes out all but black, and what helps.
void warn_if_black(double mean, const RenderFlags& flags, const RenderReport& report, NoticeLog& log) {
  constexpr double black = 0.005;
  if (mean * std::exp2(flags.display.exposure) >= black) return;
  std::vector<std::string> remedies;
  if (report.surroundings.name != "studio")
    remedies.emplace_back("--env studio lights it");
  else if (mean < black)
    remedies.emplace_back("the studio lights nothing of it: what is shut in needs a lamp of its own");
  if (mean > 0)
    remedies.push_back(
        fmt::format("--exposure {:.0f} brightens a .png or .jpg", std::ceil(exposure_to_gray(mean))));
  log.add({Notice::Severity::warning,
           {},
           fmt::format("the picture is almost all black, its mean luminance {:.2g}{}{}", mean,
                       remedies.empty() ? "" : "; ", fmt::join(remedies, ", "))});
}

/// Says so when most of what is lit comes out white in a .png or .jpg, as by lamps whose candelas or lux are
/// true to life.
void warn_if_white(double typical, const RenderFlags& flags, NoticeLog& log) {
  constexpr double white = 8;
  if (!has_display_output(flags) || typical * std::exp2(flags.display.exposure) < white) return;
  log.add({Notice::Severity::warning,
           {},
           fmt::format(
               "most of what is lit comes out white, its luminance about {:.2g}; --exposure {:.0f} darkens "
               "a .png or .jpg",
               typical, std::round(exposure_to_gray(typical)))});
}

}  // namespace

void warn_of_result(const RenderResult& result, const Scene& scene, const RenderFlags& flags,
                    const RenderReport& report, NoticeLog& log) {
  warn_of_bad_samples(result, flags, log);
  warn_of_bad_light_paths(result, log);
  note_caustics(result, flags, log);
  note_reconstruction(result, log);
  note_texture_filter(report.settings, log);
  warn_of_missing_light(result, flags.integrator_options.max_depth, log);
  if (!shows_light(flags)) return;
  const RenderSettings& settings = report.settings;
  const Camera camera(settings.camera, settings.width, settings.height);
  const PictureLight light = picture_light(result.film, scene, camera, settings);
  warn_if_black(light.mean, flags, report, log);
  warn_if_white(light.typical, flags, log);
}

}  // namespace vernier::apps
