// SPDX-License-Identifier: Apache-2.0
#include "scene/import/textures.h"

#include <fmt/format.h>

#include <cstring>
#include <map>
#include <set>

#include "core/base/fingerprint.h"
#include "core/image/image_io.h"
#include "scene/import/data_uri.h"
#include "scene/import/ordered_parallel.h"
#include "vernier/error.h"

namespace vernier {
namespace {

bool is_ktx2(std::span<const uint8_t> bytes) {
  const uint8_t signature[] = {0xAB, 'K', 'T', 'X', ' ', '2', '0', 0xBB, '\r', '\n', 0x1A, '\n'};
  return bytes.size() >= sizeof(signature) && std::memcmp(bytes.data(), signature, sizeof(signature)) == 0;
}

/// Images that a texture may be read from, the best first.
std::vector<int> candidate_images(const tinygltf::Texture& texture) {
  std::vector<int> images;
  for (const char* name : {"EXT_texture_webp", "KHR_texture_basisu"}) {
    const auto extension = texture.extensions.find(name);
    if (extension != texture.extensions.end())
      images.push_back(extension->second.Get("source").GetNumberAsInt());
  }
  if (texture.source >= 0) images.push_back(texture.source);
  return images;
}

/// Decodes, in parallel, those of the images that are not there yet.
void decode_missing(const Document& document, const std::vector<int>& indices,
                    std::map<int, DecodedImage>& images) {
  std::vector<std::pair<int, DecodedImage*>> jobs;
  for (const int index : indices)
    if (const auto [image, is_new] = images.try_emplace(index); is_new)
      jobs.emplace_back(index, &image->second);
  for_each_in_parallel(jobs.size(),
                       [&](size_t i) { *jobs[i].second = decode_image(document, jobs[i].first); });
}

/// Decodes each texture's best image, and the next best where that fails.
std::map<int, DecodedImage> decode_images(const Document& document, const std::vector<int>& textures) {
  std::map<int, DecodedImage> images;
  std::vector<std::vector<int>> candidates;
  candidates.reserve(textures.size());
  for (const int texture : textures)
    candidates.push_back(candidate_images(document.model().textures[size_t(texture)]));
  for (size_t rank = 0; rank < 3; ++rank) {
    std::vector<int> wanted;
    for (const auto& list : candidates)
      if (rank < list.size() && (rank == 0 || !images.at(list[rank - 1]).pixels))
        wanted.push_back(list[rank]);
    decode_missing(document, wanted, images);
  }
  return images;
}

WrapMode wrap_mode(int gltf) {
  if (gltf == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE) return WrapMode::clamp_to_edge;
  return gltf == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? WrapMode::mirrored_repeat : WrapMode::repeat;
}

Texture make_texture(const Document& document, const tinygltf::Texture& source,
                     std::shared_ptr<const Image8> pixels) {
  if (source.sampler < 0) return {std::move(pixels), WrapMode::repeat, WrapMode::repeat, FilterMode::linear};
  const auto& sampler = document.model().samplers[size_t(source.sampler)];
  // Magnification decides: minification is what the many samples of a pixel do.
  const bool nearest = sampler.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
  return {std::move(pixels), wrap_mode(sampler.wrapS), wrap_mode(sampler.wrapT),
          nearest ? FilterMode::nearest : FilterMode::linear};
}

/// The first of the candidates that has pixels; without one, why the last has none.
DecodedImage first_decoded(const std::map<int, DecodedImage>& images, const std::vector<int>& candidates) {
  DecodedImage result;
  result.problem = "it has no image";
  for (const int candidate : candidates) {
    const auto image = images.find(candidate);
    if (image == images.end()) break;
    result = image->second;
    if (result.pixels) break;
  }
  return result;
}

std::shared_ptr<const Image8> magenta_texel() {
  auto image = std::make_shared<Image8>(1, 1, 3);
  image->values = {255, 0, 255};
  return image;
}

}  // namespace

DecodedImage decode_image(const Document& document, int index) {
  const ImageSource& source = document.images()[size_t(index)];
  const std::string place = fmt::format("/images/{}", index);
  DecodedImage image;
  Bytes file;
  std::span<const uint8_t> bytes;
  if (source.view >= 0) {
    bytes = document.view(source.view);
  } else {
    AssetContent content = document.files().read_uri(source.uri, place + "/uri");
    if (!content.problem.empty()) {
      image.problem = content.problem;
      return image;
    }
    if (!content.remark.empty()) image.remarks.push_back(content.remark);
    file = std::move(content.bytes);
    bytes = file.span();
    if (!is_data_uri(source.uri)) image.fingerprint = fingerprint(bytes);
  }
  if (is_ktx2(bytes)) {
    image.problem = "KTX2 (Basis Universal) images cannot be decoded; convert it to PNG, JPEG or WebP";
    return image;
  }
  try {
    PartialImage8 decoded = decode_partial_image8(bytes, document.files().scene_path() + place);
    image.pixels = std::make_shared<Image8>(std::move(decoded.image));
    if (!decoded.damage.empty()) image.remarks.push_back(decoded.damage);
  } catch (const Error& e) {
    if (e.kind() == ErrorKind::memory) throw;
    image.problem = e.what();
  }
  return image;
}

DecodedTextures read_textures(const Document& document, const std::vector<int>& wanted,
                              const std::vector<RoughnessFromGlossiness>& derived,
                              std::vector<Notice>& notices) {
  const auto& textures = document.model().textures;
  const int from_file = int(textures.size());
  const auto source_of = [&](int index) {
    return index < from_file ? index : derived[size_t(index - from_file)].texture;
  };
  std::vector<int> sources;
  for (const int index : wanted) sources.push_back(source_of(index));
  const std::map<int, DecodedImage> images = decode_images(document, sources);

  DecodedTextures result;
  std::set<int> unreadable;
  for (const int index : wanted) {
    const int source = source_of(index);
    const DecodedImage chosen = first_decoded(images, candidate_images(textures[size_t(source)]));
    std::shared_ptr<const Image8> pixels = chosen.pixels;
    result.unreadable.push_back(!pixels);
    if (!pixels && unreadable.insert(source).second)
      notices.push_back({Notice::Severity::warning, fmt::format("/textures/{}", source),
                         fmt::format("texture '{}' cannot be read: {}. Where it colours a surface that is "
                                     "magenta, elsewhere it is left out",
                                     textures[size_t(source)].name, chosen.problem)});
    if (!pixels)
      pixels = magenta_texel();
    else if (index >= from_file)
      pixels = roughness_of(*pixels, derived[size_t(index - from_file)].factor);
    result.textures.push_back(make_texture(document, textures[size_t(source)], std::move(pixels)));
  }
  for (const auto& [index, image] : images) {
    if (!image.fingerprint.empty()) result.fingerprints.push_back(image.fingerprint);
    for (const auto& remark : image.remarks)
      notices.push_back({Notice::Severity::warning, fmt::format("/images/{}", index), remark});
  }
  return result;
}

}  // namespace vernier
