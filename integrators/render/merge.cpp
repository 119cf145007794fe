// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "core/base/quantities.h"
#include "integrators/render/checkpoint.h"
#include "integrators/render/picture.h"
#include "vernier/error.h"
#include "vernier/picture.h"

namespace vernier {
namespace {

/// Of a crop in its picture, as a render's identity tells it.
PicturePlace place_of(const RenderIdentity& identity) {
  const std::map<std::string, std::string> render(identity.begin(), identity.end());
  const auto crop = render.find("crop"), size = render.find("size");
  if (crop == render.end() || size == render.end()) return {};
  const PixelRect rect = parse_pixel_rect(crop->second);
  const PixelSize full = parse_pixel_size(size->second);
  return {rect.x, rect.y, full.width, full.height};
}

}  // namespace

void Merged::add(const std::string& path) {
  Checkpoint checkpoint = read_checkpoint(path);
  const std::string seed = take(checkpoint.identity, "seed");
  if (seed.empty()) throw Error(ErrorKind::input, path, {}, "does not say its seed");
  take(checkpoint.identity, "build");  // machines may have their own
  take(checkpoint.identity, "platform");
  uint64_t number = 0;
  std::from_chars(seed.data(), seed.data() + seed.size(), number);
  const auto [same, is_new] = files_by_seed_.emplace(number, path);
  if (!is_new)
    throw Error(ErrorKind::input, path, {},
                fmt::format("has the seed {} of {}, so both hold the same samples; render parts with "
                            "different --seed",
                            seed, same->second));
  RenderResult& more = checkpoint.state->partial;
  if (!result_) {
    identity_ = std::move(checkpoint.identity);
    result_ = std::move(more);
    light_ = std::move(checkpoint.state->light);
    gradients_ = std::move(checkpoint.state->gradients);
    return;
  }
  require_same_render(path, checkpoint.identity, identity_);
  if (more.film.width() != result_->film.width() || more.film.height() != result_->film.height() ||
      more.film.has_alpha() != result_->film.has_alpha() ||
      more.film.has_splats() != result_->film.has_splats() || more.light.size() != result_->light.size() ||
      checkpoint.state->gradients.empty() != gradients_.empty())
    throw Error(ErrorKind::input, path, {}, "is damaged: its picture is not of the size that it says");
  result_->film.merge(more.film);
  gradients_.merge(checkpoint.state->gradients);
  for (size_t i = 0; i < more.light.size(); ++i) result_->light[i].film.merge(more.light[i].film);
  for (size_t tile = 0; tile < light_.size(); ++tile) light_[tile] += checkpoint.state->light[tile];
  result_->rays += more.rays;
  result_->samples += more.samples;
  result_->seconds += more.seconds;
  result_->bad_samples += more.bad_samples;
  result_->bad_light_paths += more.bad_light_paths;
}

RenderResult& Merged::result() {
  if (!gradients_.empty()) gradients_.reconstruct(result_->film);
  result_->error = estimate_error(result_->film);
  result_->missing = estimate_missing(light_, result_->film);
  return *result_;
}

LayeredImage Merged::picture(std::span<const Layer> layers) const {
  LayeredImage picture = with_film_layers(*result_, layers);
  picture.place = place_of(identity_);
  picture.metadata.merge(metadata());
  return picture;
}

Metadata Merged::metadata() const {
  Metadata metadata = result_metadata(*result_);
  const std::map<std::string, std::string> render(identity_.begin(), identity_.end());
  const std::pair<const char*, const char*> names[] = {{"vernier:sceneHash", "scene"},
                                                       {"vernier:integrator", "integrator"},
                                                       {"vernier:accelerator", "accelerator"},
                                                       {"vernier:size", "size"},
                                                       {"vernier:crop", "crop"}};
  for (const auto& [attribute, name] : names)
    if (const auto found = render.find(name); found != render.end()) metadata[attribute] = found->second;
  std::vector<uint64_t> seeds;
  for (const auto& [seed, file] : files_by_seed_) seeds.push_back(seed);
  metadata["vernier:seed"] = fmt::format("{}", fmt::join(seeds, " "));
  return metadata;
}

MergedRender merge(const std::vector<std::string>& checkpoints, const std::string& layers) {
  const std::vector<Layer> chosen = find_film_layers(layers);
  if (checkpoints.size() < 2)
    throw Error(ErrorKind::usage,
                fmt::format("{} checkpoints to merge; expected two or more", checkpoints.size()));
  Merged merged;
  for (const auto& path : checkpoints) merged.add(path);
  const RenderStatus status = status_of(merged.result());
  return {merged.picture(chosen), status};
}

}  // namespace vernier
