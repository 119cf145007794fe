// SPDX-License-Identifier: Apache-2.0
#include "scene/import/animation_track.h"

#include <ImathQuat.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/import/accessors.h"

namespace vernier {
namespace {

using Imath::Quatd;

/// All components of an accessor, whatever its type.
std::vector<float> read_components(const Document& document, int accessor) {
  const ElementArray elements = locate_elements(document, accessor);
  std::vector<float> values(elements.count * size_t(elements.components));
  read_floats(document, accessor, elements.components, values.data());
  return values;
}

std::vector<double> linear(std::vector<double> a, const std::vector<double>& b, double t) {
  for (size_t c = 0; c < a.size(); ++c) a[c] += t * (b[c] - a[c]);
  return a;
}

std::vector<double> spherical(const std::vector<double>& a, const std::vector<double>& b, double t) {
  if (a.size() != 4) return linear(a, b, t);
  const Quatd from(a[3], a[0], a[1], a[2]), to(b[3], b[0], b[1], b[2]);
  const Quatd q = Imath::slerpShortestArc(from.normalized(), to.normalized(), t);
  return {q.v.x, q.v.y, q.v.z, q.r};
}

}  // namespace

double latest_key(const Document& document, const tinygltf::AnimationSampler& sampler) {
  const std::vector<float> times = read_components(document, sampler.input);
  return double(*std::max_element(times.begin(), times.end()));
}

Track::Track(const Document& document, const tinygltf::AnimationSampler& sampler, std::string place)
    : document_(document),
      place_(std::move(place)),
      times_(read_components(document, sampler.input)),
      values_(read_components(document, sampler.output)),
      cubic_(sampler.interpolation == "CUBICSPLINE"),
      step_(sampler.interpolation == "STEP") {
  for (size_t i = 0; i < times_.size(); ++i)
    if (!std::isfinite(times_[i]) || (i > 0 && times_[i] < times_[i - 1]))
      document_.fail(place_ + "/input", fmt::format("time {} is not after the one before", i));
  if (values_.size() % (times_.size() * (cubic_ ? 3 : 1)) != 0)
    document_.fail(place_ + "/output",
                   fmt::format("{} values do not divide among {} times", values_.size(), times_.size()));
  width_ = values_.size() / (times_.size() * (cubic_ ? 3 : 1));
}

std::vector<double> Track::at(double time, Blend blend) const {
  std::vector<double> value = interpolate(time, blend);
  for (const double v : value)
    if (!std::isfinite(v)) document_.fail(place_ + "/output", "the value is not finite");
  return value;
}

void Track::expect_width(size_t width) const {
  if (width_ != width)
    document_.fail(place_ + "/output", fmt::format("expected {} values a key, found {}", width, width_));
}

std::vector<double> Track::interpolate(double time, Blend blend) const {
  const auto after = std::upper_bound(times_.begin(), times_.end(), time);
  if (after == times_.begin()) return key(0);
  const size_t i = size_t(after - times_.begin()) - 1;
  if (after == times_.end() || step_ || blend == Blend::step) return key(i);
  const double duration = double(times_[i + 1]) - double(times_[i]);
  const double t = (time - double(times_[i])) / duration;
  if (cubic_) return hermite(i, t, duration);
  return blend == Blend::spherical ? spherical(key(i), key(i + 1), t) : linear(key(i), key(i + 1), t);
}

std::vector<double> Track::key(size_t i, size_t part) const {
  const size_t first = cubic_ ? (3 * i + part) * width_ : i * width_;
  return {values_.begin() + ptrdiff_t(first), values_.begin() + ptrdiff_t(first + width_)};
}

std::vector<double> Track::hermite(size_t i, double t, double duration) const {
  const double t2 = t * t, t3 = t2 * t;
  const auto from = key(i), leaving = key(i, 2), arriving = key(i + 1, 0), to = key(i + 1);
  std::vector<double> value(width_);
  for (size_t c = 0; c < width_; ++c)
    value[c] = (2 * t3 - 3 * t2 + 1) * from[c] + duration * (t3 - 2 * t2 + t) * leaving[c] +
               (3 * t2 - 2 * t3) * to[c] + duration * (t3 - t2) * arriving[c];
  return value;
}

}  // namespace vernier
