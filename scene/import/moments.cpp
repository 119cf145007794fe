// SPDX-License-Identifier: Apache-2.0
#include "scene/import/moments.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/base/parallel.h"
#include "scene/bounds.h"
#include "scene/import/course.h"
#include "scene/import/deform.h"
#include "scene/import/instant.h"

namespace vernier {
namespace {

/// Of the size of what moves: how far its chords may be from its course, and how far it must go to move.
constexpr double tolerance = 1e-3, noticeable = 1e-6;
constexpr int first_level = 2;

Bounds bounds_of(const MeshDescription& mesh) {
  Bounds box;
  for (const Vec3f& p : mesh.positions) box.add(p);
  return box;
}

std::vector<Vec3d> corners_of(const Bounds& box) {
  std::vector<Vec3d> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(i & 1 ? box.upper.x : box.lower.x, i & 2 ? box.upper.y : box.lower.y,
                         i & 4 ? box.upper.z : box.lower.z);
  return corners;
}

Vec3d placed(const Transform& t, const Vec3d& p) {
  return Vec3d(t.x) * p.x + Vec3d(t.y) * p.y + Vec3d(t.z) * p.z + Vec3d(t.origin);
}

/// An instance that may move.
struct Mover {
  size_t instance;
  bool deforms;
  Course course;
  double size = 0;                                                    ///< the largest diagonal that it has
  std::array<std::optional<MeshDescription>, most_moments> shapes{};  ///< of one that deforms
  std::optional<int> level{};
};

class MotionReader {
 public:
  explicit MotionReader(const PosedDescription& posed)
      : posed_(posed), scene_(posed.scene), shutter_(*posed.options.shutter) {}

  void read() {
    if (!sample(first_level)) return;
    find_movers();
    for (level_ = first_level;; ++level_) {
      follow();
      if (level_ == Course::finest || is_followed()) break;
      sample(level_ + 1);
    }
    keep_moving();
    tell();
  }

 private:
  /// All moments of a level; false when it has other instances, which cannot be told apart from these.
  bool sample(int level) {
    const double middle = posed_time(posed_.options), length = shutter_.close - shutter_.open;
    for (size_t k = 0; k < most_moments; k += Course::stride(level)) {
      if (instants_[k]) continue;
      instants_[k] = instant_at(posed_, middle + (double(k) / (most_moments - 1) - 0.5) * length);
      changes_ = changes_ || instants_[k]->changes;
      if (instants_[k]->placement.too_far.empty() &&
          instants_[k]->placement.instances.size() == scene_.instances.size() &&
          instants_[k]->seen.lights.size() == scene_.lights.size())
        continue;
      scene_.notices.push_back({Notice::Severity::warning, "/animations",
                                "nothing is shown to move while the shutter is open, since some of it leaves "
                                "the range of single precision meanwhile"});
      return false;
    }
    return true;
  }

  const MeshRequest& request_at(size_t moment, size_t instance) const {
    const Placement& placement = instants_[moment]->placement;
    return placement.meshes[placement.instances[instance].mesh];
  }

  bool deforms_at(size_t moment, size_t instance) const {
    const MeshUse& use = posed_.requests[scene_.instances[instance].mesh].use;
    if (!(request_at(moment, instance).use == use)) return true;
    return use.skin >= 0 && joint_matrices(posed_.document, use.skin, instants_[moment]->places.to_world) !=
                                joint_matrices(posed_.document, use.skin, posed_.places.to_world);
  }

  void find_movers() {
    std::vector<char> is_placed(scene_.instances.size()), deforms(scene_.instances.size());
    parallel_for(scene_.instances.size(), [&](size_t i) {
      for (size_t k = 0; k < most_moments; k += Course::stride(first_level)) {
        is_placed[i] |= instants_[k]->placement.instances[i].to_world != scene_.instances[i].to_world;
        deforms[i] |= deforms_at(k, i);
      }
    });
    for (size_t i = 0; i < scene_.instances.size(); ++i) {
      if (!is_placed[i] && !deforms[i]) continue;
      // Points and lines get their bodies later, from one shape.
      const bool is_thin =
          posed_.requests[scene_.instances[i].mesh].topology != Topology::triangles && deforms[i];
      thin_ += is_thin;
      if (!is_thin) movers_.push_back({i, bool(deforms[i]), {}, 0});
    }
  }

