// SPDX-License-Identifier: Apache-2.0
// Builds a scene from arrays, renders it in two goes, the second from a checkpoint: render_arrays PICTURE.png

#include <vernier/vernier.h>

#include <cstdio>
#include <utility>

namespace {

/// Red pyramid on a grey ground under the sky.
vernier::SceneDescription pyramid() {
  vernier::SceneDescription scene;
  scene.hash = "pyramid 1";  // tells checkpoints of it from those of other scenes
  vernier::MeshDescription ground;
  ground.positions = {{-4, 0, -4}, {-4, 0, 4}, {4, 0, 4}, {4, 0, -4}};
  ground.triangles = {{0, 1, 2}, {0, 2, 3}};
  vernier::MeshDescription body;
  body.positions = {{-1, 0, 1}, {1, 0, 1}, {1, 0, -1}, {-1, 0, -1}, {0, 1.5f, 0}};
  body.triangles = {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}};
  vernier::MaterialDescription grey, red;
  grey.metallic = red.metallic = 0;
  grey.base_color = {0.5f, 0.5f, 0.5f, 1};
  red.base_color = {0.7f, 0.1f, 0.05f, 1};
  red.roughness = 0.3f;
  scene.meshes = {ground, body};
  scene.materials = {grey, red};
  scene.instances = {{"ground", 0, 0, {}, {}}, {"pyramid", 1, 1, {}, {}}};
  scene.environment = vernier::built_in_environment("sky");
  return scene;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) {
    std::fprintf(stderr, "expected PICTURE\n");
    return 2;
  }
  const auto scene = vernier::build_scene(pyramid());
  vernier::RenderSettings settings;
  settings.width = settings.height = 128;
  settings.camera = vernier::fitted_camera(*scene, 1);
  settings.limits = {.spp = 16};
  vernier::RenderSession first(scene, settings);
  first.run();
  first.save("pyramid.ckpt");

  settings.limits = {.spp = 64};
  vernier::RenderSession second(scene, settings);
  second.load("pyramid.ckpt");
  second.on_progress(
      [](const vernier::RenderProgress& progress) { std::printf("%.0f %%\n", 100 * progress.fraction); });
  second.run();
  second.write(argv[1]);
  std::printf("error %.3g %%\n", 100 * second.status().error.rel_rmse);
  return 0;
} catch (const vernier::Error& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 3;
}
