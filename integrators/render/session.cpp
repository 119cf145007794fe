// SPDX-License-Identifier: Apache-2.0
#include "vernier/session.h"
#include "vernier/version.h"

#include <fmt/format.h>

#include <cmath>
#include <thread>

#include "core/base/build.h"
#include "core/base/names.h"
#include "core/image/image_io.h"
#include "integrators/light_paths.h"
#include "integrators/render/backdrop.h"
#include "integrators/render/checkpoint.h"
#include "integrators/render/gradients.h"
#include "integrators/render/layers.h"
#include "integrators/render/picture.h"
#include "integrators/render/pixel_filter.h"
#include "integrators/render/texture_filter.h"
#include "scene/camera.h"
#include "scene/moving_mesh.h"
#include "scene/scene.h"

namespace vernier {
namespace {

[[noreturn]] void refuse(const std::string& problem) { throw Error(ErrorKind::usage, problem); }

void check(const Scene* scene, const RenderSettings& settings) {
  if (!scene) refuse("a RenderSession needs a scene; build_scene() makes one");
  if (settings.width <= 0 || settings.height <= 0)
    refuse(fmt::format("a picture of {}x{} pixels cannot be rendered; set RenderSettings::width and height",
                       settings.width, settings.height));
  const Crop& crop = settings.crop;
  if (crop.width != 0 && (crop.width < 0 || crop.height <= 0 || crop.x < 0 || crop.y < 0 ||
                          crop.width > settings.width - crop.x || crop.height > settings.height - crop.y))
    refuse(fmt::format("the crop {} reaches beyond the picture of {}x{}", crop_text(crop), settings.width,
                       settings.height));
  const CameraDescription& camera = settings.camera;
  if (!camera.defect.empty()) refuse(camera.defect);
  if (!(length(camera.to_world.z) > 0 && length(cross(camera.to_world.y, camera.to_world.z)) > 0))
    refuse("the camera has no direction; its to_world is singular");
  check_moment_count(camera.moments.size(), "the camera");
  if (!(settings.row_exposure >= 0 && settings.row_exposure <= 1))
    refuse(fmt::format("rows that are exposed for {} of the shutter; expected a part, 0 to 1",
                       settings.row_exposure));
  if (!(camera.lens_radius >= 0 && std::isfinite(camera.lens_radius)))
    refuse(fmt::format("a lens of radius {} m; expected 0, for a pinhole, or more", camera.lens_radius));
  if (camera.lens_radius > 0 && camera.kind != CameraDescription::Kind::perspective)
    refuse("only a perspective camera has a lens; set CameraDescription::lens_radius to 0");
  if (!(camera.focus_distance > 0))
    refuse(fmt::format("a focus distance of {} m; expected more than 0", camera.focus_distance));
  check_filter(settings.filter);
  check_texture_filter(settings);
  const bool splits = !settings.light_split.ways.empty() || !settings.light_split.groups.empty();
  if (splits && !find_by_name(integrators(), "integrator", settings.integrator).splits_light)
    refuse(fmt::format("the integrator {} does not keep parts of the light apart; path does",
                       settings.integrator));
  check(settings.background);
}

void check(const RenderLimits& limits) {
  if (limits.spp < 0 || limits.spp > int(RenderState::most_samples))
    refuse(fmt::format("{} samples a pixel; expected 0, for no limit, to {}", limits.spp,
                       RenderState::most_samples));
  if (!(limits.seconds >= 0)) refuse(fmt::format("a time limit of {} seconds", limits.seconds));
  if (!(limits.error >= 0)) refuse(fmt::format("a target error of {}", limits.error));
}

}  // namespace

class RenderSession::State {
 public:
  State(std::shared_ptr<const Scene> its_scene, RenderSettings its_settings)
      : scene(std::move(its_scene)),
        settings((check(scene.get(), its_settings), check(its_settings.limits), std::move(its_settings))),
        integrator(make_integrator(settings.integrator,
                                   options_for(settings.background, settings.integrator_options))),
        camera(settings.camera, settings.width, settings.height),
        backdrop(settings),
        sorter(settings.light_split, *scene),
        light_paths(light_paths_of(*scene, camera, *integrator, settings, sorter)),
        render(rendered_part(settings).width, rendered_part(settings).height, settings.adaptive,
               backdrop.is_transparent(), sorter.layers(), light_paths.has_value(),
               integrator->wants_gradients()) {
    check_gradients(*integrator, *scene, settings);
  }

  RenderIdentity identity() const {
    RenderIdentity identity{{"version", version()}};
    for (auto& pair : scene->identity()) identity.push_back(std::move(pair));
    for (auto& pair : identity_of(settings)) identity.push_back(std::move(pair));
    if (auto print = backdrop.fingerprint(); !print.empty())
      identity.emplace_back("background picture", std::move(print));
    return identity;
  }

  const std::shared_ptr<const Scene> scene;
  std::optional<Moments> moments;
  RenderSettings settings;
  const std::unique_ptr<Integrator> integrator;
  const Camera camera;
  const Backdrop backdrop;
  const LightSorter sorter;
  const std::optional<LightPaths> light_paths;
  RenderState render;
  RenderCallbacks callbacks;
  std::atomic<std::thread::id> user{};  ///< the thread in a call; none: std::thread::id()
};

namespace {

/// Marks a session as in use by this thread, which may call it again from its own callbacks.
class Use {
 public:
  explicit Use(std::atomic<std::thread::id>& user) : user_(user) {
    std::thread::id nobody{};
    const auto self = std::this_thread::get_id();
    is_outermost_ = user.compare_exchange_strong(nobody, self);
    if (!is_outermost_ && nobody != self)
      refuse("this RenderSession is in use by another thread; a session takes one call at a time");
  }
  ~Use() {
    if (is_outermost_) user_ = std::thread::id();
  }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;
  bool is_outermost() const { return is_outermost_; }

