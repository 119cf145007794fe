// SPDX-License-Identifier: Apache-2.0
#include "apps/serve/live_scene.h"

#include <fmt/format.h>

#include <mutex>

#include "apps/vernier/choose_camera.h"
#include "apps/vernier/fog_flag.h"
#include "apps/vernier/memory_limit.h"
#include "apps/vernier/result_warnings.h"
#include "scene/camera.h"
#include "scene/segment.h"
#include "scene/subject.h"
#include "vernier/ground.h"

namespace vernier::apps {
namespace {

/// What a scene is described and built by.
std::string building_key(const RenderFlags& flags) {
  return fmt::format("{}\n{}\n{}\n{}\n{}", flags.import.variant,
                     flags.import.time ? fmt::format("{}", *flags.import.time) : "", flags.import.animation,
                     flags.camera.ground ? int(*flags.camera.ground) + 1 : 0, flags.accelerator);
}

std::string name_or_number(const std::string& name, size_t number) {
  return name.empty() ? std::to_string(number) : name;
}

}  // namespace

LiveScene::LiveScene(const std::string& path, const ImportOptions& options,
                     std::shared_ptr<const Image> background)
    : file_(path, options.allow_outside_files), background_(std::move(background)) {}

void LiveScene::build(const RenderRequest& request, NoticeLog& log) {
  const std::string key = building_key(request.flags);
  if (!built_.scene || key != built_for_) {
    SceneDescription description = file_.describe(request.flags.import);
    if (const auto ground = request.flags.camera.ground) add_ground(description, *ground);
    Built built;
    built.cameras = description.cameras;
    built.environment = description.environment;
    built.notices = description.notices;
    for (const InstanceDescription& instance : description.instances) {
      const std::string& material = description.materials[instance.material].name;
      built.objects.push_back(name_or_number(instance.name, built.objects.size()));
      built.materials.push_back(name_or_number(material, instance.material));
    }
    const std::string source = description.source;
    check_scene_size(description, request.flags.import.memory);
    built.scene = build_scene(std::move(description), {request.flags.accelerator});
    if (request.flags.import.strict) refuse_warnings(source, built.scene->notices());
    const std::unique_lock lock(mutex_);
    built_ = std::move(built);
    built_for_ = key;
    surrounded_for_.clear();
    fog_.clear();
    has_own_surroundings_ = true;
    ++version_;
  }
  if (request.flags.fog != fog_) {
    const Fog fog = parse_fog(request.flags.fog);
    const std::unique_lock lock(mutex_);
    fill_air(*built_.scene, fog);
    fog_ = request.flags.fog;
    ++version_;
  }
  log.add(built_.notices);
  log.add(built_.scene->notices());
}

std::optional<Surroundings> LiveScene::read(const SurroundingsFlags& flags) {
  if (flags.environment.empty()) return read_surroundings(flags);
  auto plain = plain_.find(flags.environment);
  if (plain == plain_.end())
    plain =
        plain_
            .emplace(flags.environment,
                     *read_surroundings({.environment = flags.environment, .max_memory = flags.max_memory}))
            .first;
  return turned_and_scaled(plain->second, flags);
}

/// What depends on the view is chosen anew for each, as a render of that view alone would.
void LiveScene::set_environment(const RenderRequest& request, const RenderSettings& settings,
                                NoticeLog& log) {
  if (!shows_light(request.flags)) return;
  const SurroundingsFlags& flags = request.flags.surroundings;
  const auto asked = read(flags);
  std::string key = fmt::format("{}\n{}\n{}", flags.environment, flags.rotate, flags.scale);
  if (!asked || asked->turns_with_camera) {
    RenderSettings view;
    view.width = settings.width;
    view.height = settings.height;
    view.camera = settings.camera;
    key += view.to_json();
  }
  if (key == surrounded_for_) {
    log.add(surroundings_notices_);
    return;
  }
  NoticeLog own(true);
  const std::unique_lock lock(mutex_);
  if (asked) {
    built_.scene->set_environment(nullptr);
  } else if (!has_own_surroundings_) {
    built_.scene->set_environment(built_.environment);
  }
  const bool had_own = has_own_surroundings_;
  surroundings_ = apps::set_environment(*built_.scene, asked, settings.camera, settings, own);
  surroundings_notices_ = own.notices();
  log.add(surroundings_notices_);
  has_own_surroundings_ = !asked && !surroundings_.environment;
  surrounded_for_ = key;
  if (!had_own || !has_own_surroundings_) ++version_;
}

RenderSettings LiveScene::prepare(const RenderRequest& request, NoticeLog& log) {
  build(request, log);
  const CameraFlags& flags = request.flags.camera;
  RenderSettings settings = request.settings;
  settings.background.picture = background_;
  settings.camera = place_camera(choose_camera(built_.cameras, flags, log), flags, built_.scene->geometry(),
                                 asked_aspect(request.flags.size), log);
  fill_in_size(settings, settings.camera);
  fit_lens(settings, flags.lens, *built_.scene, log);
  check_picture_size(settings, memory_use(request), request.flags.import.memory);
  set_environment(request, settings, log);
  const std::unique_lock lock(mutex_);
  settings_ = settings;
  return settings;
}

std::vector<std::string> LiveScene::camera_names() const {
  std::vector<std::string> names;
  if (built_.cameras.empty()) return names;
  NoticeLog unsaid(true);
  for (const LabelledCamera& camera : all_cameras(built_.cameras, unsaid)) names.push_back(camera.label);
  return names;
}

Bounds LiveScene::subject_bounds() const { return Subject(built_.scene->geometry()).bounds_to_see(); }

std::optional<SeenThing> LiveScene::look_at(int x, int y) const {
  const std::shared_lock lock(mutex_);
  if (!built_.scene || x < 0 || y < 0 || x >= settings_.width || y >= settings_.height) return {};
  CameraDescription pinhole = settings_.camera;
  pinhole.lens_radius = 0;
  const Camera camera(pinhole, settings_.width, settings_.height);
  const Ray ray = camera.ray({float(x) + 0.5f, float(y) + 0.5f});
  const auto hit = intersect_from_camera(*built_.scene, camera_segment(*built_.scene, ray));
  if (!hit) return {};
  return SeenThing{built_.objects[hit->instance], built_.materials[hit->instance], camera.depth(ray, hit->t),
                   hit->position};
}

}  // namespace vernier::apps
