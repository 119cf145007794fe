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

template <LightWay way>
void put_way(P pixel, float* out) {
  put(pixel.ways[size_t(way)]->pixel(pixel.x, pixel.y), out);
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
    {"emission",
     "light that the surface that the camera sees emits",
     {"emission.R", "emission.G", "emission.B"},
     LayerNeed::light,
     put_way<LightWay::emission>},
    {"background",
     "what lies behind all surfaces",
     {"background.R", "background.G", "background.B"},
     LayerNeed::light,
     put_way<LightWay::background>},
    {"diffuse_direct",
     "light of sources that the body of the first surface scatters",
     {"diffuse_direct.R", "diffuse_direct.G", "diffuse_direct.B"},
     LayerNeed::light,
     put_way<LightWay::diffuse_direct>},
    {"diffuse_indirect",
     "light of other surfaces that the body of the first surface scatters",
     {"diffuse_indirect.R", "diffuse_indirect.G", "diffuse_indirect.B"},
     LayerNeed::light,
     put_way<LightWay::diffuse_indirect>},
    {"glossy_direct",
     "light of sources that the first surface mirrors",
     {"glossy_direct.R", "glossy_direct.G", "glossy_direct.B"},
     LayerNeed::light,
     put_way<LightWay::glossy_direct>},
    {"glossy_indirect",
     "light of other surfaces that the first surface mirrors",
     {"glossy_indirect.R", "glossy_indirect.G", "glossy_indirect.B"},
     LayerNeed::light,
     put_way<LightWay::glossy_indirect>},
    {"transmission_direct",
     "light of sources through a clear first surface",
     {"transmission_direct.R", "transmission_direct.G", "transmission_direct.B"},
     LayerNeed::light,
     put_way<LightWay::transmission_direct>},
    {"transmission_indirect",
     "light of other surfaces through a clear first surface",
     {"transmission_indirect.R", "transmission_indirect.G", "transmission_indirect.B"},
     LayerNeed::light,
     put_way<LightWay::transmission_indirect>},
    {"volume_direct",
     "light of sources that fog or another medium scatters before any surface",
     {"volume_direct.R", "volume_direct.G", "volume_direct.B"},
     LayerNeed::light,
     put_way<LightWay::volume_direct>},
    {"volume_indirect",
     "other light that a medium scatters before any surface",
     {"volume_indirect.R", "volume_indirect.G", "volume_indirect.B"},
     LayerNeed::light,
     put_way<LightWay::volume_indirect>},
    {"light_groups",
     "light of each of --light-groups, light_NAME, and of all other lights, light_rest",
     {},
     LayerNeed::light,
     [](P, float*) {}},
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
    {"material",
     "number, from 1, of the material that the pixel's centre shows; zero where that is none",
     {"material"},
     LayerNeed::center_hit,
     [](P p, float* out) { out[0] = p.center_hit ? float(p.center_hit->material + 1) : 0; }},
    {"uv",
     "texture coordinates that the pixel's centre shows, the first that its material uses; zero without any",
     {"UV.U", "UV.V"},
     LayerNeed::center_hit,
     [](P p, float* out) {
       const Vec2f uv = p.center_hit ? p.center_hit->uv : Vec2f(0, 0);
       out[0] = uv.x, out[1] = uv.y;
     }},
    {"shadow",
     "part of the lights' irradiance on the first surface that nothing hides, mean over samples",
     {"shadow.R", "shadow.G", "shadow.B"},
     LayerNeed::shadow,
     [](P p, float* out) { put(p.lit, out); }},
    {"motion",
     "pixels from what the pixel's centre shows to where it is in the pictures before and after",
     {"Vector.X", "Vector.Y", "Vector.Z", "Vector.W", "forward.u", "forward.v", "backward.u", "backward.v"},
     LayerNeed::motion,
     [](P p, float* out) {
       const auto [previous, next] = p.motion;
       // As Cycles has its vectors: to the previous place, and from the next one. Zero has no sign.
       const float values[] = {previous.x, previous.y, 0 - next.x, 0 - next.y,
                               next.x,     next.y,     previous.x, previous.y};
       std::copy(std::begin(values), std::end(values), out);
     }},
    {"crypto_object",
     "Cryptomatte by the names of nodes",
     {"CryptoObject00.r", "CryptoObject00.g", "CryptoObject00.b", "CryptoObject00.a", "CryptoObject01.r",
      "CryptoObject01.g", "CryptoObject01.b", "CryptoObject01.a", "CryptoObject02.r", "CryptoObject02.g",
      "CryptoObject02.b", "CryptoObject02.a"},
     LayerNeed::mattes,
     [](P p, float* out) { p.ids->write(p.met, &SceneNames::Instance::object, out); }},
    {"crypto_material",
     "Cryptomatte by the names of materials",
     {"CryptoMaterial00.r", "CryptoMaterial00.g", "CryptoMaterial00.b", "CryptoMaterial00.a",
      "CryptoMaterial01.r", "CryptoMaterial01.g", "CryptoMaterial01.b", "CryptoMaterial01.a",
      "CryptoMaterial02.r", "CryptoMaterial02.g", "CryptoMaterial02.b", "CryptoMaterial02.a"},
     LayerNeed::mattes,
     [](P p, float* out) { p.ids->write(p.met, &SceneNames::Instance::material, out); }},
    {"crypto_asset",
     "Cryptomatte by the names of the nodes at the top, of which others are parts",
     {"CryptoAsset00.r", "CryptoAsset00.g", "CryptoAsset00.b", "CryptoAsset00.a", "CryptoAsset01.r",
      "CryptoAsset01.g", "CryptoAsset01.b", "CryptoAsset01.a", "CryptoAsset02.r", "CryptoAsset02.g",
      "CryptoAsset02.b", "CryptoAsset02.a"},
     LayerNeed::mattes,
     [](P p, float* out) { p.ids->write(p.met, &SceneNames::Instance::asset, out); }},
};

