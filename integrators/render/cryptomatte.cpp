// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/cryptomatte.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <nlohmann/json.hpp>
#include <unordered_set>

namespace vernier {
namespace {

/// MurmurHash3_x86_32 (Appleby 2011, public domain), seed 0.
uint32_t murmur3(std::string_view text) {
  uint32_t hash = 0;
  const auto mixed = [](uint32_t block) { return std::rotl(block * 0xcc9e2d51u, 15) * 0x1b873593u; };
  size_t i = 0;
  for (; i + 4 <= text.size(); i += 4) {
    uint32_t block;
    std::memcpy(&block, text.data() + i, 4);
    hash = std::rotl(hash ^ mixed(block), 13) * 5 + 0xe6546b64u;
  }
  uint32_t tail = 0;
  for (size_t k = text.size(); k-- > i;) tail = tail << 8 | uint8_t(text[k]);
  hash ^= mixed(tail) ^ uint32_t(text.size());
  hash = (hash ^ hash >> 16) * 0x85ebca6bu;
  hash = (hash ^ hash >> 13) * 0xc2b2ae35u;
  return hash ^ hash >> 16;
}

/// A name's part of a pixel.
struct Rank {
  uint32_t name = 0, samples = 0;
};

}  // namespace

uint32_t cryptomatte_hash(std::string_view name) {
  const uint32_t hash = murmur3(name);
  const uint32_t exponent = hash >> 23 & 255;
  return exponent == 0 || exponent == 255 ? hash ^ 1u << 23 : hash;
}

CryptomatteIds::CryptomatteIds(const SceneNames& names) : names_(&names) {
  for (const std::string& text : names.texts()) ids_.push_back(std::bit_cast<float>(cryptomatte_hash(text)));
}

void CryptomatteIds::write(const MetInstances& met, uint32_t SceneNames::Instance::*kind,
                           float* channels) const {
  std::array<Rank, MetInstances::most_samples> ranks;
  auto end = ranks.begin();
  for (uint32_t i = 0; i < met.count; ++i) {
    const uint32_t name = names_->of(met.instances[i]).*kind;
    const auto found = std::find_if(ranks.begin(), end, [&](const Rank& rank) { return rank.name == name; });
    if (found == end) *end++ = {name, 0};
    ++found->samples;
  }
  std::sort(ranks.begin(), end, [](const Rank& a, const Rank& b) {
    return a.samples != b.samples ? a.samples > b.samples : a.name < b.name;
  });
  std::fill_n(channels, 2 * cryptomatte_ranks, 0.f);
  for (auto rank = ranks.begin(); rank != std::min(end, ranks.begin() + cryptomatte_ranks); ++rank) {
    *channels++ = ids_[rank->name];
    *channels++ = float(rank->samples) / float(met.samples);
  }
}

Metadata CryptomatteIds::metadata(std::string_view layer, const Image& picture, int first_channel) const {
  std::unordered_set<uint32_t> shown;
  for (int y = 0; y < picture.height; ++y)
    for (int x = 0; x < picture.width; ++x)
      for (int rank = 0; rank < cryptomatte_ranks; ++rank) {
        const float* pair = picture.pixel(x, y) + first_channel + 2 * rank;
        if (!(pair[1] > 0)) break;
        shown.insert(std::bit_cast<uint32_t>(pair[0]));
      }
  nlohmann::ordered_json manifest = nlohmann::ordered_json::object();
  for (size_t i = 0; i < ids_.size(); ++i)
    if (const auto id = std::bit_cast<uint32_t>(ids_[i]); shown.contains(id))
      manifest[names_->texts()[i]] = fmt::format("{:08x}", id);
  // Layers are told apart by the beginning of their own name's hash.
  const std::string key = fmt::format("cryptomatte/{:.7}/", fmt::format("{:08x}", cryptomatte_hash(layer)));
  return {
      {key + "name", std::string(layer)},
      {key + "hash", "MurmurHash3_32"},
      {key + "conversion", "uint32_to_float32"},
      {key + "manifest", manifest.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace)}};
}

}  // namespace vernier
