// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image_io.h"
#include "integrators/render/cryptomatte.h"
#include "integrators/render/first_hit.h"
#include "integrators/render/motion.h"

namespace vernier {

/// What layers are made from; each layer names what it needs, and nothing else is computed.
/// From mean_hit on, the scene.
enum class LayerNeed { film, error, light, mean_hit, center_hit, motion, shadow, mattes };

/// What is known of one pixel. Parts that no chosen layer needs are zero.
struct PixelFacts {
  const Film& film;
  const std::array<const Film*, light_way_count>& ways;  ///< null: not kept apart
  int x = 0, y = 0;                                      ///< in the film
  Rgb error{0, 0, 0};
  bool unreliable = false;
  FirstHitMean mean_hit = {};
  std::optional<FirstHit> center_hit = {};
  PixelMotion motion = {};
  Rgb lit{1, 1, 1};
  MetInstances met = {};
  const CryptomatteIds* ids = nullptr;
};

/// One line of the table of layers.
struct Layer {
  std::string_view name;
  std::string_view description;
  std::array<std::string_view, 12> channels;  ///< names in the file; empty ones at the end count for nothing
  LayerNeed need;
  void (*write)(const PixelFacts& pixel, float* channels);

  int channel_count() const {
    int count = 0;
    for (const auto& channel : this->channels) count += !channel.empty();
    return count;
  }
};

/// All layers that a picture can have beside its colour (integrators/layers.cpp).
std::span<const Layer> layers();

/// The layers of a list "error,samples", in the table's order, each once; "light" is every way of light,
/// "all" every layer that needs neither RenderSettings::light_split nor other moments, "" is none. Throws
/// Error(usage) naming the layer nearest to an unknown one.
std::vector<Layer> find_layers(const std::string& list);

/// The ways of light among the layers, as RenderSettings::light_split takes them.
std::vector<std::string> light_ways_of(std::span<const Layer> chosen);

/// The picture of `result`: R, G, B, A if it has alpha, the channels of the chosen layers, those of its
/// groups of lights, and with the layer `error` the errors of its parts of light. The same values for any
/// number of threads. `options` are those that it was rendered with; `moments` may be null where no layer
/// needs them. Throws Error(usage) about a part of light that they do not name.
LayeredImage with_layers(const RenderResult& result, std::span<const Layer> chosen, const Scene& scene,
                         const Camera& camera, const RenderSettings& options,
                         const Moments* moments = nullptr);

/// As find_layers, but throws Error(usage) when a layer needs the scene.
std::vector<Layer> find_film_layers(const std::string& list);

/// As with_layers, without a scene, for layers that find_film_layers gave.
LayeredImage with_film_layers(const RenderResult& result, std::span<const Layer> chosen);

}  // namespace vernier
