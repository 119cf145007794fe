#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/names.h"
#include "scene/import/accessors.h"
#include "scene/import/pose.h"

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

int find_animation(const Document& document, const std::string& wanted) {
  const auto& animations = document.model().animations;
  if (animations.empty())
    throw Error(ErrorKind::usage, document.files().scene_path(), "/animations",
                "the file has no animation to pose by");
  std::vector<std::string> names;
  for (size_t i = 0; i < animations.size(); ++i) {
    names.push_back(animations[i].name.empty() ? std::to_string(i) : animations[i].name);
    if (wanted == names.back()) return int(i);
  }
  for (size_t i = 0; i < animations.size(); ++i)
    if (wanted == std::to_string(i)) return int(i);
  if (wanted.empty()) return 0;
  throw_unknown_name("animation", wanted, names);
}

/// One animated value over time (glTF 2.0, appendix C).
class Track {
 public:
  Track(const Document& document, const tinygltf::AnimationSampler& sampler, std::string place)
      : document_(document),
        place_(std::move(place)),
        times_(read_components(document, sampler.input)),
        values_(read_components(document, sampler.output)),
        cubic_(sampler.interpolation == "CUBICSPLINE"),
        step_(sampler.interpolation == "STEP") {
    for (size_t i = 0; i < times_.size(); ++i)
      if (!std::isfinite(times_[i]) || (i > 0 && !(times_[i] > times_[i - 1])))
        document_.fail(place_ + "/input", fmt::format("time {} does not increase", i));
    if (values_.size() % (times_.size() * (cubic_ ? 3 : 1)) != 0)
      document_.fail(place_ + "/output",
                     fmt::format("{} values do not divide among {} times", values_.size(), times_.size()));
    width_ = values_.size() / (times_.size() * (cubic_ ? 3 : 1));
  }

  /// The value at a time; `rotation` interpolates quaternions on the sphere.
  std::vector<double> at(double time, bool rotation) const {
    const auto after = std::upper_bound(times_.begin(), times_.end(), time);
    if (after == times_.begin()) return key(0);
    const size_t i = size_t(after - times_.begin()) - 1;
    if (after == times_.end() || step_) return key(i);
    const double duration = double(times_[i + 1]) - double(times_[i]);
    const double t = (time - double(times_[i])) / duration;
    if (cubic_) return hermite(i, t, duration);
    return rotation ? spherical(key(i), key(i + 1), t) : linear(key(i), key(i + 1), t);
  }

  /// at(), which must be finite.
  std::vector<double> finite_at(double time, bool rotation) const {
    std::vector<double> value = at(time, rotation);
    for (const double v : value)
      if (!std::isfinite(v)) document_.fail(place_ + "/output", "the value is not finite");
    return value;
  }

  void expect_width(size_t width) const {
    if (width_ != width)
      document_.fail(place_ + "/output", fmt::format("expected {} values a key, found {}", width, width_));
  }

 private:
  /// The value of key i; in cubic tracks part 0 is the in-tangent, 2 the out-tangent.
  std::vector<double> key(size_t i, size_t part = 1) const {
    const size_t first = cubic_ ? (3 * i + part) * width_ : i * width_;
    return {values_.begin() + ptrdiff_t(first), values_.begin() + ptrdiff_t(first + width_)};
  }

  static std::vector<double> linear(std::vector<double> a, const std::vector<double>& b, double t) {
    for (size_t c = 0; c < a.size(); ++c) a[c] += t * (b[c] - a[c]);
    return a;
  }

  static std::vector<double> spherical(const std::vector<double>& a, const std::vector<double>& b, double t) {
    if (a.size() != 4) return linear(a, b, t);
    const Quatd from(a[3], a[0], a[1], a[2]), to(b[3], b[0], b[1], b[2]);
    const Quatd q = Imath::slerpShortestArc(from.normalized(), to.normalized(), t);
    return {q.v.x, q.v.y, q.v.z, q.r};
  }

  std::vector<double> hermite(size_t i, double t, double duration) const {
    const double t2 = t * t, t3 = t2 * t;
    const auto from = key(i), leaving = key(i, 2), arriving = key(i + 1, 0), to = key(i + 1);
    std::vector<double> value(width_);
    for (size_t c = 0; c < width_; ++c)
      value[c] = (2 * t3 - 3 * t2 + 1) * from[c] + duration * (t3 - 2 * t2 + t) * leaving[c] +
                 (3 * t2 - 2 * t3) * to[c] + duration * (t3 - t2) * arriving[c];
    return value;
  }

  const Document& document_;
  std::string place_;
  std::vector<float> times_, values_;
  bool cubic_, step_;
  size_t width_ = 0;
};

}  // namespace

void apply_animation(const Document& document, const std::string& wanted, double time,
                     std::vector<NodePose>& poses) {
  const int index = find_animation(document, wanted);
  const auto& animation = document.model().animations[size_t(index)];
  for (const auto& channel : animation.channels) {
    if (channel.target_node < 0) continue;
    if (size_t(channel.sampler) >= animation.samplers.size())
      document.fail(
          fmt::format("/animations/{}", index),
          fmt::format("a channel uses sampler {} of {}", channel.sampler, animation.samplers.size()));
    NodePose& pose = poses[size_t(channel.target_node)];
    const std::string& path = channel.target_path;
    const bool rotation = path == "rotation", weights = path == "weights";
    if (!rotation && !weights && path != "translation" && path != "scale") continue;
    if (!weights && pose.matrix)
      document.fail(fmt::format("/nodes/{}/matrix", channel.target_node),
                    "an animated node must have translation, rotation and scale instead of a matrix");
    const Track track(document, animation.samplers[size_t(channel.sampler)],
                      fmt::format("/animations/{}/samplers/{}", index, channel.sampler));
    if (!weights) track.expect_width(rotation ? 4 : 3);
    const std::vector<double> value = track.finite_at(time, rotation);
    if (weights) pose.weights = value;
    if (path == "translation") pose.translation = {value[0], value[1], value[2]};
    if (path == "scale") pose.scale = {value[0], value[1], value[2]};
    if (rotation) pose.rotation = Quatd(value[3], value[0], value[1], value[2]).normalized();
  }
}

}  // namespace vernier
