// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/image/image_io.h"
#include "integrators/render/first_hit.h"

namespace vernier {

/// What layers are made from; each layer names what it needs, and nothing else is computed.
enum class LayerNeed { film, error, mean_hit, center_hit };

/// What is known of one pixel. Parts that no chosen layer needs are zero.
struct PixelFacts {
  const Film& film;
  int x = 0, y = 0;  ///< in the film
  Rgb error{0, 0, 0};
  bool unreliable = false;
  FirstHitMean mean_hit = {};
  std::optional<FirstHit> center_hit = {};
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

/// The layers of a list "error,samples", in the table's order, each once; "all" is every one, "" is none.
/// Throws Error(usage) naming the layer nearest to an unknown one.
std::vector<Layer> find_layers(const std::string& list);

/// The picture of `film`: R, G, B, A if it has alpha, and the channels of the chosen layers. The same values
/// for any number of threads. `options` are those that it was rendered with.
LayeredImage with_layers(const Film& film, std::span<const Layer> chosen, const Scene& scene,
                         const Camera& camera, const RenderSettings& options);

/// As find_layers, but throws Error(usage) when a layer needs the scene.
std::vector<Layer> find_film_layers(const std::string& list);

/// As with_layers, without a scene, for layers that find_film_layers gave.
LayeredImage with_film_layers(const Film& film, std::span<const Layer> chosen);

}  // namespace vernier