bool any_needs(std::span<const Layer> chosen, LayerNeed need) {
  return std::any_of(chosen.begin(), chosen.end(), [need](const Layer& l) { return l.need == need; });
}

/// What the header says of the mattes among the layers.
Metadata matte_metadata(std::span<const Layer> chosen, const CryptomatteIds& ids,
                        const LayeredImage& picture) {
  Metadata metadata;
  for (const Layer& layer : chosen) {
    if (layer.need != LayerNeed::mattes) continue;
    const auto first =
        std::find(picture.channel_names.begin(), picture.channel_names.end(), layer.channels[0]);
    const std::string_view name = layer.channels[0].substr(0, layer.channels[0].size() - 4);  // "00.r"
    metadata.merge(ids.metadata(name, picture.image, int(first - picture.channel_names.begin())));
  }
  return metadata;
}

bool is_group(const LightFilm& part) { return part.layer.starts_with("light_"); }

bool is_chosen(std::span<const Layer> chosen, std::string_view name) {
  return std::any_of(chosen.begin(), chosen.end(), [&](const Layer& layer) { return layer.name == name; });
}

/// The films of the ways of light; null where they are not kept apart, which no chosen layer may need.
std::array<const Film*, light_way_count> ways_of(const RenderResult& result, std::span<const Layer> chosen) {
  std::array<const Film*, light_way_count> ways{};
  for (size_t i = 0; i < light_way_count; ++i) {
    const std::string_view name = light_way_names()[i];
    for (const LightFilm& part : result.light)
      if (part.layer == name) ways[i] = &part.film;
    if (is_chosen(chosen, name) && !ways[i])
      throw Error(ErrorKind::usage, {}, std::string(name),
                  "was not kept apart while rendering; ask for it by RenderSettings::light_split");
  }
  return ways;
}

/// Groups of lights, whose number the table does not know, and the errors of all parts that are shown.
void append_light(const RenderResult& result, std::span<const Layer> chosen, LayeredImage& picture) {
  const bool has_groups = is_chosen(chosen, "light_groups"), has_errors = is_chosen(chosen, "error");
  for (const LightFilm& part : result.light) {
    if (is_group(part) ? !has_groups : !is_chosen(chosen, part.layer)) continue;
    const auto append = [&](const Image& image, const std::string& name) {
      picture.append(image, {name + ".R", name + ".G", name + ".B"});
    };
    if (is_group(part)) append(part.film.image(), part.layer);
    if (has_errors) append(error_layers(part.film).standard_error, part.layer + "_error");
  }
}

