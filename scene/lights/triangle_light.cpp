// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/triangle_light.h"

#include "core/math/frame.h"
#include "core/sampling/spherical_triangle.h"
#include "core/sampling/warp.h"
#include "scene/emission.h"
#include "scene/moving_mesh.h"

namespace vernier {
namespace {

Vec3f doubled_area(const Vec3f& a, const Vec3f& b, const Vec3f& c) { return cross(b - a, c - a); }

}  // namespace

/// The light as one point sees it. Places on it are drawn and their densities told from here alone, so that
/// the two cannot differ.
class TriangleLight::View {
 public:
  /// At a time of the shutter.
  View(const TriangleLight& light, const Vec3f& from, float time)
      : View(light, from, time, light.ready_shape()) {}
  View(const View&) = delete;
  View& operator=(const View&) = delete;

  const LightShape& shape() const { return shape_; }

  /// Whether it certainly sends no light here.
  bool is_dark() const { return is_dark_ || (first_ && solid_angle_ == 0); }

  /// Barycentrics of the second and third corner; beyond the line between them in a parallelogram's other
  /// half.
  Vec2f sample(const Vec2f& u) const {
    if (!first_) {
      float pdf;
      return light_.place_by_area(shape_, u, pdf);
    }
    if (!shape_.opposite) return first_->sample(u);
    const float share = first_->solid_angle() / solid_angle_;
    if (u.x < share) return first_->sample({u.x / share, u.y});
    const Vec2f other = second_->sample({(u.x - share) / (1 - share), u.y});
    return {other.x + other.y, 1 - other.x};
  }

  /// Density per solid angle of a place at that distance whose normal makes that angle; 0: never drawn.
  float pdf(const Vec2f& place, float distance2, float cosine) const {
    if (is_dark() || cosine == 0) return 0;
    if (first_) return 1 / solid_angle_;
    const float by_area = distance2 / (cosine * shape_.area);
    return !texture_ ? by_area : by_area * texture_->pdf(invert_sample_triangle(place));
  }

 private:
  View(const TriangleLight& light, const Vec3f& from, float time, const LightShape* ready)
      : light_(light),
        found_(ready ? std::nullopt : std::optional(light.shape_at(time))),
        shape_(ready ? *ready : *found_),
        texture_(light.texture()) {
    const auto& [a, b, c] = shape_.corners;
    const std::optional<Vec3f>& opposite = shape_.opposite;
    is_dark_ = !light.mesh_->material_->double_sided() && !(dot(from - a, shape_.normal) > 0);
    if (is_dark_ || texture_) return;
    const Vec3f center = opposite ? (b + c) * 0.5f : (a + b + c) * (1 / 3.f);
    float near2 = std::max({length_squared(b - a), length_squared(c - b), length_squared(a - c)});
    if (opposite) near2 = std::max(near2, length_squared(*opposite - a));
    if (length_squared(center - from) > near2) return;
    first_.emplace(a - from, b - from, c - from, doubled_area(a, b, c));
    solid_angle_ = first_->solid_angle();
    if (!opposite) return;
    // Its arcs go on where those of the first end.
    const Vec3f& d = *opposite;
    second_.emplace(c - from, b - from, d - from, doubled_area(c, b, d));
    solid_angle_ += second_->solid_angle();
  }

