// SPDX-License-Identifier: Apache-2.0
#include "integrators/render/checkpoint.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "core/base/atomic_file.h"
#include "core/base/fingerprint.h"
#include "integrators/render/checkpoint_file.h"
#include "integrators/render/light_pass.h"
#include "vernier/error.h"

namespace vernier {
namespace {

using Json = nlohmann::ordered_json;

static_assert(std::endian::native == std::endian::little, "checkpoints are little-endian");
static_assert(sizeof(ConvergencePoint) == 6 * sizeof(double));
static_assert(sizeof(TileLight) == 13 * sizeof(float));

/// Constant bytes of constant values.
template <typename Values>
auto bytes_of(Values& values) {
  const std::span span(values);
  if constexpr (std::is_const_v<typename decltype(span)::element_type>)
    return std::as_bytes(span);
  else
    return std::as_writable_bytes(span);
}

/// Calls visit(name, bytes) for each array of a state, in the file's order.
template <typename State, typename Plan, typename Visit>
void for_each_array(State& state, Plan& plan_counts, const Visit& visit) {
  visit("film", state.partial.film.bytes());
  visit("alpha", state.partial.film.alpha_bytes());
  visit("guide 1", state.guides[0].bytes());
  visit("guide 2", state.guides[1].bytes());
  visit("extra", bytes_of(state.drawn.extra));
  visit("light", bytes_of(state.light));
  visit("plan", bytes_of(plan_counts));
  visit("parts", bytes_of(state.tile_progress));
  visit("looks", bytes_of(state.partial.convergence));
  visit("bad samples", bytes_of(state.partial.bad_sample_examples));
  visit("splats", state.partial.film.splat_bytes());
  if (!state.gradients.empty()) visit("gradients", state.gradients.bytes());
  for (auto& part : state.partial.light) visit(part.layer.c_str(), part.film.bytes());
  if (state.partial.film.has_splats())
    for (auto& part : state.partial.light) visit((part.layer + " splats").c_str(), part.film.splat_bytes());
}

Json header_of(const RenderIdentity& identity, const RenderState& state) {
  const RenderResult& partial = state.partial;
  const SamplePlan::Numbers& pass = state.pass.numbers();
  Json header{{"render", Json::array()},
              {"width", partial.film.width()},
              {"height", partial.film.height()},
              {"adaptive", !state.guides[0].bytes().empty()},
              {"has_alpha", partial.film.has_alpha()},
              {"light_layers", Json::array()},
              {"has_splats", partial.film.has_splats()},
              {"has_gradients", !state.gradients.empty()},
              {"light_batches", state.light_batches},
              {"bad_light_paths", partial.bad_light_paths},
              {"done", state.completed_spp},
              {"guiding", state.drawn.guiding},
              {"looked_at", state.last_checked_spp},
              {"pass", {{"size", pass.size}, {"odd_half", pass.odd_half}, {"guiding", pass.guiding}}},
              {"seconds", partial.seconds},
              {"samples", partial.samples},
              {"rays", {partial.rays.camera, partial.rays.bounce, partial.rays.shadow}},
              {"bad_samples", partial.bad_samples},
              {"arrays", Json::array()}};
  for (const LightFilm& part : partial.light) header["light_layers"].push_back(part.layer);
  if (!partial.convergence.empty()) {
    const ConvergencePoint& look = partial.convergence.back();
    header["look"] = {{"samples_per_pixel", look.samples_per_pixel}, {"rel_rmse", look.error.rel_rmse}};
  }
  for (const auto& [name, value] : identity) header["render"].push_back(Json::array({name, value}));
  return header;
}

// Fingerprints tell damage, not malice: everything read below is checked before it is used or memory is taken
// for it.

/// A number of the header, at most `most`.
uint64_t whole_number(const CheckpointReader& reader, const Json& value, const char* name,
                      uint64_t most = std::numeric_limits<int64_t>::max()) {
  if (!value.is_number_unsigned() || value.get<uint64_t>() > most)
    reader.damaged(fmt::format("'{}' is not a whole number from 0 to {}", name, most));
  return value.get<uint64_t>();
}

/// The state with its numbers, and its arrays still to be read into; `counts` are the plan's. Arrays have the
/// sizes that follow from the numbers, the file says the same, and it is as long as all of them.
std::shared_ptr<RenderState> allocate_state(const CheckpointReader& reader, const Json& header,
                                            SamplePlan::Numbers& pass) {
  constexpr uint64_t longest_side = 1 << 16;
  const size_t width = whole_number(reader, header.at("width"), "width", longest_side);
  const size_t height = whole_number(reader, header.at("height"), "height", longest_side);
  if (width == 0 || height == 0) reader.damaged("its picture has no pixels");
  const bool adaptive = header.at("adaptive").get<bool>();
  const bool has_alpha = header.at("has_alpha").get<bool>();
  const bool has_splats = header.at("has_splats").get<bool>();
  const bool has_gradients = header.value("has_gradients", false);
  const auto light_layers = header.at("light_layers").get<std::vector<std::string>>();
  const Json& pass_header = header.at("pass");
  const uint32_t done = uint32_t(whole_number(reader, header.at("done"), "done", RenderState::most_samples));
  pass.width = int(width);
  // No pass more than doubles what is done.
  pass.size = uint32_t(whole_number(reader, pass_header.at("size"), "size", std::max(2u, done)));
  pass.odd_half = int(whole_number(reader, pass_header.at("odd_half"), "odd_half", Film::halves - 1));
  pass.guiding = uint32_t(whole_number(reader, pass_header.at("guiding"), "guiding", pass.size));

  const Json& arrays = header.at("arrays");
  const auto bytes = [&](size_t array) {
    return whole_number(reader, arrays.at(array).at("bytes"), "bytes");
  };
  const size_t pixels = width * height;
  const size_t tiles = RenderState::tile_count(int(width), int(height));
  const bool uneven = pass.size > 0 && bytes(6) > 0;
  std::vector<size_t> expected{pixels * Film::bytes_per_pixel(),
                               has_alpha ? pixels * Film::alpha_bytes_per_pixel() : 0,
                               adaptive ? pixels * SampleStatistics::bytes_per_pixel() : 0,
                               adaptive ? pixels * SampleStatistics::bytes_per_pixel() : 0,
                               adaptive ? pixels * Film::halves * sizeof(uint32_t) : 0,
                               tiles * sizeof(TileLight),
                               uneven ? pixels * Film::halves * sizeof(uint16_t) : 0,
                               pass.size > 0 ? tiles * sizeof(uint32_t) : 0,
                               bytes(8) / sizeof(ConvergencePoint) * sizeof(ConvergencePoint),
                               bytes(9) / sizeof(BadSample) * sizeof(BadSample),
                               has_splats ? pixels * Film::splat_bytes_per_pixel() : 0};
  if (has_gradients) expected.push_back(pixels * GradientFilm::bytes_per_pixel());
  expected.resize(expected.size() + light_layers.size(), pixels * Film::bytes_per_pixel());
  if (has_splats)
    expected.resize(expected.size() + light_layers.size(), pixels * Film::splat_bytes_per_pixel());
  uintmax_t total = 0;
  for (size_t i = 0; i < expected.size(); ++i) {
    if (bytes(i) != expected[i])
      reader.damaged(fmt::format("array {} has {} bytes, expected {}", i, bytes(i), expected[i]));
    if (expected[i] > reader.left() - total) reader.damaged("it is cut short");
    total += expected[i];
  }
  if (arrays.size() != expected.size() || total != reader.left())
    reader.damaged(fmt::format("{} bytes follow its header, expected {}", reader.left(), total));

  auto state = std::make_shared<RenderState>(int(width), int(height), adaptive, has_alpha, light_layers,
                                             has_splats, has_gradients);
  state->completed_spp = done;
  for (size_t half = 0; half < Film::halves; ++half)
    state->drawn.guiding[half] =
        uint32_t(whole_number(reader, header.at("guiding").at(half), "guiding", RenderState::most_samples));
  state->last_checked_spp = uint32_t(whole_number(reader, header.at("looked_at"), "looked_at", done));
  if (uneven) pass.counts.resize(pixels * Film::halves);
  if (pass.size > 0) state->tile_progress.resize(tiles);
  state->partial.convergence.resize(bytes(8) / sizeof(ConvergencePoint));
  state->partial.bad_sample_examples.resize(bytes(9) / sizeof(BadSample));
  return state;
}

/// Of the header, and which films have how many.
void read_light_paths(const CheckpointReader& reader, const Json& header, RenderState& state) {
  const bool has_splats = state.partial.film.has_splats();
  state.light_batches = whole_number(reader, header.at("light_batches"), "light_batches",
                                     has_splats ? LightPass::most_batches : 0);
  const uint64_t paths = state.light_batches * LightPass::batch_size;
  state.partial.bad_light_paths =
      whole_number(reader, header.at("bad_light_paths"), "bad_light_paths", paths);
  LightPass::count_paths(state.partial, 0, state.light_batches);
}

/// Totals of the header.
void read_totals(const CheckpointReader& reader, const Json& header, RenderResult& partial) {
  partial.samples = whole_number(reader, header.at("samples"), "samples");
  partial.bad_samples = whole_number(reader, header.at("bad_samples"), "bad_samples", partial.samples);
  const Json& rays = header.at("rays");
  const auto count = [&](size_t i) { return whole_number(reader, rays.at(i), "rays"); };
  partial.rays = {count(0), count(1), count(2)};
  const Json& seconds = header.at("seconds");
  constexpr double longest = 1e10;  // three centuries
  if (!seconds.is_number() || !(seconds.get<double>() >= 0 && seconds.get<double>() <= longest))
    reader.damaged("'seconds' is not a duration");
  partial.seconds = seconds;
}

void read_state(CheckpointReader& reader, const Json& header, Checkpoint& checkpoint) {
  for (const Json& pair : header.at("render"))
    checkpoint.identity.emplace_back(pair.at(0).get<std::string>(), pair.at(1).get<std::string>());
  SamplePlan::Numbers pass;
  checkpoint.state = allocate_state(reader, header, pass);
  RenderState& state = *checkpoint.state;
  read_totals(reader, header, state.partial);
  read_light_paths(reader, header, state);
  const Json& arrays = header.at("arrays");
  size_t i = 0;
  for_each_array(state, pass.counts, [&](const char* name, std::span<std::byte> array) {
    const Json& described = arrays.at(i++);
    if (described.at("name") != name) reader.damaged(fmt::format("it has no '{}' in its place", name));
    reader.read(array);
    if (described.at("fingerprint") != fingerprint(array))
      reader.damaged(fmt::format("its '{}' has changed", name));
  });
  state.pass = SamplePlan(std::move(pass));
  if (const char* part = implausible_part(state))
    reader.damaged(fmt::format("its '{}' holds values that no render has", part));
}

}  // namespace

void write_checkpoint(const std::string& path, const RenderIdentity& identity, const RenderState& state) {
  Json header = header_of(identity, state);
  std::vector<std::span<const std::byte>> parts(2);
  for_each_array(state, state.pass.numbers().counts, [&](const char* name, std::span<const std::byte> array) {
    header["arrays"].push_back(
        {{"name", name}, {"bytes", array.size()}, {"fingerprint", fingerprint(array)}});
    parts.push_back(array);
  });
  const std::string text = header.dump(-1, ' ', false, Json::error_handler_t::replace);
  CheckpointPreamble preamble;
  preamble.header_length = uint32_t(text.size());
  fingerprint(std::as_bytes(std::span(text)))
      .copy(preamble.header_fingerprint.data(), preamble.header_fingerprint.size());
  parts[0] = std::as_bytes(std::span(&preamble, 1));
  parts[1] = std::as_bytes(std::span(text));
  write_file(path, parts);
}

Checkpoint read_checkpoint(const std::string& path) {
  CheckpointReader reader(path);
  Checkpoint checkpoint;
  try {
    read_state(reader, read_checkpoint_header(reader), checkpoint);
  } catch (const Json::exception& error) {
    reader.damaged(error.what());
  }
  return checkpoint;
}

void require_checkpoint(const std::string& path) {
  CheckpointReader reader(path);
  try {
    read_checkpoint_header(reader);
  } catch (const Json::exception& error) {
    reader.damaged(error.what());
  }
}

CheckpointSummary read_checkpoint_summary(const std::string& path) {
  CheckpointReader reader(path);
  CheckpointSummary summary;
  try {
    const Json header = read_checkpoint_header(reader);
    const double pixels = header.at("width").get<double>() * header.at("height").get<double>();
    summary.samples_per_pixel = header.at("samples").get<double>() / pixels;
    const auto look = header.find("look");
    if (look == header.end() || !look->at("rel_rmse").is_number()) return summary;
    const double then = look->at("samples_per_pixel").get<double>();
    summary.rel_rmse = look->at("rel_rmse").get<double>() * std::sqrt(then / summary.samples_per_pixel);
  } catch (const Json::exception& error) {
    reader.damaged(error.what());
  }
  return summary;
}

std::string take(RenderIdentity& identity, const std::string& name) {
  const auto found =
      std::find_if(identity.begin(), identity.end(), [&](const auto& pair) { return pair.first == name; });
  if (found == identity.end()) return {};
  std::string value = std::move(found->second);
  identity.erase(found);
  return value;
}

void require_same_render(const std::string& path, const RenderIdentity& checkpoint,
                         const RenderIdentity& wanted) {
  const auto value = [](const RenderIdentity& identity, const std::string& name) {
    const auto found =
        std::find_if(identity.begin(), identity.end(), [&](const auto& pair) { return pair.first == name; });
    return found == identity.end() ? std::string("none") : found->second;
  };
  RenderIdentity all = wanted;
  for (const auto& pair : checkpoint)
    if (value(wanted, pair.first) == "none") all.push_back(pair);
  std::string differences;
  for (const auto& [name, any] : all)
    if (value(checkpoint, name) != value(wanted, name))
      differences += fmt::format("{}{:.100} was {:.100}, is {:.100}", differences.empty() ? "" : "; ", name,
                                 value(checkpoint, name), value(wanted, name));
  if (!differences.empty())
    throw Error(ErrorKind::input, path, {}, fmt::format("is of another render: {}", differences));
}

}  // namespace vernier
