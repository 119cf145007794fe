#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "scene/accel/accelerator.h"
#include "scene/description.h"
#include "scene/surface_point.h"

namespace vernier {

struct Bounds {
  Vec3f lower{std::numeric_limits<float>::infinity()}, upper{-std::numeric_limits<float>::infinity()};
  bool empty() const { return !(lower.x <= upper.x); }
};

/// Everything that rays can meet and light can come from. Immutable once built; all members may be called from many
/// threads.
class Scene {
 public:
  struct Options {
    std::string accelerator;  ///< name in accelerators(); empty: the default
  };

  /// Takes the description's arrays over. A description with no light of any kind gets a default sky and a notice.
  Scene(SceneDescription description, const Options& options);
  ~Scene();
  Scene(Scene&&) noexcept;

  const Bounds& bounds() const;
  const Accelerator& accelerator() const;
  const std::vector<Notice>& notices() const;

  struct Data;  ///< scene/scene.cpp and its neighbours
 private:
  std::unique_ptr<Data> data_;
};

}  // namespace vernier
