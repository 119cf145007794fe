# SPDX-License-Identifier: Apache-2.0
"""The same settings give the same bytes as the command line, and the same errors."""

import numpy as np
import pytest

import vernier
from conftest import SCENES

SIZE = ["--size", "48x32"]
AOV = ("albedo", "depth", "error", "half", "id", "normal", "position", "samples", "crypto_object", "uv")
CASES = {
    "file's camera and lights": ("cornell_box", {"spp": 8}, ["--spp", "8"]),
    "studio for a dark scene": ("sphere_grid", {"spp": 6}, ["--spp", "6"]),
    "fitted camera, sky, ground": ("sphere_grid", {"spp": 5, "env": "sky", "ground": "matte", "env_scale": 2.0},
                                   ["--spp", "5", "--env", "sky", "--env-scale", "2", "--ground", "matte"]),
    "until an error": ("two_spheres", {"error": 0.2, "seed": 7}, ["--error", "20%", "--seed", "7"]),
    "transparent": ("sphere_grid", {"spp": 4, "background": "transparent", "env": "studio"},
                    ["--spp", "4", "--transparent", "--env", "studio"]),
    "other settings": ("cornell_box",
                       {"spp": 4, "filter": "gaussian:2", "crop": (4, 3, 20, 16), "max_depth": 3, "texture_filter": "mip:0.5", "caustics": "off", "adaptive": False,
                        "accelerator": "bvh", "background": (0.2, 0.3, 0.4)},
                       ["--spp", "4", "--filter", "gaussian:2", "--crop", "20x16+4+3", "--max-depth", "3", "--texture-filter", "mip:0.5", "--caustics", "off", "--adaptive",
                        "off", "--accelerator", "bvh", "--background", "0.2,0.3,0.4"]),
    "light in parts": ("night_room", {"spp": 4, "light_ways": ["diffuse_direct", "emission"],
                                      "light_groups": {"key": ["lamp"]}},
                       ["--spp", "4", "--light-groups", "key=lamp"]),
    "fog": ("night_room", {"spp": 4, "fog": vernier.Fog(0.05, [0.5, 0.5, 0.5], 0.3, 20.0)},
            ["--spp", "4", "--fog", "0.05,0.5,0.3,20"]),
    "raycast": ("two_spheres", {"spp": 2, "integrator": "raycast", "show": "depth"},
                ["--spp", "2", "--integrator", "raycast", "--show", "depth"]),
    "whitted": ("two_spheres", {"spp": 2, "integrator": "whitted", "ambient": 0.2},
                ["--spp", "2", "--integrator", "whitted", "--ambient", "0.2"]),
}


@pytest.mark.parametrize("case", CASES)
def test_same_bytes(case, command, tmp_path):
    name, settings, flags = CASES[case]
    path = SCENES / f"{name}.gltf"
    parts = [*settings.get("light_ways", []), *(["light_groups"] if "light_groups" in settings else [])]
    done = command("render", path, "-o", "cli.exr", "-o", "cli.png", "-q", *SIZE, "--aov", ",".join([*AOV, *parts]), *flags)
    assert done.returncode == 0, done.stderr
    image = vernier.render(vernier.load(path), size=(48, 32), aov=AOV, **settings)
    theirs = vernier.read(tmp_path / "cli.exr")
    assert image.pixels.tobytes() == theirs.pixels.tobytes()
    assert (image.alpha is None) == (theirs.alpha is None)
    assert sorted(image.layers) == sorted(theirs.layers)
    for layer, values in image.layers.items():
        assert values.tobytes() == theirs.layers[layer].tobytes(), layer
    for key in ("sceneHash", "samples", "relRmse", "relRmse95", "stoppedBy", "surroundings", "integrator", "seed",
                "camera", "size"):
        assert image.metadata.get(f"vernier:{key}") == theirs.metadata.get(f"vernier:{key}"), key
    image.save(tmp_path / "own.png")
    own, shown = (vernier.read(tmp_path / name) for name in ("own.png", "cli.png"))
    assert own.pixels.tobytes() == shown.pixels.tobytes()