  const TriangleLight& light_;
  const std::optional<LightShape> found_;  ///< unless it is ready
  const LightShape& shape_;
  const Distribution2D* const texture_;
  bool is_dark_ = false;
  std::optional<SphericalTriangle> first_, second_;  ///< of near lights
  float solid_angle_ = 0;
};

EmissiveMesh::EmissiveMesh(const SceneGeometry& geometry, const Material& material, uint32_t instance)
    : geometry_(&geometry), material_(&material), instance_(instance), moments_(geometry.moments(instance)) {
  if (material.emits_evenly())
    even_ = {{material.emission({}, false, 1), material.emission({}, true, 1)}, material.coverage({})};
  else
    textures_.resize(geometry.triangle_count(instance));
}

void EmissiveMesh::settle(std::span<const TriangleLight> lights, bool ready) {
  if (std::all_of(textures_.begin(), textures_.end(), [](const auto& table) { return !table; }))
    textures_ = decltype(textures_)();
  if (!ready || moments_ > 0) return;
  std::vector<LightShape> shapes;
  shapes.reserve(lights.size());
  for (const TriangleLight& light : lights) shapes.push_back(light.shape_at(middle_of_shutter));
  first_ = lights.data();
  shapes_ = std::move(shapes);
}

TriangleLight::TriangleLight(EmissiveMesh& mesh, uint32_t primitive)
    : mesh_(&mesh), primitive_(primitive), opposite_(primitive) {
  measure_emission(mesh);
}

LightShape TriangleLight::shape_at(float time) const {
  if (const LightShape* const ready = ready_shape()) return *ready;
  const SceneGeometry& geometry = *mesh_->geometry_;
  const PlacedTriangle own = geometry.placed_triangle(mesh_->instance_, primitive_, time);
  const auto& [a, b, c] = own.corners;
  const Vec3f across = doubled_area(a, b, c) * (own.is_mirrored ? -1.f : 1.f);
  const float doubled = length(across);
  LightShape shape{own.corners, {}, doubled > 0 ? across / doubled : Vec3f(0, 0, 1), own.error, doubled / 2};
  if (!is_joined()) return shape;
  std::rotate(shape.corners.begin(), shape.corners.begin() + joint_.first, shape.corners.end());
  const PlacedTriangle other = geometry.placed_triangle(mesh_->instance_, opposite_, time);
  const auto& its = other.corners;
  shape.opposite = its[joint_.across];
  shape.error = max(shape.error, other.error);
  shape.area += length(doubled_area(its[0], its[1], its[2])) / 2;
  return shape;
}

std::optional<TriangleLight::Joint> TriangleLight::joint(const TriangleLight& other) const {
  if (!mesh_->even_ || mesh_->moments_ > 0) return std::nullopt;
  const LightShape own = shape_at(middle_of_shutter), its = other.shape_at(middle_of_shutter);
  for (size_t i = 0; i < 3; ++i)
    for (size_t j = 0; j < 3; ++j) {
      const Vec3f a = own.corners[i], b = own.corners[(i + 1) % 3], c = own.corners[(i + 2) % 3];
      const Vec3f d = its.corners[j];
      if (its.corners[(j + 1) % 3] != c || its.corners[(j + 2) % 3] != b) continue;
      const Vec3f off = abs((b - a) - (d - c));
      // No more than rounding of the corners explains.
      const Vec3f tolerance = max(own.error, its.error);
      if (!(off.x <= tolerance.x && off.y <= tolerance.y && off.z <= tolerance.z)) return std::nullopt;
      return Joint{uint8_t(i), uint8_t(j)};
    }
  return std::nullopt;
}

void TriangleLight::take_in(const TriangleLight& other, Joint joint) {
  opposite_ = other.primitive_;
  joint_ = joint;
  power_ += other.power_;
}

Vec3f LightShape::at(const Vec2f& place) const {
  const auto& [a, b, c] = corners;
  const float rest = 1 - place.x - place.y;
  if (opposite && rest < 0) return *opposite * -rest + c * (1 - place.x) + b * (1 - place.y);
  return a * rest + b * place.x + c * place.y;
}

Vec2f TriangleLight::place_by_area(const LightShape& shape, const Vec2f& u, float& pdf) const {
  pdf = 1 / shape.area;
  if (shape.opposite) return u;
  const Distribution2D* const texture = this->texture();
  if (!texture) return sample_triangle(u);
  float of_texture = 1;
  const Vec2f place = sample_triangle(texture->sample(u, of_texture));
  pdf *= of_texture;
  return place;
}

TriangleId TriangleLight::triangle_at(const Vec2f& place) const {
  return {mesh_->instance_, is_joined() && place.x + place.y > 1 ? opposite_ : primitive_};
}

Rgb TriangleLight::emission(const Vec2f& barycentrics, float time, bool front, const Vec3f& wo) const {
  if (mesh_->even_) return mesh_->even_->emission[front];
  const SurfacePoint point =
      mesh_->geometry_->surface_point(mesh_->instance_, primitive_, barycentrics, time);
  return vernier::emission(*mesh_->geometry_, *mesh_->material_, point, front, wo);
}

float TriangleLight::coverage(const Vec2f& barycentrics) const {
  if (mesh_->even_) return mesh_->even_->coverage;
  return vernier::coverage(*mesh_->geometry_, *mesh_->material_,
                           mesh_->geometry_->surface_point(mesh_->instance_, primitive_, barycentrics));
}

std::optional<LightSample> TriangleLight::sample(const SurfacePoint& from, const Vec2d& u) const {
  std::optional<LightSample> sample;
  const View view(*this, from.position, from.time);
  if (view.is_dark()) return sample;
  const Vec2f place = view.sample(to_float(u));
  const Vec3f on = view.shape().at(place);
  const Vec3f to_light = on - from.position;
  const float distance2 = length_squared(to_light);
  if (!(distance2 > 0)) return sample;
  const Vec3f wi = to_light * (1 / std::sqrt(distance2));
  const float cosine = -dot(wi, view.shape().normal);
  const Rgb radiance = emission(place, from.time, cosine > 0, -wi) * coverage(place);
  const float pdf = view.pdf(place, distance2, std::abs(cosine));
  if (!(pdf > 0) || is_black(radiance)) return sample;
  const LightShape& shape = view.shape();
  sample.emplace();
  sample->wi = wi;
  sample->radiance = radiance;
  sample->pdf = pdf;
  sample->shadow = from.spawn_to(on, shape.error, shape.normal, triangle_at(place));
  return sample;
}

std::optional<LightRay> TriangleLight::emit(const Bounds& /*scene*/, const Vec2d& place,
                                            const Vec2f& direction, float time) const {
  const LightShape shape = shape_at(time);
  float pdf;
  const Vec2f at_place = place_by_area(shape, to_float(place), pdf);
  // One side or, by the first number's halves, either.
  const bool two_sided = mesh_->material_->double_sided();
  const bool front = !two_sided || direction.x < 0.5f;
  const Vec2f u(two_sided ? 2 * direction.x - (front ? 0.f : 1.f) : direction.x, direction.y);
  const Vec3f local = sample_cosine_hemisphere(u);
  const Vec3f w = Frame::from_normal(front ? shape.normal : -shape.normal).to_world(local);
  // Over the density by solid angle the cosine leaves pi.
  const Rgb flux =
      emission(at_place, time, front, w) * (coverage(at_place) * pi * (two_sided ? 2.f : 1.f) / pdf);
  if (!(local.z > 0) || is_black(flux)) return std::nullopt;
  LightRay light{{offset_ray_origin(shape.at(at_place), shape.error, shape.normal, w), 0, w}, flux};
  light.ray.time = time;
  light.ray.origin_triangle = triangle_at(at_place);
  return light;
}

LightEval TriangleLight::eval(const SurfacePoint& from, const Vec3f& wi, const SurfacePoint* on) const {
  const Vec2f place(on->u, on->v);
  const Rgb radiance = emission(place, from.time, on->front, -wi);
  if (is_black(radiance)) return {radiance, 0};
  const float distance2 = length_squared(on->position - from.position);
  return {radiance, View(*this, from.position, from.time).pdf(place, distance2, std::abs(dot(wi, on->ng)))};
}

/// The normal of a triangle whose corners move at constant speed is a quadratic curve between two moments,
/// within the cone of its three Bezier points (Farin 2002, "Curves and Surfaces for CAGD", 5th ed., 4.3).
std::optional<LightBounds> TriangleLight::bounds() const {
  const size_t moments = mesh_->moments_;
  if (moments == 0) return bounds_at(shape_at(middle_of_shutter));
  LightBounds all;
  for (size_t i = 0; i < moments; ++i) {
    const LightShape shape = moment(i);
    all = merge(all, bounds_at(shape));
    if (i == 0) continue;
    const LightShape before = moment(i - 1);
    const auto& [a0, b0, c0] = before.corners;
    const auto& [a1, b1, c1] = shape.corners;
    LightBounds between = bounds_at(shape);
    between.axis = unit_or(cross(b0 - a0, c1 - a1) + cross(b1 - a1, c0 - a0), {0, 0, 0});
    all = merge(all, between);
  }
  // Such a cone holds what lies between its directions only while it is narrower than a half space.
  if (all.cos_spread < 0) all.cos_spread = -1;
  all.power = power_;
  return all;
}

LightShape TriangleLight::moment(size_t i) const { return shape_at(float(i) / float(mesh_->moments_ - 1)); }

LightBounds TriangleLight::bounds_at(const LightShape& shape) const {
  LightBounds bounds;
  for (const Vec3f& corner : shape.corners) bounds.box.add(corner);
  if (shape.opposite) bounds.box.add(*shape.opposite);
  bounds.axis = shape.normal;
  bounds.power = power_;
  bounds.two_sided = mesh_->material_->double_sided();
  return bounds;
}

void TriangleLight::measure_emission(EmissiveMesh& mesh) {
  const SceneGeometry& geometry = *mesh.geometry_;
  const Material& material = *mesh.material_;
  // The bound on cells keeps meshes of very many triangles small in memory.
  constexpr float most_cells = 1 << 22;
  const auto attributes = [&](const Vec2f& barycentrics) {
    if (!material.needs_attributes()) return SurfaceAttributes{};
    SurfacePoint point;
    point.instance = mesh.instance_;
    point.primitive = primitive_;
    point.u = barycentrics.x;
    point.v = barycentrics.y;
    return geometry.attributes(point);
  };
  const float limit = std::clamp(most_cells / float(geometry.triangle_count(mesh.instance_)), 1.f, 1024.f);
  const float texels = material.emissive_texels({attributes({0, 0}), attributes({1, 0}), attributes({0, 1})});
  // Two texels a side of a cell, and as many readings.
  const int cells = texels > 4 ? int(std::sqrt(std::min(texels / 4, limit))) : 1;
  const int steps = mesh.even_ ? 1 : std::max(2, 12 / cells);  // readings across a cell
  std::vector<float> values(size_t(cells) * cells);
  double sum = 0, squares = 0;
  for (int y = 0; y < cells; ++y)
    for (int x = 0; x < cells; ++x) {
      Rgb total(0, 0, 0);
      for (int i = 0; i < steps * steps; ++i) {
        const int column = x * steps + i % steps, line = y * steps + i / steps;
        const Vec2f u((float(column) + 0.5f) / float(cells * steps),
                      (float(line) + 0.5f) / float(cells * steps));
        const Vec2f place = sample_triangle(u);
        const SurfaceAttributes at = attributes(place);
        total += material.emission(at, true, 1) * material.coverage(at);
      }
      float& value = values[size_t(y) * cells + x];
      value = luminance(total) / float(steps * steps);
      sum += value;
      squares += double(value) * value;
    }
  const double mean = sum / double(values.size());
  float area = shape_at(middle_of_shutter).area;
  for (size_t i = 0; i < mesh.moments_; ++i) area = std::max(area, moment(i).area);
  power_ = pi * area * float(mean) * (material.double_sided() ? 2 : 1);
  // As even as this, it is not worth a table.
  if (!(squares / double(values.size()) > 1.1 * mean * mean)) return;
  // What the readings missed is found by this part of the samples.
  for (float& value : values) value += 0.1f * float(mean);
  mesh.textures_[primitive_] = std::make_unique<const Distribution2D>(values, cells, cells);
}

}  // namespace vernier
