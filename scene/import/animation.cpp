// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/names.h"
#include "scene/import/animated_property.h"
#include "scene/import/pose.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using Imath::Quatd;

std::string name_of(const tinygltf::Model& model, size_t animation) {
  const std::string& name = model.animations[animation].name;
  return name.empty() ? std::to_string(animation) : name;
}

/// How many properties more than one of the animations sets.
size_t shared_targets(const Document& document) {
  const auto& animations = document.model().animations;
  std::map<std::string, size_t> setter;
  std::set<std::string> shared;
  for (size_t i = 0; i < animations.size(); ++i)
    for (const auto& channel : animations[i].channels) {
      const std::string pointer = channel_pointer(channel);
      if (!find_target(document, pointer)) continue;
      if (setter.try_emplace(pointer, i).first->second != i) shared.insert(pointer);
    }
  return shared.size();
}

/// The animations that a user means; what was decided for him is noticed.
std::vector<size_t> choose_animations(const Document& document, const std::string& wanted,
                                      std::vector<Notice>& notices) {
  const auto& model = document.model();
  const size_t count = model.animations.size();
  if (count == 0)
    throw Error(ErrorKind::usage, document.files().scene_path(), "/animations",
                "the file has no animation to pose by");
  std::vector<std::string> names;
  for (size_t i = 0; i < count; ++i) names.push_back(name_of(model, i));
  for (size_t i = 0; i < count && !wanted.empty(); ++i)
    if (wanted == names[i]) return {i};
  for (size_t i = 0; i < count; ++i)
    if (wanted == std::to_string(i)) return {i};
  if (!wanted.empty() && wanted != "all") {
    names.emplace_back("all");
    throw_unknown_name("animation", wanted, names);
  }
  if (count == 1) return {0};

  const auto note = [&](Notice::Severity severity, const std::string& text) {
    notices.push_back({severity, "/animations", text});
  };
  const size_t shared = shared_targets(document);
  if (wanted.empty() && shared > 0) {
    note(Notice::Severity::info,
         fmt::format(
             "of {} animations only the first, '{}', poses the scene, since some move the same things; "
             "--animation NAME takes another, --animation all takes all at once",
             count, names[0]));
    return {0};
  }
  if (wanted.empty())
    note(Notice::Severity::info, fmt::format("all {} animations pose the scene, since no two move the same "
                                             "thing; --animation NAME takes one",
                                             count));
  if (shared > 0)
    note(Notice::Severity::warning,
         fmt::format("{} properties are set by more than one animation; the last in the file holds", shared));
  std::vector<size_t> all(count);
  for (size_t i = 0; i < count; ++i) all[i] = i;
  return all;
}

/// First and last of the times of keys, in seconds.
struct TimeSpan {
  double first = std::numeric_limits<double>::infinity(), last = -first;
};

/// Sets what animations of one file set to its values at one time.
class Poser {
 public:
  Poser(const Document& document, double time, std::vector<NodePose>& poses,
        std::vector<PropertyValue>& values, std::vector<Notice>& notices)
      : document_(document), time_(time), poses_(poses), values_(values), notices_(notices) {}

  TimeSpan apply(size_t index) {
    const auto& animation = document_.model().animations[index];
    TimeSpan span;
    for (const auto& channel : animation.channels) {
      const auto target = find_target(document_, channel_pointer(channel));
      if (!target) continue;
      if (size_t(channel.sampler) >= animation.samplers.size())
        document_.fail(
            fmt::format("/animations/{}", index),
            fmt::format("a channel uses sampler {} of {}", channel.sampler, animation.samplers.size()));
      const Track track(document_, animation.samplers[size_t(channel.sampler)],
                        fmt::format("/animations/{}/samplers/{}", index, channel.sampler));
      if (track.has_equal_times())
        warn(fmt::format("/animations/{}/samplers/{}/input", index, channel.sampler),
             "keys share a time, where the value jumps");
      if (target->property->width > 0) track.expect_width(target->property->width);
      set(*target, in_range(*target, track.at(time_, target->property->blend)));
      span.first = std::min(span.first, track.first_time());
      span.last = std::max(span.last, track.last_time());
    }
    return span;
  }