def test_denoised_bytes(command, cornell, tmp_path):
    done = command("render", SCENES / "cornell_box.gltf", "-o", "cli.exr", "-q", *SIZE, "--spp", "8", "--denoise", "nlm")
    assert done.returncode == 0, done.stderr
    image = vernier.render(cornell, size=(48, 32), spp=8, denoise="nlm")
    theirs = vernier.read(tmp_path / "cli.exr")
    assert image.pixels.tobytes() == theirs.pixels.tobytes()
    assert theirs.error.rel_rmse == pytest.approx(image.error.rel_rmse, rel=1e-5)
    assert image.error.rel_rmse < image.denoised_from


def test_arrays_render_as_the_file_that_they_make(command, make_square, tmp_path):
    texture = np.zeros((4, 4, 3), np.uint8)
    texture[:2, :2] = 255
    meshes = [make_square(uvs=[[0, 0], [1, 0], [1, 1], [0, 1]],
                          material=vernier.Material(base_color_texture=texture, roughness=0.4)),
              make_square(matrix=vernier.Camera.look_at((0, 3, 0), (0, 0, 0.01)).matrix,
                          material=vernier.Material(emissive=(0, 3, 6), double_sided=True))]
    parts = {"lights": [vernier.Light(intensity=20, matrix=vernier.Camera.look_at((2, 2, 2), (0, 0, 0)).matrix)],
             "cameras": [vernier.Camera.look_at((1, 1, 3), (0, 0, 0), name="here")]}
    (tmp_path / "meshes.glb").write_bytes(vernier.glb(meshes, **parts))
    done = command("render", "meshes.glb", "-o", "cli.exr", "-q", *SIZE, "--spp", "4")
    assert done.returncode == 0, done.stderr
    image = vernier.render(vernier.load(meshes, **parts), size=(48, 32), spp=4)
    assert image.pixels.tobytes() == vernier.read(tmp_path / "cli.exr").pixels.tobytes()
    assert image.pixels.max() > 0


def test_checkpoints_are_the_command_lines(command, cornell, tmp_path):
    session = vernier.Session(cornell, size=(48, 32))
    session.run(spp=4)
    session.save(tmp_path / "half.ckpt")
    done = command("render", SCENES / "cornell_box.gltf", "-o", "cli.exr", "-q", *SIZE, "--spp", "8", "--resume",
                   "half.ckpt")
    assert done.returncode == 0, done.stderr
    session.run(spp=8)
    assert session.image().pixels.tobytes() == vernier.read(tmp_path / "cli.exr").pixels.tobytes()


@pytest.mark.parametrize("settings, flags, kind", [
    ({"integrator": "pth"}, ["--integrator", "pth"], vernier.UsageError),
    ({"camera": "nowhere"}, ["--camera", "nowhere"], vernier.UsageError),
    ({"env": "studo"}, ["--env", "studo"], vernier.UsageError),
    ({"env": "none.hdr"}, ["--env", "none.hdr"], vernier.InputError),
    ({"background": "none.png"}, ["--background", "none.png"], vernier.InputError),
    ({"filter": "boks"}, ["--filter", "boks"], vernier.UsageError),
])
def test_same_errors(settings, flags, kind, command, cornell):
    done = command("render", SCENES / "cornell_box.gltf", "-o", "a.exr", *SIZE, *flags)
    with pytest.raises(kind) as caught:
        vernier.render(cornell, size=(48, 32), spp=1, **settings)
    assert done.stderr.replace("--env", "env") == f"error: {caught.value}\n"
    assert caught.value.exit_code == done.returncode


def test_same_error_of_a_scene(command, tmp_path):
    (tmp_path / "bad.gltf").write_text('{"asset": {"version": "2.0"}, "meshes": [{"primitives": [{"attributes": 3}]}]}')
    done = command("info", tmp_path / "bad.gltf")
    with pytest.raises(vernier.InputError) as caught:
        vernier.load(tmp_path / "bad.gltf")
    assert done.stderr == f"error: {caught.value}\n"
    assert isinstance(caught.value, OSError)