/// Without a scene no layer may need it.
LayeredImage assemble(const RenderResult& result, std::span<const Layer> chosen, const Scene* scene,
                      const FirstHits* first_hits, const MotionFinder* motion) {
  const Film& film = result.film;
  const auto ways = ways_of(result, chosen);
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
  const bool needs_motion = any_needs(chosen, LayerNeed::motion);
  const bool needs_center = needs_motion || any_needs(chosen, LayerNeed::center_hit);
  const bool needs_shadow = any_needs(chosen, LayerNeed::shadow);
  const bool needs_mattes = any_needs(chosen, LayerNeed::mattes);
  const CryptomatteIds ids = needs_mattes ? CryptomatteIds(scene->names()) : CryptomatteIds();
  parallel_for(size_t(film.height()), [&](size_t row) {
    const int y = int(row);
    for (int x = 0; x < film.width(); ++x) {
      PixelFacts pixel{film, ways, x, y};
      if (!error.standard_error.empty()) {
        pixel.error = rgb_at(error.standard_error, x, y);
        pixel.unreliable = *error.unreliable.pixel(x, y) > 0;
      }
      if (needs_mean) pixel.mean_hit = first_hits->mean(x, y);
      if (needs_center) pixel.center_hit = first_hits->at_center(x, y);
      if (needs_motion && pixel.center_hit)
        pixel.motion = motion->at({pixel.center_hit->instance, pixel.center_hit->primitive},
                                  pixel.center_hit->barycentrics);
      if (needs_shadow) pixel.lit = first_hits->lit(x, y);
      if (needs_mattes) pixel.met = first_hits->met(x, y), pixel.ids = &ids;
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
  picture.metadata = matte_metadata(chosen, ids, picture);
  append_light(result, chosen, picture);
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
    const bool is_several = name == "all" || name == "light";
    names.push_back(is_several ? name : find_by_name(table, "layer", name).name);
    begin = end + 1;
  }
  const auto is_asked = [&](const Layer& layer) {
    const bool is_light = layer.need == LayerNeed::light, is_motion = layer.need == LayerNeed::motion;
    const bool is_way = is_light && layer.channel_count() > 0;
    return std::any_of(names.begin(), names.end(), [&](std::string_view name) {
      return name == layer.name || (name == "all" && !is_light && !is_motion) || (name == "light" && is_way);
    });
  };
  std::vector<Layer> found;
  std::copy_if(std::begin(table), std::end(table), std::back_inserter(found), is_asked);
  return found;
}

std::vector<std::string> light_ways_of(std::span<const Layer> chosen) {
  std::vector<std::string> ways;
  for (const Layer& layer : chosen)
    if (layer.need == LayerNeed::light && layer.channel_count() > 0) ways.emplace_back(layer.name);
  return ways;
}

LayeredImage with_layers(const RenderResult& result, std::span<const Layer> chosen, const Scene& scene,
                         const Camera& camera, const RenderSettings& options, const Moments* moments) {
  const FirstHits first_hits(scene, camera, options, result.film);
  std::optional<MotionFinder> motion;
  if (moments) motion.emplace(scene, camera, *moments, options.width, options.height);
  if (!motion && any_needs(chosen, LayerNeed::motion))
    throw Error(ErrorKind::usage, {}, "motion",
                "compares a picture with those before and after it, which RenderSession::set_moments tells");
  return assemble(result, chosen, &scene, &first_hits, motion ? &*motion : nullptr);
}

std::vector<Layer> find_film_layers(const std::string& list) {
  std::vector<Layer> found = find_layers(list);
  for (const Layer& layer : found)
    if (layer.need > LayerNeed::light)
      throw Error(
          ErrorKind::usage, {}, "--aov",
          fmt::format("{} is looked up in the scene, which is not there; only error, samples, variance "
                      "and half come from the samples alone",
                      layer.name));
  return found;
}

LayeredImage with_film_layers(const RenderResult& result, std::span<const Layer> chosen) {
  return assemble(result, chosen, nullptr, nullptr, nullptr);
}

}  // namespace vernier