  /// Fills courses with what has been sampled since.
  void follow() {
    for (size_t k = 0; k < most_moments; k += Course::stride(level_)) {
      if (followed_[k]) continue;
      followed_[k] = true;
      read_shapes(k);
      parallel_for(movers_.size(), [&](size_t i) { follow(movers_[i], k); });
    }
    parallel_for(movers_.size(), [&](size_t i) {
      Mover& mover = movers_[i];
      if (!mover.level) mover.level = mover.course.level(level_, tolerance * mover.size);
    });
  }

  bool is_followed() const {
    return std::all_of(movers_.begin(), movers_.end(), [](const Mover& m) { return m.level.has_value(); }) &&
           find_level(true) && find_level(false);
  }

  void read_shapes(size_t k) {
    std::vector<MeshRequest> requests;
    std::vector<size_t> of;
    for (size_t i = 0; i < movers_.size(); ++i) {
      if (!movers_[i].deforms || movers_[i].level) continue;
      requests.push_back(request_at(k, movers_[i].instance));
      of.push_back(i);
    }
    MeshRepairs repairs;  // told of the middle
    auto meshes = read_meshes(posed_.document, requests, instants_[k]->places.to_world, repairs, nullptr);
    for (size_t i = 0; i < of.size(); ++i) {
      if (has_own_corners(requests[i])) separate_corners(meshes[i]);
      movers_[of[i]].shapes[k] = std::move(meshes[i]);
    }
  }

  /// Derived tangents split vertices where they differ.
  bool has_own_corners(const MeshRequest& request) const {
    const auto& attributes = posed_.document.model()
                                 .meshes[size_t(request.use.mesh)]
                                 .primitives[size_t(request.use.primitive)]
                                 .attributes;
    return request.tangent_map && !(attributes.count("NORMAL") && attributes.count("TANGENT"));
  }

  void follow(Mover& mover, size_t k) const {
    if (mover.level) return;
    const Transform& to_world = instants_[k]->placement.instances[mover.instance].to_world;
    const Bounds box =
        bounds_of(mover.deforms ? *mover.shapes[k] : scene_.meshes[scene_.instances[mover.instance].mesh]);
    std::vector<Vec3d> points = corners_of(box);
    for (Vec3d& p : points) p = placed(to_world, p);
    for (size_t i = 0; i < 4; ++i) mover.size = std::max(mover.size, length(points[i] - points[7 - i]));
    if (mover.deforms) {
      points.clear();
      for (const Vec3f& p : mover.shapes[k]->positions) points.push_back(placed(to_world, Vec3d(p)));
    }
    mover.course.set(k, std::move(points));
  }

  void keep_moving() {
    std::vector<uint32_t> uses(scene_.meshes.size(), 0);
    for (const auto& instance : scene_.instances) ++uses[instance.mesh];
    for (Mover& mover : movers_) {
      if (!mover.course.moves(noticeable * mover.size)) continue;
      InstanceDescription& instance = scene_.instances[mover.instance];
      const size_t stride = Course::stride(*mover.level);
      std::vector<Transform> moments;
      for (size_t k = 0; k < most_moments; k += stride)
        moments.push_back(instants_[k]->placement.instances[mover.instance].to_world);
      const auto mirrors = [](const Transform& t) { return t.determinant() < 0; };
      const bool turns_inside_out = std::any_of(moments.begin(), moments.end(), [&](const Transform& t) {
        return mirrors(t) != mirrors(instance.to_world);
      });
      if (turns_inside_out || (mover.deforms && !set_shapes(mover, instance, stride, uses))) {
        ++unlike_;
        continue;
      }
      if (std::any_of(moments.begin(), moments.end(),
                      [&](const Transform& t) { return t != instance.to_world; }))
        instance.moments = std::move(moments);
      ++moving_;
      deforming_ += mover.deforms;
      const MeshDescription& mesh = scene_.meshes[instance.mesh];
      bytes_ += ((most_moments - 1) / stride + 1) *
                (mesh.positions.size() * sizeof(Vec3f) + mesh.normals.size() * sizeof(Vec3f) +
                 mesh.tangents.size() * sizeof(Vec4f));
      most_ = std::max(most_, (most_moments - 1) / stride + 1);
    }
    set_frames<CameraDescription>(scene_.cameras, true);
    set_frames<PunctualLightDescription>(scene_.lights, false);
  }

