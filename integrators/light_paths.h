// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "integrators/integrator.h"
#include "integrators/manifold.h"
#include "integrators/render/pixel_filter.h"
#include "integrators/small_lamps.h"
#include "scene/camera.h"
#include "scene/segment.h"

namespace vernier {

/// What a light path brings to a pixel of the crop; the pixel's light is the mean over all light paths.
struct Splat {
  int x, y;
  Rgb radiance;
  bool is_beyond;  ///< the depth limit: no part of the picture, but told as missing
};

/// What some light paths found.
struct Caught {
  std::vector<Splat> splats;      ///< at most two a pixel of each path: within the depth limit, and beyond
  std::vector<LightParts> parts;  ///< of each of these, where light is kept apart
  RayCounts rays;
  uint64_t rejected = 0;  ///< paths that were not finite, or negative, and of which nothing is kept
};

/// Paths that light takes from its sources to surfaces that the camera sees (Arvo 1986, "Backward Ray
/// Tracing"; Veach 1997, chapter 10, the techniques that connect to the camera's lens). They carry flux; what
/// a surface makes of it is asked of the BSDF toward the camera in every case, so shading normals, indices of
/// refraction and rough glass, for which the two directions differ (Veach 1997, chapter 5), count as they do
/// along paths from the camera.
class LightPaths {
 public:
  /// All must live as long; `sorter` may be null. Of LightPathKind::none there are paths of small lamps
  /// alone.
  LightPaths(const Scene& scene, const Camera& camera, const RenderSettings& settings, LightPathKind kind,
             SmallLamps small_lamps = {}, const LightSorter* sorter = nullptr);

  /// Names a light path: its number among those of one half.
  struct Id {
    uint64_t index;
    int half;
  };
  /// Follows a path: a pure function of its name, whose findings are added.
  void trace(const Id& id, Caught& caught) const;

  LightPathKind kind() const { return kind_; }
  /// What they show of them to the camera; null: there are none.
  const SmallLamps* small_lamps() const { return small_lamps_.size() > 0 ? &small_lamps_ : nullptr; }
  /// So many light paths go with one camera sample of each pixel of the whole picture.
  uint64_t paths_per_sample() const;
  /// What finds the light that these paths do not bring, beside LightPathKind::caustics; else null.
  const SpecularChains* chains() const { return chains_ ? &*chains_ : nullptr; }

 private:
  struct Walk;
  struct Pixel {
    int x, y;
    float weight;
  };

  /// How the camera sees a point, along which ray and in which pixel.
  struct View {
    Camera::Sight sight;
    Vec3f to_camera;  ///< unit
    Pixel pixel;
  };

  void show_small_lamp(Walk& walk) const;
  void follow(Walk& walk, const LightEmission::Ray& emitted) const;
  std::optional<Interaction> next_vertex(Walk& walk, const Segment& segment, int vertex, Rgb& flux) const;
  void connect(Walk& walk, const Interaction& at, const Vec3f& to_light, const Rgb& flux) const;
  Rgb carried_on(const Interaction& at, const Vec3f& to_light, const Shading& lit, const ShadingSample& next,
                 const Rgb& flux) const;
  std::optional<View> view_of(const SurfacePoint& at, const Vec2f& on_lens, const Vec2f& in_pixel) const;
  Passage sightline(const Interaction& at, const Camera::Sight& sight, const Vec3f& to_camera) const;
  std::optional<Pixel> pixel_at(Vec2f raster, const Vec2f& u) const;
  void add(Walk& walk, const Splat& splat) const;
  float survival_probability(const Walk& walk, int vertex, const Rgb& part) const;

  const Scene& scene_;
  const Camera& camera_;
  const LightPathKind kind_;
  const LightSorter* sorter_;
  const IntegratorOptions options_;
  const std::shared_ptr<const LightEmission> emission_;  ///< null: no path goes on from a light
  std::optional<SpecularChains> chains_;
  const SmallLamps small_lamps_;
  const FilterSampler filter_;
  const Crop crop_;
  const bool has_times_;  ///< something moves while the shutter is open
  const int width_, height_;
  const float filter_reach_;  ///< pixels beyond its own that a filter may show
  const uint64_t seed_;
};

/// Those that a picture needs; empty: none.
std::optional<LightPaths> light_paths_of(const Scene& scene, const Camera& camera,
                                         const Integrator& integrator, const RenderSettings& settings,
                                         const LightSorter& sorter);

}  // namespace vernier
