// SPDX-License-Identifier: Apache-2.0
#include "scene/import/textures.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "vernier/error.h"

namespace vernier {
namespace {

/// An image that a texture may be read from.
struct Candidate {
  int image = -1;
  const char* extension = nullptr;  ///< that names it; null: it is the texture's own

  bool is_basisu() const { return extension == basisu; }
  static constexpr const char* basisu = "KHR_texture_basisu";
};

/// The best first.
std::vector<Candidate> candidates_of(const tinygltf::Texture& texture) {
  std::vector<Candidate> candidates;
  for (const char* name : {"EXT_texture_avif", "EXT_texture_webp", Candidate::basisu}) {
    const auto extension = texture.extensions.find(name);
    if (extension != texture.extensions.end())
      candidates.push_back({extension->second.Get("source").GetNumberAsInt(), name});
  }
  if (texture.source >= 0) candidates.push_back({texture.source});
  return candidates;
}

/// Why the image cannot be used; empty: it can.
std::string problem_of(const Candidate& candidate, const std::map<int, DecodedImage>& images) {
  const DecodedImage& image = images.at(candidate.image);
  if (!image.pixels) return image.problem;
  return candidate.is_basisu() ? image.basisu_problem : std::string();
}

/// Decodes, in parallel, those of the images that are not there yet.
void decode_missing(const Document& document, const std::vector<int>& indices, const TextureMemory& memory,
                    std::map<int, DecodedImage>& images) {
  std::vector<std::pair<int, DecodedImage*>> jobs;
  for (const int index : indices)
    if (const auto [image, is_new] = images.try_emplace(index); is_new)
      jobs.emplace_back(index, &image->second);
  memory.for_each_that_fits(
      jobs.size(), [&](size_t i) { return expected_bytes(document, jobs[i].first); },
      [&](size_t i) {
        DecodedImage& image = *jobs[i].second;
        image = decode_image(document, jobs[i].first);
        if (image.pixels) image.pixels = memory.keep(in_memory(*image.pixels));
      });
}

/// Decodes each texture's best image, and the next best where that fails, unless `images` has it. Returns the
/// indices of those that were looked at.
std::set<int> decode_images(const Document& document, const std::vector<std::vector<Candidate>>& candidates,
                            const TextureMemory& memory, std::map<int, DecodedImage>& images) {
  std::set<int> looked_at;
  for (size_t rank = 0; rank < 4; ++rank) {
    std::vector<int> wanted;
    for (const auto& list : candidates)
      if (rank < list.size() && (rank == 0 || !problem_of(list[rank - 1], images).empty()))
        wanted.push_back(list[rank].image);
    decode_missing(document, wanted, memory, images);
    looked_at.insert(wanted.begin(), wanted.end());
  }
  return looked_at;
}

WrapMode wrap_mode(int gltf) {
  if (gltf == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return WrapMode::clamp_to_edge;
  return gltf == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? WrapMode::mirrored_repeat : WrapMode::repeat;
}

Texture make_texture(const Document& document, const tinygltf::Texture& source, TexturePixels pixels) {
  if (source.sampler < 0) return {std::move(pixels), WrapMode::repeat, WrapMode::repeat, FilterMode::linear};
  const auto& sampler = document.model().samplers[size_t(source.sampler)];
  // Magnification decides: minification is what the many samples of a pixel do, and mipmaps if they are asked
  // for. Of these a file may say that it wants none.
  const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  const bool has_mips = sampler.minFilter != TINYGLTF_TEXTURE_FILTER_NEAREST &&
                        sampler.minFilter != TINYGLTF_TEXTURE_FILTER_LINEAR;
  return {std::move(pixels), wrap_mode(sampler.wrapS), wrap_mode(sampler.wrapT),
          nearest ? FilterMode::nearest : FilterMode::linear, has_mips};
}

/// What a texture is read from.
struct Choice {
  const DecodedImage* image = nullptr;  ///< null: there is nothing
  std::string problem = "it has no image";
  const char* failed_extension = nullptr;  ///< whose image has the problem, if there is one
};

/// The first candidate that can be used, and what was wrong with the first of those before it.
Choice choose(const std::map<int, DecodedImage>& images, const std::vector<Candidate>& candidates) {
  Choice choice;
  for (const Candidate& candidate : candidates) {
    const std::string problem = problem_of(candidate, images);
    if (problem.empty()) {
      choice.image = &images.at(candidate.image);
      break;
    }
    if (choice.failed_extension) continue;
    choice.problem = problem;
    choice.failed_extension = candidate.extension;
  }
  return choice;
}

TexturePixels magenta_texel() {
  const auto image = std::make_shared<Image8>(1, 1, 3);
  image->values = {255, 0, 255};
  return image;
}

/// glTF tells by what a texture is used for how it is read; a KTX2 file says so once more. Empty: they agree.
std::string transfer_problem(const WantedTexture& wanted, const DecodedImage& image) {
  using Transfer = ktx2::TransferFunction;
  if (!image.transfer) return {};
  const char* stated = *image.transfer == Transfer::srgb     ? "sRGB"
                       : *image.transfer == Transfer::linear ? "linear"
                                                             : "neither sRGB nor linear";
  if (wanted.as_srgb && *image.transfer != Transfer::srgb)
    return fmt::format("holds colors, which glTF has as sRGB, and is read so; its KTX2 file says {}", stated);
  if (wanted.as_linear && *image.transfer != Transfer::linear)
    return fmt::format("holds numbers, which glTF has as linear, and is read so; its KTX2 file says {}",
                       stated);
  return {};
}

/// A texture as messages call it.
std::string called(const Document& document, int texture) {
  const std::string& name = document.model().textures[size_t(texture)].name;
  return name.empty() ? "texture" : fmt::format("texture '{}'", name);
}

/// Reports how a texture's images were found: the notices of read_textures, and its error.
void report(const Document& document, int texture, const Choice& choice, std::vector<Notice>& notices) {
  const std::string place = fmt::format("/textures/{}", texture);
  const std::string texture_called = called(document, texture);
  const char* extension = choice.failed_extension;
  if (choice.image) {
    if (extension)
      notices.push_back(
          {Notice::Severity::warning, place,
           fmt::format("the image that {} gives {} cannot be used and another stands for it: {}", extension,
                       texture_called, choice.problem)});
    return;
  }
  const std::string problem = fmt::format("{} cannot be read: {}", texture_called, choice.problem);
  const auto& required = document.model().extensionsRequired;
  if (extension && std::find(required.begin(), required.end(), extension) != required.end())
    document.fail(place,
                  fmt::format("{}; the scene requires {} and no image stands for it", problem, extension));
  notices.push_back({Notice::Severity::warning, place,
                     problem + ". Where it colours a surface that is magenta, elsewhere it is left out"});
}

/// What textures will take that are not there yet, as far as the files' headers tell: of each the first image
/// that it may be read from, and a roughness that is made of one.
uint64_t new_bytes(const Document& document, const std::vector<WantedTexture>& wanted,
                   const std::vector<std::vector<Candidate>>& candidates, const ImageCache& cache) {
  const int from_file = int(document.model().textures.size());
  std::map<int, uint64_t> of_images;
  uint64_t bytes = 0;
  for (size_t i = 0; i < wanted.size(); ++i) {
    if (candidates[i].empty()) continue;
    const int image = candidates[i].front().image;
    const auto [expected, is_new] = of_images.try_emplace(image);
    if (is_new) expected->second = expected_bytes(document, image);
    if (is_new && !cache.images.contains(image)) bytes += expected->second;
    if (wanted[i].index >= from_file && !cache.roughness.contains(wanted[i].index)) bytes += expected->second;
  }
  return bytes;
}

}  // namespace

DecodedTextures read_textures(const Document& document, const std::vector<WantedTexture>& wanted,
                              const std::vector<RoughnessFromGlossiness>& derived, ImageCache& cache,
                              std::vector<Notice>& notices) {
  const auto& textures = document.model().textures;
  const int from_file = int(textures.size());
  const auto source_of = [&](int index) {
    return index < from_file ? index : derived[size_t(index - from_file)].texture;
  };
  std::vector<std::vector<Candidate>> candidates;
  candidates.reserve(wanted.size());
  for (const WantedTexture& texture : wanted)
    candidates.push_back(candidates_of(textures[size_t(source_of(texture.index))]));
  if (cache.memory.is_limited())
    cache.memory.make_room(new_bytes(document, wanted, candidates, cache), notices);
  const std::set<int> looked_at = decode_images(document, candidates, cache.memory, cache.images);

  DecodedTextures result;
  std::set<int> reported;
  for (const WantedTexture& texture : wanted) {
    const int source = source_of(texture.index);
    const Choice choice = choose(cache.images, candidates_of(textures[size_t(source)]));
    if (reported.insert(source).second) report(document, source, choice, notices);
    result.unreadable.push_back(!choice.image);
    TexturePixels pixels = choice.image ? *choice.image->pixels : magenta_texel();
    if (choice.image && texture.index >= from_file) {
      const auto [roughness, is_new] = cache.roughness.try_emplace(texture.index);
      if (is_new)
        roughness->second = cache.memory.keep(
            roughness_of(in_memory(pixels), derived[size_t(texture.index - from_file)].factor));
      pixels = roughness->second;
    } else if (choice.image) {
      if (const std::string problem = transfer_problem(texture, *choice.image); !problem.empty())
        notices.push_back({Notice::Severity::warning, fmt::format("/textures/{}", source),
                           fmt::format("{} {}", called(document, source), problem)});
    }
    result.textures.push_back(make_texture(document, textures[size_t(source)], std::move(pixels)));
  }
  for (const int index : looked_at) {
    const DecodedImage& image = cache.images.at(index);
    if (!image.fingerprint.empty()) result.fingerprints.push_back(image.fingerprint);
    for (const auto& remark : image.remarks)
      notices.push_back({Notice::Severity::warning, fmt::format("/images/{}", index), remark});
  }
  return result;
}

}  // namespace vernier
