// SPDX-License-Identifier: Apache-2.0
// Renders a glTF file to an error of 2 %: render_file SCENE.glb PICTURE.exr

#include <vernier/vernier.h>

#include <cstdio>
#include <utility>

int main(int argc, char** argv) try {
  if (argc != 3) {
    std::fprintf(stderr, "expected SCENE and PICTURE\n");
    return 2;
  }
  vernier::SceneDescription description = vernier::import_scene(argv[1]);
  for (const vernier::Notice& notice : description.notices) std::fprintf(stderr, "%s\n", notice.text.c_str());
  const auto cameras = description.cameras;
  const auto scene = vernier::build_scene(std::move(description));

  vernier::RenderSettings settings;
  settings.width = 320;
  settings.height = 240;
  settings.camera = cameras.empty() ? vernier::fitted_camera(*scene, 4 / 3.f) : cameras[0];
  settings.limits = {.spp = 1024, .error = 0.02};
  if (vernier::is_dark(*scene, settings))
    vernier::set_environment(*scene, vernier::built_in_environment("studio", settings.camera));
  vernier::RenderSession session(scene, settings);
  session.run();

  const vernier::RenderStatus status = session.status();
  std::printf("%.4g samples a pixel, error %.3g %% (%.3g to %.3g %%)\n", status.samples_per_pixel,
              100 * status.error.rel_rmse, 100 * status.error.low, 100 * status.error.high);
  session.write(argv[2], "error,albedo");
  return 0;
} catch (const vernier::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 3;
}
