// SPDX-License-Identifier: Apache-2.0
#include "scene/scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "core/base/fingerprint.h"
#include "core/base/names.h"
#include "scene/emission.h"
#include "scene/lights/punctual.h"
#include "scene/lights/triangle_lights.h"
#include "vernier/error.h"

namespace vernier {
namespace {

/// Names what cannot hold the volume that its material asks for, and why.
void note_without_volume(std::span<const InstanceDescription> instances, const std::vector<uint32_t>& without,
                         const char* reason, std::vector<Notice>& notices) {
  if (without.empty()) return;
  const std::string& name = instances[without[0]].name;
  std::string text = name.empty() ? "instance " + std::to_string(without[0]) : "the mesh of '" + name + "'";
  if (without.size() > 1) text += " (and " + std::to_string(without.size() - 1) + " more)";
  notices.push_back({Notice::Severity::warning, "KHR_materials_volume",
                     text + reason + ", so it has no inside: its surface is taken for thin-walled"});
}

}  // namespace

Scene::Scene(SceneDescription description, const SceneOptions& options)
    : hash_(std::move(description.hash)),
      choices_(std::move(description.choices)),
      names_(description),
      geometry_(std::move(description.meshes), description.instances),
      textures_(std::move(description.textures)) {
  compile_materials(description);
  if (std::any_of(materials_.begin(), materials_.end(), [](const Material& m) { return !m.is_opaque(); }))
    coverage_.emplace(geometry_, materials_, material_of_instance_);
  const Geometry geometry = accelerated_geometry();
  const auto& entry = options.accelerator.empty()
                          ? quickest_accelerator(geometry)
                          : find_by_name(accelerators(), "accelerator", options.accelerator);
  accelerator_name_ = entry.name;
  accelerator_ = entry.build(geometry);
  collect_lights(description);
}

void Scene::compile_materials(const SceneDescription& description) {
  const std::vector<bool> is_cut = cut_instances(geometry_, description.materials, textures_);
  const VolumeBoundaries boundaries(geometry_, description.instances, description.materials, is_cut);
  // A material may be used with and without vertex colors, on closed and on open surfaces, and cut out or
  // not: each time compiled anew.
  std::map<std::tuple<uint32_t, bool, bool, bool>, uint32_t> compiled;
  for (uint32_t i = 0; i < geometry_.instance_count(); ++i) {
    MaterialDescription material = description.materials[geometry_.material_of(i)];
    if (!is_cut[i]) material.alpha_mode = AlphaMode::opaque;
    if (boundaries.is_thin(i)) material.thickness = 0;
    const std::tuple key(geometry_.material_of(i), geometry_.has_colors(i), bool(is_cut[i]),
                         boundaries.is_thin(i));
    const auto [entry, is_new] = compiled.try_emplace(key, uint32_t(materials_.size()));
    if (is_new) materials_.emplace_back(material, textures_, geometry_.has_colors(i), &color_mips_);
    material_of_instance_.push_back(entry->second);
  }
  volumes_ = VolumeSet(boundaries, geometry_, materials_, material_of_instance_);
  note_without_volume(description.instances, boundaries.open, " is not closed", notices_);
  note_without_volume(description.instances, boundaries.cut, " has holes by its alpha", notices_);
  // Boundaries that bend light stop what goes straight: of interest only to lamps, whose light is then known
  // to be missing, and where one volume may hide the boundary of another.
  const bool has_lamps = !description.lights.empty();
  for (uint32_t i = 0; i < geometry_.instance_count(); ++i) {
    const Material& material = materials_[material_of_instance_[i]];
    const Rgb ior = material.interior_ior();
    const bool may_not_bend = ior.x == 1 || ior.y == 1 || ior.z == 1;
    clear_.push_back(material.is_volume_boundary()
                         ? volumes_.are_nested() ||
                               (material.passes_unscattered() && (has_lamps || may_not_bend))
                         : material.may_be_clear());
  }
}

Geometry Scene::accelerated_geometry() const {
  Geometry view = geometry_.view();
  for (size_t i = 0; i < view.instances.size(); ++i) {
    view.instances[i].filtered = !materials_[material_of_instance_[i]].is_opaque();
    view.instances[i].clear = clear_[i];
  }
  if (coverage_) view.filter = &*coverage_;
  return view;
}

void Scene::collect_lights(const SceneDescription& description) {
  TriangleLights triangles = collect_triangle_lights(geometry_, materials_, material_of_instance_);
  triangle_lights_ = std::move(triangles.of_triangle);
  std::vector<std::unique_ptr<PunctualLight>> lamps;
  for (uint32_t i = 0; i < description.lights.size(); ++i) {
    auto lamp = std::make_unique<PunctualLight>(description.lights[i], i);
    if (!(lamp->power(bounds()) > 0)) continue;
    const size_t index = triangles.lights.size() + lamps.size();
    if (lamp->bounds()) lamps_.add(*lamp, uint32_t(index));
    lamps.push_back(std::move(lamp));
  }
  lights_ = LightSet(std::move(triangles), std::move(lamps));
  moves_ = geometry_.moves() || std::any_of(description.lights.begin(), description.lights.end(),
                                            [](const auto& lamp) { return !lamp.moments.empty(); });
  set_environment(description.environment);
}

void Scene::collect_ground_light() {
  if (std::any_of(materials_.begin(), materials_.end(), [](const Material& m) { return m.catches_shadow(); }))
    ground_light_.emplace(environment_, lights_.delta_lights());
}

void Scene::set_environment(std::shared_ptr<const EnvironmentDescription> description) {
  std::unique_ptr<EnvironmentLight> light;
  if (description) light = std::make_unique<EnvironmentLight>(std::move(description));
  if (light && light->bad_texels() > 0)
    notices_.push_back(
        {Notice::Severity::warning, "environment",
         std::to_string(light->bad_texels()) + " values are negative or not finite; taken as black"});
  environment_ = light.get();
  lights_.set_environment(std::move(light));
  volumes_.find_dim_ones(clear_, materials_, material_of_instance_, lights_);
  collect_ground_light();
}

void Scene::fill_air(const Fog& fog) {
  const auto refuse = [](const char* what, const std::string& found, const char* expected) {
    throw Error(ErrorKind::usage, {}, "fog", fmt::format("{} {}; expected {}", what, found, expected));
  };
  if (!(fog.density >= 0) || !std::isfinite(fog.density))
    refuse("a density of", fmt::format("{}", fog.density), "0 or more per metre");
  for (int c = 0; c < 3; ++c)
    if (!(fog.albedo[c] >= 0 && fog.albedo[c] <= 1))
      refuse("an albedo of", fmt::format("{}", fog.albedo[c]), "0 to 1");
  if (!(std::abs(fog.anisotropy) < 1))
    refuse("an anisotropy of", fmt::format("{}", fog.anisotropy), "-1 to 1");
  if (!(fog.radius >= 0) || !std::isfinite(fog.radius))
    refuse("a radius of", fmt::format("{}", fog.radius), "0 or more metres");
  if (fog.density > 0 && ground_light_)
    throw Error(ErrorKind::usage, {}, "fog",
                "ground that shows its shadow alone has none to show in fog; leave out one of both, or use "
                "ground matte");
  fog_ = fog;
  if (fog_.radius == 0) fog_.radius = 4 * bounds().radius();
  const Rgb extinction(fog_.density);
  volumes_.fill_air({extinction, {1, 1, 1}, extinction * fog_.albedo, fog_.anisotropy},
                    {bounds().center(), fog_.density > 0 ? fog_.radius : 0});
}

Bounds Scene::lit_bounds() const {
  Bounds all = bounds();
  if (fog_.density > 0) {
    all.add(bounds().center() - Vec3f(fog_.radius));
    all.add(bounds().center() + Vec3f(fog_.radius));
  }
  return all;
}

std::optional<SurfacePoint> Scene::intersect(const Ray& ray) const {
  const auto hit = accelerator_->closest(ray);
  if (!hit) return std::nullopt;
  return geometry_.surface_point(ray, *hit);
}

Shading Scene::shade(const SurfacePoint& point, const Vec3f& wo, BsdfContext context) const {
  const Material& material = this->material(point);
  const SurfaceAttributes attributes =
      material.needs_attributes() ? geometry_.attributes(point, wo) : SurfaceAttributes{};
  const float side = point.front ? 1.f : -1.f;
  const Vec3f ng = point.ng * side;
  // A normal turned away from the viewer has no meaning; the true one has.
  const auto facing = [&](const Vec3f& n) { return dot(n, wo) > 1e-4f ? n : ng; };

  const Vec3f smooth = geometry_.shading_normal(point);
  if (!material.needs_tangents())
    return {Frame::from_normal(facing(smooth * side)), ng, wo, material.bsdf(attributes, context)};

  const auto [tangent, bitangent] = geometry_.tangent_frame(point, smooth, material.tangent_texcoord());
  const auto to_world = [&, t = tangent, b = bitangent](const Vec3f& v) {
    return t * v.x + b * v.y + smooth * v.z;
  };
  const Vec3f normal = facing(normalize(to_world(material.tangent_space_normal(attributes))) * side);
  Frame frame = Frame::from_normal(normal);
  if (material.is_anisotropic()) {
    const Vec2f direction = material.anisotropy_direction(attributes);
    frame = Frame::from_normal_tangent(normal, to_world({direction.x, direction.y, 0}));
  }
  if (material.has_coat())
    context.coat_normal =
        frame.to_local(facing(normalize(to_world(material.tangent_space_coat_normal(attributes))) * side));
  return {frame, ng, wo, material.bsdf(attributes, context)};
}

LightReceiver Scene::receiver(const SurfacePoint& point) const {
  if (point.is_in_medium() || material(point).transmits()) return {point.position, {0, 0, 0}};
  return {point.position, point.front ? point.ng : -point.ng};
}

std::optional<LightSample> Scene::sample_light(const SurfacePoint& from, double u, const Vec2d& v) const {
  const auto [light, prob] = lights_.choose(receiver(from), u);
  std::optional<LightSample> sample = light ? light->sample(from, v) : std::nullopt;
  if (!sample) return sample;
  sample->source = light->source();
  sample->light = light;
  sample->choice_prob = prob;
  if (sample->is_delta)
    sample->radiance /= prob;
  else
    sample->pdf *= prob;
  return sample;
}

std::optional<LightSample> Scene::light_from(uint32_t light, const SurfacePoint& from) const {
  auto sample = lights_[light].sample(from, {0, 0});
  if (sample) sample->source = lights_[light].source();
  return sample;
}

LightEval Scene::emitted(const SurfacePoint* from, const Ray& ray, const SurfacePoint* hit) const {
  size_t index = lights_.size() - 1;  // of the environment, if there is one
  if (hit) {
    const Material& material = this->material(*hit);
    if (!material.is_emissive()) return {};
    const auto& of_triangle = triangle_lights_[hit->instance];
    const int32_t light = of_triangle.empty() ? -1 : of_triangle[hit->primitive];
    if (light < 0 || !from) return {emission(geometry_, material, *hit, hit->front, -ray.direction), 0};
    index = size_t(light);
  } else {
    if (!environment_) return {};
    if (!from) return {environment_->radiance(ray.direction), 0};
  }
  LightEval light = lights_[index].eval(*from, ray.direction, hit);
  light.pdf *= lights_.prob(receiver(*from), index);
  return light;
}

std::vector<std::pair<std::string, std::string>> Scene::identity() const {
  std::vector<std::pair<std::string, std::string>> identity{{"scene", hash_},
                                                            {"accelerator", accelerator_name_}};
  identity.insert(identity.end(), choices_.begin(), choices_.end());
  if (environment_) {
    const EnvironmentDescription& environment = environment_->description();
    identity.emplace_back("env", fingerprint(std::as_bytes(std::span(environment.picture->values))));
    identity.emplace_back("env-rotate", fmt::format("{}", environment.rotation));
    identity.emplace_back("env-scale", fmt::format("{}", environment.scale));
  }
  if (fog_.density > 0)
    identity.emplace_back("fog", fmt::format("{},{},{},{},{},{}", fog_.density, fog_.albedo.x, fog_.albedo.y,
                                             fog_.albedo.z, fog_.anisotropy, fog_.radius));
  return identity;
}

std::shared_ptr<Scene> build_scene(SceneDescription description, const SceneOptions& options) {
  return std::make_shared<Scene>(std::move(description), options);
}

void set_environment(Scene& scene, std::shared_ptr<const EnvironmentDescription> environment) {
  scene.set_environment(std::move(environment));
}

void fill_air(Scene& scene, const Fog& fog) { scene.fill_air(fog); }

const std::vector<Notice>& notices_of(const Scene& scene) { return scene.notices(); }

}  // namespace vernier