 private:
  std::atomic<std::thread::id>& user_;
  bool is_outermost_;
};

}  // namespace

RenderSession::RenderSession(std::shared_ptr<const Scene> scene, RenderSettings settings)
    : state_(std::make_unique<State>(std::move(scene), std::move(settings))) {}
RenderSession::~RenderSession() = default;

const RenderSettings& RenderSession::settings() const { return state_->settings; }

void RenderSession::set_limits(const RenderLimits& limits) {
  const Use use(state_->user);
  check(limits);
  state_->settings.limits = limits;
}

void RenderSession::on_progress(std::function<void(const RenderProgress&)> observe) {
  const Use use(state_->user);
  state_->callbacks.on_progress = std::move(observe);
}

void RenderSession::on_checkpoint(std::function<void()> save, double seconds) {
  const Use use(state_->user);
  state_->callbacks.on_checkpoint = nullptr;
  if (save) state_->callbacks.on_checkpoint = [save = std::move(save)](const RenderState&) { save(); };
  state_->callbacks.checkpoint_interval = seconds;
}

void RenderSession::on_preview(std::function<void()> show, double seconds, std::atomic<bool>* now) {
  const Use use(state_->user);
  state_->callbacks.on_preview = nullptr;
  if (show) state_->callbacks.on_preview = [show = std::move(show)](const RenderState&) { show(); };
  state_->callbacks.preview_interval = seconds;
  state_->callbacks.now = now;
}

StopReason RenderSession::run(const std::atomic<bool>& stop) {
  const Use use(state_->user);
  if (!use.is_outermost()) refuse("run() cannot be called by a callback of its own");
  State& s = *state_;
  const LightPaths* light_paths = s.light_paths ? &*s.light_paths : nullptr;
  vernier::render({*s.scene, s.camera, *s.integrator, s.settings, s.backdrop, s.sorter, light_paths},
                  s.render, stop, s.callbacks);
  return s.render.partial.reason;
}

StopReason RenderSession::run() {
  const std::atomic<bool> never = false;
  return run(never);
}

void RenderSession::save(const std::string& path) const {
  const Use use(state_->user);
  if (state_->scene->identity().front().second.empty())
    refuse("a render of a scene that nothing identifies cannot be saved; set SceneDescription::hash");
  RenderIdentity identity = state_->identity();
  identity.emplace_back("build", build_id());
  identity.emplace_back("platform", platform());
  write_checkpoint(path, identity, state_->render);
}

std::vector<Notice> RenderSession::load(const std::string& path) {
  const Use use(state_->user);
  Checkpoint checkpoint = read_checkpoint(path);
  std::vector<Notice> notices;
  const auto warn = [&](std::string text) {
    notices.push_back({Notice::Severity::warning, {}, std::move(text)});
  };
  if (take(checkpoint.identity, "build") != build_id())
    warn(
        fmt::format("{} was written by another build of Vernier; if that one took other samples, the picture "
                    "will not be the same as if it had never stopped",
                    path));
  if (const std::string other = take(checkpoint.identity, "platform"); other != platform())
    warn(
        fmt::format("{} was written on another platform ({}; this is {}), whose last bits may differ; the "
                    "picture may not be the same as if it had never stopped",
                    path, other, platform()));
  require_same_render(path, checkpoint.identity, state_->identity());
  const Crop part = rendered_part(state_->settings);
  if (!checkpoint.state->fits(part.width, part.height, state_->settings.adaptive,
                              state_->backdrop.is_transparent(), state_->sorter.layers(),
                              state_->light_paths.has_value(), state_->integrator->wants_gradients()))
    throw Error(ErrorKind::input, path, {},
                "is damaged: what it holds is not of the size that it says; use another checkpoint or render "
                "from the beginning");
  state_->render = std::move(*checkpoint.state);
  RenderResult& partial = state_->render.partial;
  partial.error = estimate_error(state_->render);
  partial.missing = estimate_missing(state_->render.light, partial.film);
  return notices;
}

void RenderSession::set_moments(Moments moments) {
  const Use use(state_->user);
  state_->moments = std::move(moments);
}

RenderStatus RenderSession::status() const {
  const Use use(state_->user);
  return status_of(state_->render.partial);
}

LayeredImage RenderSession::picture(const std::string& layers) const {
  const Use use(state_->user);
  reconstruct(state_->render);
  const RenderResult& partial = state_->render.partial;
  const RenderSettings& settings = state_->settings;
  LayeredImage picture = with_layers(partial, find_layers(layers), *state_->scene, state_->camera, settings,
                                     state_->moments ? &*state_->moments : nullptr);
  if (settings.crop.width > 0)
    picture.place = {settings.crop.x, settings.crop.y, settings.width, settings.height};
  picture.metadata.merge(result_metadata(partial));
  return picture;
}

void RenderSession::write(const std::string& path, const std::string& layers) const {
  const Use use(state_->user);
  check_writable_image(path);
  write_picture(path, picture(layers));
}

const RenderResult& RenderSession::result() const { return state_->render.partial; }

}  // namespace vernier
