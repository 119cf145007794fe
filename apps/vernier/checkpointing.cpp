// SPDX-License-Identifier: Apache-2.0
#include "apps/vernier/checkpointing.h"

#include <fmt/format.h>

#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "apps/vernier/build_id.h"
#include "apps/vernier/flags.h"
#include "apps/vernier/machine.h"
#include "core/base/atomic_file.h"
#include "core/base/fingerprint.h"

namespace vernier::apps {
namespace {

/// A name for people, and what tells apart cameras of one name.
std::string camera_text(const CameraDescription& camera) {
  std::vector<float> numbers{float(camera.kind == CameraDescription::Kind::perspective), camera.yfov,
                             camera.aspect, camera.xmag, camera.ymag};
  const Transform& place = camera.to_world;
  for (const Vec3f& column : {place.x, place.y, place.z, place.origin})
    numbers.insert(numbers.end(), {column.x, column.y, column.z});
  return fmt::format("{} ({:.8})", camera.name, fingerprint(std::as_bytes(std::span(numbers))));
}

/// What the samples depend on. The program's version is among it, for the same numbers may mean other light
/// in another one.
RenderIdentity identity_of(const RenderRequest& request, const RenderReport& report,
                           const CameraDescription& camera) {
  const RenderFlags& flags = request.flags;
  const IntegratorOptions& integrator = flags.integrator_options;
  const RenderSettings& options = report.options;
  RenderIdentity identity{{"version", VERNIER_VERSION},
                          {"scene", report.scene_hash},
                          {"camera", camera_text(camera)},
                          {"size", fmt::format("{}x{}", options.width, options.height)},
                          {"integrator", flags.integrator},
                          {"max-depth", fmt::format("{}", integrator.max_depth)},
                          {"ambient", fmt::format("{}", integrator.ambient)},
                          {"cutoff", fmt::format("{}", integrator.cutoff)},
                          {"accelerator", report.accelerator},
                          {"adaptive", options.adaptive ? "on" : "off"},
                          {"seed", fmt::format("{}", options.seed)}};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) identity.emplace_back(name, value);
  };
  if (options.crop.width > 0) add("crop", crop_text(options.crop));
  add("show", flags.show);
  add("variant", flags.import.variant);
  add("animation", flags.import.animation);
  if (flags.import.time) add("at", fmt::format("{}", *flags.import.time));
  const Surroundings& surroundings = report.surroundings;
  if (surroundings.environment) {
    const auto& pixels = surroundings.environment->picture->values;
    add("env", fingerprint(std::as_bytes(std::span(pixels))));
    add("env-rotate", fmt::format("{}", flags.surroundings.rotate));
    add("env-scale", fmt::format("{}", flags.surroundings.scale));
  } else {
    add("env", surroundings.name);
  }
  return identity;
}

}  // namespace

void add_checkpoint_flags(CLI::App& command, RenderFlags& flags) {
  command.option_defaults()->group("Long renders");
  command
      .add_option("--checkpoint", flags.checkpoint,
                  "keep the state of the render in this file: now and then, and at its end (docs/resume.md)")
      ->type_name("FILE");
  command.add_option("--checkpoint-every", flags.checkpoint_every, "how often: 60s, 10m, 1h")
      ->check(parsed_by(parse_seconds))
      ->type_name("TIME")
      ->capture_default_str();
  command
      .add_option("--resume", flags.resume,
                  "go on from this checkpoint, to the limits given now; they count from the beginning")
      ->type_name("FILE");
}

Checkpointing::Checkpointing(const RenderFlags& flags, NoticeLog& log) : flags_(flags), log_(log) {
  if (!flags.checkpoint.empty()) check_writable(flags.checkpoint);
  if (flags.resume.empty()) return;
  // So that a job that may be killed and started again is one command.
  std::error_code error;
  if (flags.resume == flags.checkpoint && !std::filesystem::exists(flags.resume, error)) {
    log.add({Notice::Severity::info,
             {},
             fmt::format("{} is not there yet; rendering from the beginning", flags.resume)});
    return;
  }
  from_ = read_checkpoint(flags.resume);
  const RenderResult& so_far = from_.state->so_far;
  resumed_ = {so_far.samples, so_far.seconds,
              double(so_far.samples) / (double(so_far.film.width()) * so_far.film.height())};
}

RenderHooks Checkpointing::hooks(const RenderRequest& request, const RenderReport& report,
                                 const CameraDescription& camera) {
  RenderHooks hooks;
  if (flags_.checkpoint.empty() && !from_.state) return hooks;
  identity_ = identity_of(request, report, camera);
  const std::string build = build_id(), here = platform();
  if (from_.state) {
    if (take(from_.identity, "build") != build)
      log_.add({Notice::Severity::warning,
                {},
                fmt::format("{} was written by another build of Vernier; if that one took other samples, the "
                            "picture will not be the same as if it had never stopped",
                            flags_.resume)});
    if (const std::string other = take(from_.identity, "platform"); other != here)
      log_.add(
          {Notice::Severity::warning,
           {},
           fmt::format("{} was written on another platform ({}; this is {}), whose last bits may differ; "
                       "the picture may not be the same as if it had never stopped",
                       flags_.resume, other, here)});
    require_same_render(flags_.resume, from_.identity, identity_);
    const RenderSettings& options = report.options;
    const bool cropped = options.crop.width > 0;
    if (!from_.state->fits(cropped ? options.crop.width : options.width,
                           cropped ? options.crop.height : options.height, options.adaptive))
      throw Error(
          ErrorKind::input, flags_.resume, {},
          "is damaged: what it holds is not of the size that it says; use another checkpoint or render "
          "without --resume");
    hooks.from = std::move(from_.state);
    log_.add({Notice::Severity::info,
              {},
              fmt::format("going on from {}: {:.4g} samples a pixel and {} are done", flags_.resume,
                          resumed_->samples_per_pixel, format_seconds(resumed_->seconds))});
  }
  identity_.emplace_back("build", build);
  identity_.emplace_back("platform", here);
  if (!flags_.checkpoint.empty()) {
    hooks.save = [this](const RenderState& state) { write(state); };
    hooks.save_interval = parse_seconds(flags_.checkpoint_every);
  }
  return hooks;
}

void Checkpointing::write(const RenderState& state) {
  const auto start = std::chrono::steady_clock::now();
  failure_.clear();
  try {
    write_checkpoint(flags_.checkpoint, identity_, state);
    ++written_;
  } catch (const Error& error) {
    failure_ = error.what();
    log_.add({Notice::Severity::warning, {}, failure_ + "; the render is not affected"});
  }
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void Checkpointing::add_to(nlohmann::ordered_json& stats) const {
  if (resumed_)
    stats["resumed"] = {{"file", flags_.resume},
                        {"samples", resumed_->samples},
                        {"samples_per_pixel", resumed_->samples_per_pixel},
                        {"seconds", resumed_->seconds}};
  if (flags_.checkpoint.empty()) return;
  std::error_code error;
  const auto bytes = std::filesystem::file_size(flags_.checkpoint, error);
  stats["checkpoint"] = {{"file", flags_.checkpoint},
                         {"bytes", error ? 0 : bytes},
                         {"written", written_},
                         {"seconds", seconds_}};
}

void Checkpointing::require_written() const {
  if (!failure_.empty()) throw Error(ErrorKind::output, failure_);
}

}  // namespace vernier::apps
