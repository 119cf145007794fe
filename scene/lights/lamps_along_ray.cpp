// SPDX-License-Identifier: Apache-2.0
#include "scene/lights/lamps_along_ray.h"

#include <algorithm>
#include <cmath>

namespace vernier {
namespace {

using Interval = std::pair<double, double>;  // of a ray's parameter; empty where it ends before it begins

/// The part of `within` where a line lies in the cone about `axis` from the origin, narrower than a
/// half-space. The cone is convex, so that is one interval.
Interval in_cone(const Vec3d& origin, const Vec3d& direction, const Vec3d& axis, double cosine,
                 const Interval& within) {
  // (x . axis)^2 = cosine^2 |x|^2 on the cone and on its mirror image.
  const double along = dot(direction, axis), at = dot(origin, axis), square_cosine = square(cosine);
  const double a = square(along) - square_cosine;
  const double b = at * along - square_cosine * dot(origin, direction);
  const double c = square(at) - square_cosine * length_squared(origin);
  std::array<double, 4> ends{within.first};
  size_t count = 1;
  const double discriminant = b * b - a * c;
  if (discriminant > 0) {
    const double q = -(b + std::copysign(std::sqrt(discriminant), b));
    const auto [near, far] = std::minmax({a != 0 ? q / a : within.first, q != 0 ? c / q : within.first});
    for (const double t : {near, far})
      if (t > within.first && t < within.second) ends[count++] = t;
  }
  ends[count] = within.second;
  Interval lit{within.second, within.first};
  for (size_t i = 0; i < count; ++i) {
    const double middle =
        std::isfinite(ends[i + 1]) ? (ends[i] + ends[i + 1]) / 2 : 2 * std::abs(ends[i]) + 1;
    const Vec3d x = origin + middle * direction;
    if (dot(x, axis) < cosine * length(x)) continue;
    lit.first = std::min(lit.first, ends[i]);
    lit.second = std::max(lit.second, ends[i + 1]);
  }
  return lit;
}

}  // namespace

LampsAlongRay::LampsAlongRay(const Lamps& lamps, const Ray& ray, float begin, float end)
    : lamps_(lamps.lamps_),
      origin_(ray.origin),
      direction_(ray.direction),
      begin_(double(begin)),
      end_(double(end)),
      time_(ray.time) {
  if (lamps_.size() > most_weighed) return;
  for (size_t i = 0; i < lamps_.size(); ++i) {
    views_[i] = view(lamps_[i]);
    // What arrives along the ray: the integral of 1 / d^2.
    weights_[i] = lamps_[i].power * float(views_[i].extent() / views_[i].distance);
    all_weights_ += weights_[i];
  }
}

LampsAlongRay::View LampsAlongRay::view(const Lamps::Lamp& lamp) const {
  const PunctualLight::Place place = lamp.lamp->place_at(time_);
  const Vec3d from = origin_ - Vec3d(place.position);
  const double range = double(lamp.lamp->range()), cosine = double(lamp.lamp->cos_outer());
  View view;
  view.nearest = -dot(from, direction_);
  const double distance2 = length_squared(from + view.nearest * direction_);
  // A lamp on the ray itself would see it from no angle; a millionth of the way aside it sees as much.
  view.distance = std::max(std::sqrt(distance2), 1e-6 * (1 + std::abs(view.nearest)));
  Interval lit{begin_, end_};
  if (std::isfinite(range)) {
    const double half = std::sqrt(std::max(0., square(range) - distance2));
    lit = {std::max(lit.first, view.nearest - half), std::min(lit.second, view.nearest + half)};
  }
  if (cosine > 0 && lit.first < lit.second)
    lit = in_cone(from, direction_, Vec3d(place.direction), cosine, lit);
  if (!(lit.first < lit.second)) return view;
  view.first = std::atan((lit.first - view.nearest) / view.distance);
  view.last = std::atan((lit.second - view.nearest) / view.distance);
  return view;
}

double LampsAlongRay::density(const View& view, double t) {
  const double aside = t - view.nearest, angle = std::atan(aside / view.distance);
  if (!(angle >= view.first && angle <= view.last) || !(view.extent() > 0)) return 0;
  return view.distance / (view.extent() * (square(view.distance) + square(aside)));
}

float LampsAlongRay::prob(size_t lamp) const {
  if (lamps_.size() > most_weighed) return 1 / float(lamps_.size());
  return all_weights_ > 0 ? weights_[lamp] / all_weights_ : 0;
}

std::optional<LampsAlongRay::Sample> LampsAlongRay::sample(float u, float v) const {
  size_t picked = 0;
  if (lamps_.size() > most_weighed) {
    picked = std::min(size_t(u * float(lamps_.size())), lamps_.size() - 1);
  } else {
    if (!(all_weights_ > 0)) return std::nullopt;
    float below = u * all_weights_;
    while (picked + 1 < lamps_.size() && below >= weights_[picked]) below -= weights_[picked++];
  }
  const View seen = lamps_.size() > most_weighed ? view(lamps_[picked]) : views_[picked];
  if (!(seen.extent() > 0)) return std::nullopt;
  const double angle = seen.first + double(v) * seen.extent();
  const double t = std::clamp(seen.nearest + seen.distance * std::tan(angle), begin_, end_);
  const double pdf = density(seen, t) * double(prob(picked));
  if (!(pdf > 0) || !std::isfinite(t)) return std::nullopt;
  return Sample{lamps_[picked].light, float(t), float(pdf)};
}

float LampsAlongRay::pdf(const Light* light, float t) const {
  const auto lamp = std::find_if(lamps_.begin(), lamps_.end(),
                                 [&](const Lamps::Lamp& candidate) { return candidate.lamp == light; });
  if (lamp == lamps_.end()) return 0;
  const auto i = size_t(lamp - lamps_.begin());
  const View seen = lamps_.size() > most_weighed ? view(*lamp) : views_[i];
  return float(density(seen, double(t))) * prob(i);
}

}  // namespace vernier
