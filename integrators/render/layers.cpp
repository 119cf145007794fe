// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/layers.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "core/base/names.h"
#include "core/base/parallel.h"
#include "core/film/error_estimate.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using P = const PixelFacts&;

template <typename V>
void put(const V& v, float* out) {
  for (int c = 0; c < 3; ++c) out[c] = float(v[c]);
}

Vec3d square_root(const Vec3d& v) { return {std::sqrt(v.x), std::sqrt(v.y), std::sqrt(v.z)}; }

constexpr Layer table[] = {
    {"error",
     "standard error of the pixel; unreliable is 1 where it is not to be trusted, else 0",
     {"error.R", "error.G", "error.B", "error.unreliable"},
     LayerNeed::error,
     [](P p, float* out) { put(p.error, out), out[3] = p.unreliable; }},
    {"samples",
     "number of samples of the pixel",
     {"samples"},
     LayerNeed::film,
     [](P p, float* out) { out[0] = float(p.film.samples(p.x, p.y)); }},
    {"variance",
     "variance of a single sample of the pixel",
     {"variance.R", "variance.G", "variance.B"},
     LayerNeed::film,
     [](P p, float* out) { put(p.film.sample_variance(p.x, p.y), out); }},
    {"half",
     "the two independent pictures whose mean the picture is, and the spread of each",
     {"half1.R", "half1.G", "half1.B", "half2.R", "half2.G", "half2.B", "half1Spread.R", "half1Spread.G",
      "half1Spread.B", "half2Spread.R", "half2Spread.G", "half2Spread.B"},
     LayerNeed::film,
     [](P p, float* out) {
       for (int half = 0; half < Film::halves; ++half, out += 3) {
         put(p.film.half_mean(p.x, p.y, half), out);
         put(square_root(p.film.half_mean_variance(p.x, p.y, half)), out + 3 * Film::halves);
       }
     }},
    {"albedo",
     "fraction of light that the first surface scatters toward the camera, mean over samples",
     {"albedo.R", "albedo.G", "albedo.B"},
     LayerNeed::mean_hit,
     [](P p, float* out) { put(p.mean_hit.albedo, out); }},
    {"normal",
     "shading normal of the first surface toward the camera, world space, mean over samples",
     {"N.X", "N.Y", "N.Z"},
     LayerNeed::mean_hit,
     [](P p, float* out) { put(p.mean_hit.normal, out); }},
    {"coverage",
     "part of the samples that meet a surface",
     {"coverage"},
     LayerNeed::mean_hit,
     [](P p, float* out) { out[0] = p.mean_hit.coverage; }},
    {"depth",
     "metres along the camera's axis to what the pixel's centre shows; infinite where that is nothing",
     {"Z"},
     LayerNeed::center_hit,
     [](P p, float* out) {
       out[0] = p.center_hit ? p.center_hit->depth : std::numeric_limits<float>::infinity();
     }},
    {"position",
     "world-space point that the pixel's centre shows; zero where that is nothing",
     {"P.X", "P.Y", "P.Z"},
     LayerNeed::center_hit,
     [](P p, float* out) { put(p.center_hit ? p.center_hit->position : Vec3f(0, 0, 0), out); }},
    {"id",
     "number, from 1, of the mesh instance that the pixel's centre shows; zero where that is none",
     {"id"},
     LayerNeed::center_hit,
     [](P p, float* out) { out[0] = p.center_hit ? float(p.center_hit->instance + 1) : 0; }},
};

bool any_needs(std::span<const Layer> chosen, LayerNeed need) {
  return std::any_of(chosen.begin(), chosen.end(), [need](const Layer& l) { return l.need == need; });
}

/// `first_hits` may be null when no layer needs them.
LayeredImage assemble(const Film& film, std::span<const Layer> chosen, const FirstHits* first_hits) {
  LayeredImage picture;
  picture.linear = true;
  picture.channel_names = {"R", "G", "B"};
  if (film.has_alpha()) picture.channel_names.emplace_back("A");
  for (const Layer& layer : chosen)
    for (int c = 0; c < layer.channel_count(); ++c)
      picture.channel_names.emplace_back(layer.channels[size_t(c)]);
  picture.image = Image(film.width(), film.height(), int(picture.channel_names.size()));

  const ErrorLayers error = any_needs(chosen, LayerNeed::error) ? error_layers(film) : ErrorLayers{};
  const bool needs_mean = any_needs(chosen, LayerNeed::mean_hit);
  const bool needs_center = any_needs(chosen, LayerNeed::center_hit);
  parallel_for(size_t(film.height()), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < film.width(); ++x) {
      PixelFacts pixel{film, x, y};
      if (!error.standard_error.empty()) {
        pixel.error = rgb_at(error.standard_error, x, y);
        pixel.unreliable = *error.unreliable.pixel(x, y) > 0;
      }
      if (needs_mean) pixel.mean_hit = first_hits->mean(x, y);
      if (needs_center) pixel.center_hit = first_hits->at_center(x, y);
      float* out = picture.image.pixel(x, y);
      put(film.pixel(x, y), out);
      out += 3;
      if (film.has_alpha()) *out++ = float(film.alpha(x, y));
      for (const Layer& layer : chosen) {
        layer.write(pixel, out);
        out += layer.channel_count();
      }
    }
  });
  return picture;
}

}  // namespace

std::span<const Layer> layers() { return table; }

std::vector<Layer> find_layers(const std::string& list) {
  if (list.empty()) return {};
  std::vector<std::string_view> names;
  for (size_t begin = 0; begin <= list.size();) {
    const size_t end = std::min(list.find(',', begin), list.size());
    const std::string_view name = std::string_view(list).substr(begin, end - begin);
    names.push_back(name == "all" ? name : find_by_name(table, "layer", name).name);
    begin = end + 1;
  }
  std::vector<Layer> found;
  for (const Layer& layer : table)
    if (std::any_of(names.begin(), names.end(), [&](auto n) { return n == layer.name || n == "all"; }))
      found.push_back(layer);
  return found;
}

LayeredImage with_layers(const Film& film, std::span<const Layer> chosen, const Scene& scene,
                         const Camera& camera, const RenderSettings& options) {
  const FirstHits first_hits(scene, camera, options, film);
  return assemble(film, chosen, &first_hits);
}

std::vector<Layer> find_film_layers(const std::string& list) {
  std::vector<Layer> found = find_layers(list);
  for (const Layer& layer : found)
    if (layer.need == LayerNeed::mean_hit || layer.need == LayerNeed::center_hit)
      throw Error(
          ErrorKind::usage, {}, "--aov",
          fmt::format("{} is looked up in the scene, which is not there; only error, samples, variance "
                      "and half come from the samples alone",
                      layer.name));
  return found;
}

LayeredImage with_film_layers(const Film& film, std::span<const Layer> chosen) {
  return assemble(film, chosen, nullptr);
}

}  // namespace vernier
