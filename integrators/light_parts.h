// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/lights/light.h"
#include "scene/shading.h"
#include "vernier/settings.h"

// Light kept apart in a picture: by the way it came to the camera, and by its source. The parts of either
// kind add up to the picture.

namespace vernier {

class Scene;

/// Ways of light to the camera, by the surface that the camera sees. Diffuse is what the body of a surface
/// scatters, to either side; transmission what passes a clear boundary; glossy the rest; volume what a medium
/// scatters before any surface. Light is direct when it comes there from its source, straight or through what
/// does not bend it.
enum class LightWay {
  emission,    ///< of the surface itself
  background,  ///< what lies behind all surfaces
  diffuse_direct,
  diffuse_indirect,
  glossy_direct,
  glossy_indirect,
  transmission_direct,
  transmission_indirect,
  volume_direct,
  volume_indirect
};
constexpr size_t light_way_count = 10;

/// Layers that hold them, in that order: "diffuse_direct".
std::span<const std::string_view> light_way_names();

/// Groups that a render can have, those of no group included.
constexpr size_t most_light_groups = 16;

/// One sample's light in parts.
struct LightParts {
  std::array<Rgb, light_way_count> ways;
  std::array<Rgb, most_light_groups> groups;

  LightParts() {
    ways.fill(Rgb(0, 0, 0));
    groups.fill(Rgb(0, 0, 0));
  }
};

/// On which way light comes that a path may yet find.
class LightRoute {
 public:
  /// The route after scattering at a surface, toward its light in the direction wi (world). What passes the
  /// surface straight on does not count, but for the first surface of all.
  LightRoute scattered(const Shading& surface, const Vec3f& wi, bool is_delta, bool is_straight) const {
    LightRoute next = *this;
    if (scatterings_ > 0 && is_straight) return next;
    ++next.scatterings_;
    if (scatterings_ > 0) return next;
    next.is_in_medium_ = surface.is_in_medium();
    next.is_transmitted_ = !next.is_in_medium_ && surface.is_transmitted(wi);
    if (!is_delta) next.diffuse_ = surface.diffuse_share(wi);
    return next;
  }

  void add(LightParts& parts, const Rgb& radiance, bool is_from_surface) const {
    const auto way = [&](LightWay direct) -> Rgb& { return parts.ways[size_t(direct) + (scatterings_ > 1)]; };
    if (scatterings_ == 0) {
      parts.ways[size_t(is_from_surface ? LightWay::emission : LightWay::background)] += radiance;
      return;
    }
    if (is_in_medium_) {
      way(LightWay::volume_direct) += radiance;
      return;
    }
    way(LightWay::diffuse_direct) += radiance * diffuse_;
    way(is_transmitted_ ? LightWay::transmission_direct : LightWay::glossy_direct) +=
        radiance * (Rgb(1, 1, 1) - diffuse_);
  }

 private:
  int scatterings_ = 0;
  Rgb diffuse_{0, 0, 0};  ///< share of what the first surface scatters
  bool is_transmitted_ = false;
  bool is_in_medium_ = false;
};

/// Which parts a render keeps apart, and into which group each source of light goes.
class LightSorter {
 public:
  /// Throws Error(usage) on a way or a light that there is not, and on too many groups.
  LightSorter(const LightSplit& split, const Scene& scene);

  /// Layers of the parts, by the number that part() takes.
  const std::vector<std::string>& layers() const { return layers_; }
  bool is_empty() const { return layers_.empty(); }

  void add(LightParts& parts, const Rgb& radiance, const LightRoute& route, LightSource source) const {
    route.add(parts, radiance, source.kind == LightSource::Kind::instance);
    parts.groups[group_of(source)] += radiance;
  }
  /// The part of a layer.
  const Rgb& part(const LightParts& parts, size_t layer) const {
    return layer < ways_.size() ? parts.ways[ways_[layer]] : parts.groups[layer - ways_.size()];
  }

 private:
  size_t group_of(LightSource source) const {
    if (layers_.size() == ways_.size()) return 0;  // nobody asks for groups
    switch (source.kind) {
      case LightSource::Kind::instance:
        return group_of_instance_[source.index];
      case LightSource::Kind::lamp:
        return group_of_lamp_[source.index];
      case LightSource::Kind::environment:
        return group_of_environment_;
    }
    return 0;
  }

  std::vector<std::string> layers_;
  std::vector<size_t> ways_;  ///< those asked for
  std::vector<uint8_t> group_of_instance_, group_of_lamp_;
  uint8_t group_of_environment_ = 0;
};

}  // namespace vernier
