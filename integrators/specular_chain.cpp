// SPDX-License-Identifier: Apache-2.0
#include "integrators/specular_chain.h"

#include <cmath>

namespace vernier {
namespace {

/// As Scene::shade takes a normal for turned away from the viewer.
constexpr double least_facing = 1e-4;
/// Sines of angles between a ray and a triangle's plane below which the two do not meet.
constexpr double least_slope = 1e-12;

/// A unit vector that varies with place.
struct Normal {
  Vec3d n;
  std::array<Vec3d, 2> dn{Vec3d(0, 0, 0), Vec3d(0, 0, 0)};
};

}  // namespace

Tangents::Tangents(const Vec3d& normal) {
  const Vec3d across = std::abs(normal.x) < 0.6 ? Vec3d(1, 0, 0) : Vec3d(0, 1, 0);
  x = normalize(cross(across, normal));
  y = cross(normal, x);
}

/// Where a chain meets a triangle: the point, moved as the pencil is, and the normal there, both on the side
/// that the chain comes from.
struct SpecularChain::Sheet {
  Vec3d point;
  std::array<Vec3d, 2> d_point;
  Vec3d ng;
  Normal shading;
};

SpecularChain::SpecularChain(const Scene& scene, const Interaction& from, const Vec3d& direction,
                             const Rgb& throughput)
    : scene_(scene), segment_(from.spawn(Vec3f(direction))), throughput_(throughput) {
  const Tangents tangents(direction);
  pencil_ = {Vec3d(from.position), direction, {Vec3d(0, 0, 0), Vec3d(0, 0, 0)}, {tangents.x, tangents.y}};
}

bool SpecularChain::meet() {
  next_ = intersect(scene_, segment_);
  if (!next_ || scene_.material(*next_).has_normal_maps()) return false;
  weight_ *= transmittance(scene_.volumes().stretch(segment_.media, segment_.ray, 0, next_->t));
  lobes_ = shade(scene_, *next_, -segment_.ray.direction, throughput_).delta();
  return !is_black(lobes_.reflected) || !is_black(lobes_.transmitted);
}

bool SpecularChain::turn(bool is_transmitted) {
  const Rgb& part = is_transmitted ? lobes_.transmitted : lobes_.reflected;
  if (is_black(part)) return false;
  const auto sheet = this->sheet();
  if (!sheet) return false;
  is_straight_ = is_transmitted && lobes_.eta == 1;
  bend(*sheet, is_transmitted);
  if ((dot(pencil_.direction, sheet->ng) > 0) == is_transmitted) return false;
  weight_ *= part;
  at_ = *next_;
  segment_ = at_.spawn(Vec3f(pencil_.direction));
  return true;
}

std::optional<SpecularChain::Sheet> SpecularChain::sheet() const {
  const auto corners = scene_.geometry().triangle(next_->instance, next_->primitive, next_->time);
  const Vec3d first(corners[0]), u = Vec3d(corners[1]) - first, v = Vec3d(corners[2]) - first;
  const Vec3d plane = cross(u, v);
  const double area = length(plane), slope = dot(pencil_.direction, plane);
  if (!(std::abs(slope) > least_slope * area)) return std::nullopt;
  const double side = slope < 0 ? 1 : -1, t = dot(first - pencil_.origin, plane) / slope;
  Sheet sheet;
  sheet.point = pencil_.origin + pencil_.direction * t;
  for (size_t j = 0; j < 2; ++j) {
    const Vec3d moved = pencil_.d_origin[j] + pencil_.d_direction[j] * t;
    sheet.d_point[j] = moved - pencil_.direction * (dot(moved, plane) / slope);
  }
  sheet.ng = sheet.shading.n = plane * (side / area);
  const auto normals = scene_.geometry().corner_normals(*next_);
  if (!normals) return sheet;
  // Barycentrics are linear in the place; what they interpolate is then made a unit vector.
  const Vec3d by_u = cross(v, plane) * (side / square(area)), by_v = cross(plane, u) * (side / square(area));
  const Vec3d n0(normals->at(0)), nu = Vec3d(normals->at(1)) - n0, nv = Vec3d(normals->at(2)) - n0;
  const auto change = [&](const Vec3d& way) { return nu * dot(by_u, way) + nv * dot(by_v, way); };
  const Vec3d sum = n0 * side + change(sheet.point - first);
  const double size = length(sum);
  if (!(-dot(sum, pencil_.direction) > least_facing * size)) return sheet;
  sheet.shading.n = sum * (1 / size);
  for (size_t j = 0; j < 2; ++j) {
    const Vec3d turned = change(sheet.d_point[j]) * (1 / size);
    sheet.shading.dn[j] = turned - sheet.shading.n * dot(sheet.shading.n, turned);
  }
  return sheet;
}

/// Reflection and Snell's law with their derivatives (Igehy 1999, eqs. 14 to 18).
void SpecularChain::bend(const Sheet& sheet, bool is_transmitted) {
  pencil_.origin = sheet.point;
  pencil_.d_origin = sheet.d_point;
  if (is_straight_) return;
  const auto& [n, dn] = sheet.shading;
  const Vec3d d = pencil_.direction;
  const double cosine = -dot(d, n);
  const double ratio = is_transmitted ? 1 / double(lobes_.eta) : 1;
  const double cos_t = std::sqrt(std::max(0.0, 1 - square(ratio) * (1 - square(cosine))));
  const double along = is_transmitted ? ratio * cosine - cos_t : 2 * cosine;
  const double d_along = is_transmitted ? ratio - square(ratio) * cosine / cos_t : 2;
  pencil_.direction = normalize(d * ratio + n * along);
  for (size_t j = 0; j < 2; ++j) {
    const double d_cosine = -dot(pencil_.d_direction[j], n) - dot(d, dn[j]);
    pencil_.d_direction[j] = pencil_.d_direction[j] * ratio + dn[j] * along + n * (d_along * d_cosine);
  }
}

}  // namespace vernier
