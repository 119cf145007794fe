// SPDX-License-Identifier: Apache-2.0
#include "tests/support/pictures.h"

#include <algorithm>
#include <cmath>

#include "core/base/parallel.h"
#include "scene/camera.h"

namespace vernier::test {

CameraDescription camera_at(const Vec3f& from, const Vec3f& to, float yfov) {
  CameraDescription camera;
  camera.yfov = yfov;
  camera.to_world.origin = from;
  camera.to_world.z = normalize(from - to);
  camera.to_world.x = normalize(cross(Vec3f(0, 1, 0), camera.to_world.z));
  camera.to_world.y = cross(camera.to_world.z, camera.to_world.x);
  return camera;
}

std::vector<Samples> pixels_of(const PictureCase& picture, int renders, uint64_t first_seed) {
  std::vector<std::vector<float>> values(static_cast<size_t>(renders));
  const Camera camera(picture.camera, picture.settings.width, picture.settings.height);
  const auto integrator = make_integrator(picture.settings.integrator, picture.settings.integrator_options);
  parallel_for(values.size(), [&](size_t i) {
    RenderSettings settings = picture.settings;
    settings.seed = first_seed + i;
    const std::atomic<bool> stop = false;
    values[i] = render(picture.scene, camera, *integrator, settings, stop).film.image().values;
  });
  const size_t pixels = values[0].size() / 3;
  std::vector<Samples> result(3 * pixels + 3);
  for (const auto& image : values) {
    std::array<double, 3> mean{};
    for (size_t i = 0; i < image.size(); ++i) {
      result[i].add(double(image[i]));
      mean[i % 3] += double(image[i]) / double(pixels);
    }
    for (size_t c = 0; c < 3; ++c) result[3 * pixels + c].add(mean[c]);
  }
  return result;
}

double difference(const std::vector<Samples>& a, const std::vector<Samples>& b) {
  double p = 1;
  for (size_t i = 0; i < a.size(); ++i) {
    // What float sums over a path can differ by.
    if (std::abs(a[i].mean() - b[i].mean()) <= 1e-5 * std::abs(a[i].mean())) continue;
    p = std::min(p, welch_p_value(a[i], b[i]));
  }
  return p * double(a.size());
}

double resolution(const std::vector<Samples>& a, const std::vector<Samples>& b, double significance) {
  double coarsest = 0;
  for (size_t i = a.size() - 3; i < a.size(); ++i)
    if (a[i].mean() > 0)
      coarsest = std::max(
          coarsest, detectable_bias(std::hypot(a[i].standard_error(), b[i].standard_error()), significance) /
                        a[i].mean());
  return coarsest;
}

}  // namespace vernier::test
