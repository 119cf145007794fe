// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/accel/accelerator.h"
#include "scene/coverage.h"
#include "scene/geometry.h"
#include "scene/lights/environment.h"
#include "scene/lights/ground_light.h"
#include "scene/lights/lamps_along_ray.h"
#include "scene/lights/light_set.h"
#include "scene/names.h"
#include "scene/shading.h"
#include "scene/volume_set.h"

namespace vernier {

/// Everything that rays can meet and light can come from. Immutable once built and surrounded; all const
/// members may be called from many threads.
class Scene {
 public:
  /// Takes the description's arrays over.
  Scene(SceneDescription description, const SceneOptions& options);
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Puts an environment around the scene, in place of the one it has, if any; null: nothing. Not
  /// while other threads use the scene: what surroundings it needs is told by looking at it.
  void set_environment(std::shared_ptr<const EnvironmentDescription> description);
  bool has_environment() const { return environment_ != nullptr; }
  /// As vernier::fill_air.
  void fill_air(const Fog& fog);
  /// What fills it; of density 0: nothing.
  const Fog& fog() const { return fog_; }

  /// Makes what surface points with a footprint read their colors from, once, whoever asks first; others
  /// need not. All else may go on meanwhile.
  void make_color_mips() const { color_mips_.make(materials_); }
  const ColorMips& color_mips() const { return color_mips_; }

  /// Answers rays by another accelerator of the same geometry from now on. Not while other threads use the
  /// scene.
  void replace_accelerator(std::unique_ptr<Accelerator> accelerator) {
    accelerator_ = std::move(accelerator);
  }

  /// The first triangle along a ray, whatever it is made of. What light meets: scene/segment.h.
  std::optional<SurfacePoint> intersect(const Ray& ray) const;
  /// Whether any triangle lies between the ends of a segment.
  bool occluded(const Ray& segment) const { return accelerator_->occluded(segment); }

  /// The scattering at a surface point toward the unit direction wo, which is met as `context` says and is
  /// completed here.
  Shading shade(const SurfacePoint& point, const Vec3f& wo, BsdfContext context) const;
  /// The same in air.
  Shading shade(const SurfacePoint& point, const Vec3f& wo) const {
    return shade(point, wo, {.front = point.front});
  }

  /// Light shining on a point, the choice among lights included in the pdf (and, for delta lights, in the
  /// radiance). u picks the light, v the point on it.
  std::optional<LightSample> sample_light(const SurfacePoint& from, double u, const Vec2d& v) const;

  /// Light of one light of lights(), as if it were the only one.
  std::optional<LightSample> light_from(uint32_t light, const SurfacePoint& from) const;
  /// Probability that sample_light() chooses it.
  float light_prob(const SurfacePoint& from, uint32_t light) const {
    return lights_.prob(receiver(from), light);
  }

  /// Whether a camera sees of a surface the shadow alone.
  bool catches_shadow(const SurfacePoint& point) const {
    return ground_light_ && !point.is_in_medium() && material(point).catches_shadow();
  }
  /// As GroundLight::sample, of a scene that catches shadows.
  std::optional<LightSample> sample_ground_light(const SurfacePoint& from, double u, const Vec2d& v) const {
    return ground_light_->sample(from, u, v);
  }

  /// Radiance that arrives along `ray` by emission at `hit` (null: from infinity), with the pdf with which
  /// sample_light(*from) would have chosen it. from null: the camera, pdf 0.
  LightEval emitted(const SurfacePoint* from, const Ray& ray, const SurfacePoint* hit) const;

  const Material& material(const SurfacePoint& point) const {
    return materials_[material_of_instance_[point.instance]];
  }
  const SceneNames& names() const { return names_; }
  const VolumeSet& volumes() const { return volumes_; }
  const LightSet& lights() const { return lights_; }
  const Lamps& lamps() const { return lamps_; }
  const SceneGeometry& geometry() const { return geometry_; }
  const Accelerator& accelerator() const { return *accelerator_; }
  /// What the accelerator was built from, for building others beside it; valid as long as the scene.
  Geometry accelerated_geometry() const;
  const Bounds& bounds() const { return geometry_.bounds(); }
  /// Whether it makes a difference when in the shutter a ray travels.
  bool moves() const { return moves_; }
  /// Of all that light from infinity can meet: surfaces and fog.
  Bounds lit_bounds() const;
  const std::vector<Notice>& notices() const { return notices_; }
  const std::string& accelerator_name() const { return accelerator_name_; }
  /// What light depends on beside a camera, as names and values: the scene's hash, what was chosen of it, its
  /// surroundings, the accelerator.
  std::vector<std::pair<std::string, std::string>> identity() const;

 private:
  LightReceiver receiver(const SurfacePoint& point) const;
  void compile_materials(const SceneDescription& description);
  void collect_lights(const SceneDescription& description);
  void collect_ground_light();

  std::string hash_, accelerator_name_;
  std::vector<std::pair<std::string, std::string>> choices_;
  SceneNames names_;
  SceneGeometry geometry_;
  std::vector<Texture> textures_;
  mutable ColorMips color_mips_{textures_};
  std::vector<Material> materials_;
  std::vector<uint32_t> material_of_instance_;  ///< index into materials_
  VolumeSet volumes_;
  std::vector<bool> clear_;  ///< by instance: light may pass it straight on
  std::optional<CoverageFilter> coverage_;
  std::unique_ptr<Accelerator> accelerator_;
  LightSet lights_;
  Lamps lamps_;
  /// By instance and triangle: index into lights_, -1 for none.
  std::vector<std::vector<int32_t>> triangle_lights_;
  const EnvironmentLight* environment_ = nullptr;
  Fog fog_;
  bool moves_ = false;
  std::optional<GroundLight> ground_light_;  ///< where some material catches shadows
  std::vector<Notice> notices_;
};

}  // namespace vernier
