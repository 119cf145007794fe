// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/merged_render.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <charconv>

#include "integrators/render/picture.h"
#include "vernier/error.h"

namespace vernier::apps {

void MergedRender::claim_seed(const std::string& path, RenderIdentity& identity) {
  const std::string seed = take(identity, "seed");
  if (seed.empty()) throw Error(ErrorKind::input, path, {}, "does not say its seed");
  uint64_t number = 0;
  std::from_chars(seed.data(), seed.data() + seed.size(), number);
  const auto [same, is_new] = files_by_seed_.emplace(number, path);
  if (!is_new)
    throw Error(ErrorKind::input, path, {},
                fmt::format("has the seed {} of {}, so both hold the same samples; render parts with "
                            "different --seed",
                            seed, same->second));
}

void MergedRender::add(const std::string& path) {
  Checkpoint checkpoint = read_checkpoint(path);
  claim_seed(path, checkpoint.identity);
  take(checkpoint.identity, "build");  // machines may have their own
  take(checkpoint.identity, "platform");
  RenderResult& more = checkpoint.state->so_far;
  std::vector<TileLight>& more_light = checkpoint.state->light;
  if (!result_) {
    identity_ = std::move(checkpoint.identity);
    result_ = std::move(more);
    light_ = std::move(more_light);
    return;
  }
  require_same_render(path, checkpoint.identity, identity_);
  if (more.film.width() != result_->film.width() || more.film.height() != result_->film.height() ||
      more.film.has_alpha() != result_->film.has_alpha())
    throw Error(ErrorKind::input, path, {}, "is damaged: its picture is not of the size that it says");
  result_->film.merge(more.film);
  for (size_t tile = 0; tile < light_.size(); ++tile) light_[tile] += more_light[tile];
  result_->rays += more.rays;
  result_->samples += more.samples;
  result_->seconds += more.seconds;
  result_->bad_samples += more.bad_samples;
}

const RenderResult& MergedRender::finish() {
  result_->error = estimate_error(result_->film);
  result_->missing = estimate_missing(light_);
  return *result_;
}

Metadata MergedRender::metadata(const std::string& command_line) const {
  Metadata metadata = result_metadata(*result_);
  metadata["vernier:command"] = command_line;
  const std::map<std::string, std::string> render(identity_.begin(), identity_.end());
  const std::pair<const char*, const char*> names[] = {{"vernier:sceneHash", "scene"},
                                                       {"vernier:integrator", "integrator"},
                                                       {"vernier:accelerator", "accelerator"},
                                                       {"vernier:size", "size"},
                                                       {"vernier:crop", "crop"}};
  for (const auto& [attribute, name] : names)
    if (const auto found = render.find(name); found != render.end()) metadata[attribute] = found->second;
  std::vector<uint64_t> seeds;
  seeds.reserve(files_by_seed_.size());
  for (const auto& [seed, file] : files_by_seed_) seeds.push_back(seed);
  metadata["vernier:seed"] = fmt::format("{}", fmt::join(seeds, " "));
  return metadata;
}

}  // namespace vernier::apps