  /// Weights of meshes hold for nodes that have none of their own.
  void finish() {
    const auto& nodes = document_.nodes();
    for (size_t i = 0; i < nodes.size(); ++i) {
      const auto animated = mesh_weights_.find(nodes[i].mesh);
      if (animated != mesh_weights_.end() && poses_[i].weights.empty()) poses_[i].weights = animated->second;
    }
  }

 private:
  std::vector<double> in_range(const AnimationTarget& target, std::vector<double> value) {
    const AnimatedProperty& property = *target.property;
    bool clamped = false;
    for (double& v : value) {
      clamped = clamped || !(v >= property.lower && v <= property.upper);
      v = std::clamp(v, property.lower, property.upper);
    }
    if (clamped) warn(target.pointer, "the animated value is outside its range and was clamped");
    return value;
  }

  void warn(const std::string& place, const char* text) {
    notices_.push_back({Notice::Severity::warning, place, text});
  }

  void set(const AnimationTarget& target, std::vector<double> value) {
    if (target.pointer.starts_with("/nodes/"))
      set_node(target, std::move(value));
    else if (target.pointer.starts_with("/meshes/"))
      set_weights(target, value, int(target.indices[0]), mesh_weights_[int(target.indices[0])]);
    else
      set_value(target, std::move(value));
  }

  void set_node(const AnimationTarget& target, std::vector<double> value) {
    const size_t node = target.indices[0];
    NodePose& pose = poses_[node];
    if (target.is("/nodes/{}/weights") || target.is("/nodes/{}/weights/{}"))
      return set_weights(target, value, document_.nodes()[node].mesh, pose.weights);
    if (target.property->blend == Blend::step) {
      pose.visible = value[0] != 0;
      return;
    }
    if (pose.matrix)
      document_.fail(fmt::format("/nodes/{}/matrix", node),
                     "an animated node must have translation, rotation and scale instead of a matrix");
    if (target.is("/nodes/{}/translation")) pose.translation = {value[0], value[1], value[2]};
    if (target.is("/nodes/{}/scale")) pose.scale = {value[0], value[1], value[2]};
    if (target.is("/nodes/{}/rotation"))
      pose.rotation = Quatd(value[3], value[0], value[1], value[2]).normalized();
  }

  /// All weights, or one of those that hold at rest.
  void set_weights(const AnimationTarget& target, const std::vector<double>& value, int mesh,
                   std::vector<double>& weights) const {
    if (target.indices.size() < 2) {
      weights = value;
      return;
    }
    if (weights.empty()) weights = document_.model().meshes[size_t(mesh)].weights;
    weights.resize(std::max(weights.size(), target.indices[1] + 1));
    weights[target.indices[1]] = value[0];
  }

  void set_value(const AnimationTarget& target, std::vector<double> value) {
    if (target.property->blend == Blend::spherical) {
      const Quatd unit = Quatd(value[3], value[0], value[1], value[2]).normalized();
      value = {unit.v.x, unit.v.y, unit.v.z, unit.r};
    }
    values_.push_back({target.pointer, std::move(value)});
  }

  const Document& document_;
  double time_;
  std::vector<NodePose>& poses_;
  std::vector<PropertyValue>& values_;
  std::vector<Notice>& notices_;
  std::map<int, std::vector<double>> mesh_weights_;
};

}  // namespace

void pose_by_animations(const Document& document, const std::string& wanted, double time,
                        std::vector<NodePose>& poses, std::vector<PropertyValue>& values,
                        std::vector<Notice>& notices) {
  Poser poser(document, time, poses, values, notices);
  std::vector<std::string> outside;
  for (const size_t index : choose_animations(document, wanted, notices)) {
    const TimeSpan span = poser.apply(index);
    const double key_time = double(float(time));  // as keys are stored
    if (span.first <= span.last && (key_time < span.first || key_time > span.last))
      outside.push_back(
          fmt::format("'{}' ({:g} to {:g} s)", name_of(document.model(), index), span.first, span.last));
  }
  poser.finish();
  if (outside.empty()) return;
  constexpr size_t named = 3;
  const std::string more = outside.size() > named ? fmt::format(" and {} more", outside.size() - named) : "";
  outside.resize(std::min(outside.size(), named));
  notices.push_back({Notice::Severity::info, "/animations",
                     fmt::format("the time asked for lies outside of animation {}{}, whose nearest key holds",
                                 fmt::join(outside, ", "), more)});
}

}  // namespace vernier
