// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>

#include "core/base/names.h"
#include "scene/import/animation_track.h"
#include "scene/import/pose.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using Imath::Quatd;

/// What a channel sets: a property of a node.
using Target = std::pair<int, std::string>;

bool sets_pose(const tinygltf::AnimationChannel& channel) {
  static const std::set<std::string> paths{"translation", "rotation", "scale", "weights"};
  return channel.target_node >= 0 && paths.count(channel.target_path) > 0;
}

std::string name_of(const tinygltf::Model& model, size_t animation) {
  const std::string& name = model.animations[animation].name;
  return name.empty() ? std::to_string(animation) : name;
}

/// How many targets more than one of the animations sets.
size_t shared_targets(const tinygltf::Model& model) {
  std::map<Target, size_t> setter;
  std::set<Target> shared;
  for (size_t i = 0; i < model.animations.size(); ++i)
    for (const auto& channel : model.animations[i].channels) {
      if (!sets_pose(channel)) continue;
      const Target target(channel.target_node, channel.target_path);
      if (setter.try_emplace(target, i).first->second != i) shared.insert(target);
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
  const size_t shared = shared_targets(model);
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
         fmt::format("{} properties of nodes are set by more than one animation; the "
                     "last in the file holds",
                     shared));
  std::vector<size_t> all(count);
  for (size_t i = 0; i < count; ++i) all[i] = i;
  return all;
}

void set_pose(const std::string& path, const std::vector<double>& value, NodePose& pose) {
  if (path == "weights") pose.weights = value;
  if (path == "translation") pose.translation = {value[0], value[1], value[2]};
  if (path == "scale") pose.scale = {value[0], value[1], value[2]};
  if (path == "rotation") pose.rotation = Quatd(value[3], value[0], value[1], value[2]).normalized();
}

/// First and last of the times of keys, in seconds.
struct TimeSpan {
  double first = std::numeric_limits<double>::infinity(), last = -first;
};

TimeSpan apply_animation(const Document& document, size_t index, double time, std::vector<NodePose>& poses) {
  const auto& animation = document.model().animations[index];
  TimeSpan span;
  for (const auto& channel : animation.channels) {
    if (!sets_pose(channel)) continue;
    if (size_t(channel.sampler) >= animation.samplers.size())
      document.fail(
          fmt::format("/animations/{}", index),
          fmt::format("a channel uses sampler {} of {}", channel.sampler, animation.samplers.size()));
    NodePose& pose = poses[size_t(channel.target_node)];
    const bool rotation = channel.target_path == "rotation", weights = channel.target_path == "weights";
    if (!weights && pose.matrix)
      document.fail(fmt::format("/nodes/{}/matrix", channel.target_node),
                    "an animated node must have translation, rotation and scale instead of a matrix");
    const Track track(document, animation.samplers[size_t(channel.sampler)],
                      fmt::format("/animations/{}/samplers/{}", index, channel.sampler));
    if (!weights) track.expect_width(rotation ? 4 : 3);
    set_pose(channel.target_path, track.at(time, rotation), pose);
    span.first = std::min(span.first, track.first_time());
    span.last = std::max(span.last, track.last_time());
  }
  return span;
}

}  // namespace

void pose_by_animations(const Document& document, const std::string& wanted, double time,
                        std::vector<NodePose>& poses, std::vector<Notice>& notices) {
  std::vector<std::string> outside;
  for (const size_t index : choose_animations(document, wanted, notices)) {
    const TimeSpan span = apply_animation(document, index, time, poses);
    const double key_time = double(float(time));  // as keys are stored
    if (span.first <= span.last && (key_time < span.first || key_time > span.last))
      outside.push_back(
          fmt::format("'{}' ({:g} to {:g} s)", name_of(document.model(), index), span.first, span.last));
  }
  if (outside.empty()) return;
  constexpr size_t named = 3;
  const std::string more = outside.size() > named ? fmt::format(" and {} more", outside.size() - named) : "";
  outside.resize(std::min(outside.size(), named));
  notices.push_back({Notice::Severity::info, "/animations",
                     fmt::format("the time asked for lies outside of animation {}{}, whose nearest key holds",
                                 fmt::join(outside, ", "), more)});
}

}  // namespace vernier