  /// False when the shapes are not of the same triangles.
  bool set_shapes(Mover& mover, InstanceDescription& instance, size_t stride, std::vector<uint32_t>& uses) {
    MeshDescription mesh = scene_.meshes[instance.mesh];
    if (has_own_corners(posed_.requests[instance.mesh])) separate_corners(mesh);
    for (size_t k = 0; k < most_moments; k += stride) {
      MeshDescription& shape = *mover.shapes[k];
      if (shape.triangles != mesh.triangles || shape.positions.size() != mesh.positions.size() ||
          shape.normals.size() != mesh.normals.size() || shape.tangents.size() != mesh.tangents.size())
        return false;
      mesh.moments.push_back(
          {std::move(shape.positions), std::move(shape.normals), std::move(shape.tangents)});
    }
    if (uses[instance.mesh] == 1) {
      scene_.meshes[instance.mesh] = std::move(mesh);
      return true;
    }
    --uses[instance.mesh];
    posed_.requests.push_back(MeshRequest(posed_.requests[instance.mesh]));
    instance.mesh = uint32_t(scene_.meshes.size());
    scene_.meshes.push_back(std::move(mesh));
    uses.push_back(1);
    return true;
  }

  const Transform& frame(size_t k, bool of_camera, size_t i) const {
    const SceneDescription& seen = instants_[k]->seen;
    return of_camera ? seen.cameras[i].to_world : seen.lights[i].to_world;
  }

  /// The way of a camera or lamp, in units of what may be missed of it: a thousandth of the way that it goes,
  /// and of a radian.
  Course course_of(bool of_camera, size_t i) const {
    double way = 0;
    const size_t stride = Course::stride(level_);
    for (size_t k = stride; k < most_moments; k += stride)
      way += length(Vec3d(frame(k, of_camera, i).origin - frame(k - stride, of_camera, i).origin));
    Course course;
    for (size_t k = 0; k < most_moments; k += stride) {
      const Transform& t = frame(k, of_camera, i);
      const Vec3d origin = way > 0 ? Vec3d(t.origin - frame(0, of_camera, i).origin) / way : Vec3d(0, 0, 0);
      course.set(k, {origin, Vec3d(t.x), Vec3d(t.y), Vec3d(t.z)});
    }
    return course;
  }

  /// At which all cameras, or lamps, are followed.
  std::optional<int> find_level(bool of_cameras) const {
    int most = 0;
    for (size_t i = 0; i < (of_cameras ? scene_.cameras.size() : scene_.lights.size()); ++i) {
      const auto level = course_of(of_cameras, i).level(level_, tolerance);
      if (!level) return std::nullopt;
      most = std::max(most, *level);
    }
    return most;
  }

  template <typename Framed>
  void set_frames(std::vector<Framed>& framed, bool of_cameras) {
    const int level = find_level(of_cameras).value_or(Course::finest);
    for (size_t i = 0; i < framed.size(); ++i) {
      if (!course_of(of_cameras, i).moves(noticeable)) continue;
      for (size_t k = 0; k < most_moments; k += Course::stride(level))
        framed[i].moments.push_back(frame(k, of_cameras, i));
    }
  }

  void tell() {
    const auto note = [&](Notice::Severity severity, const std::string& text) {
      scene_.notices.push_back({severity, "/animations", text});
    };
    if (changes_)
      note(Notice::Severity::warning,
           "materials, lights, cameras or what is visible change while the shutter is open, and are shown as "
           "they are in its middle");
    if (thin_ + unlike_ > 0)
      note(
          Notice::Severity::warning,
          fmt::format("{} instances stand still, as in the middle of the shutter, since they turn inside out "
                      "or change their shape in a way that cannot be followed",
                      thin_ + unlike_));
    if (moving_ > 0)
      note(Notice::Severity::info,
           fmt::format(
               "{} of {} instances move while the shutter is open, {} of them by changing their shape; "
               "their vertices at up to {} moments take {:.1f} MB",
               moving_, scene_.instances.size(), deforming_, most_, double(bytes_) * 1e-6));
  }

  const PosedDescription& posed_;
  SceneDescription& scene_;
  const Shutter shutter_;
  int level_ = first_level;
  std::array<std::optional<Instant>, most_moments> instants_;
  std::array<bool, most_moments> followed_{};
  std::vector<Mover> movers_;
  bool changes_ = false;
  size_t thin_ = 0, unlike_ = 0, moving_ = 0, deforming_ = 0, most_ = 0, bytes_ = 0;
};

}  // namespace

double posed_time(const ImportOptions& options) {
  const double time = options.time.value_or(0);
  return options.shutter ? time + (options.shutter->open + options.shutter->close) / 2 : time;
}

void add_moments(const PosedDescription& posed) { MotionReader(posed).read(); }

}  // namespace vernier
