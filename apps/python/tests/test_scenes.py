# SPDX-License-Identifier: Apache-2.0
"""Scenes of files, bytes and arrays."""

import math
import shutil

import numpy as np
import pytest

import vernier
from conftest import SCENES
from vernier._glb import _EXTENSIONS

SIZE = (48, 32)


def test_files_tell_what_they_hold(cornell):
    assert cornell.source.endswith("cornell_box.gltf")
    assert len(cornell.hash) == 32
    assert [camera.name for camera in cornell.cameras] == ["front"]
    assert cornell.bounds.shape == (2, 3) and (cornell.bounds[0] < cornell.bounds[1]).all()
    assert vernier.load(SCENES / "layer_spheres.gltf").features


def test_bytes_are_the_file_that_they_are_of(make_square, tmp_path):
    data = vernier.glb([make_square()])
    (tmp_path / "a.glb").write_bytes(data)
    from_file, from_bytes, from_view = (vernier.load(source) for source in (tmp_path / "a.glb", data, memoryview(data)))
    assert from_file.hash == from_bytes.hash == from_view.hash
    with pytest.raises(vernier.InputError, match="^downloaded: "):
        vernier.load(data[:100], name="downloaded")


def test_bytes_refer_to_no_files(tmp_path):
    text = (b'{"asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin", "byteLength": 4}]}')
    with pytest.raises(vernier.InputError, match="a scene in memory lies in no folder"):
        vernier.load(text)


def test_camera_of_the_file_is_a_camera_of_ones_own(cornell):
    file = vernier.render(cornell, size=SIZE, spp=2)
    own = vernier.render(cornell, size=SIZE, spp=2, camera=cornell.cameras[0])
    named = vernier.render(cornell, size=SIZE, spp=2, camera="front")
    assert file.pixels.tobytes() == own.pixels.tobytes() == named.pixels.tobytes()


def test_cameras_see_what_their_matrix_says(make_square):
    scene = vernier.load([make_square(material=vernier.Material(double_sided=True))])
    for eye in ((0, 0, 4), (2, 1, 3), (0, 5, 0.1)):
        camera = vernier.Camera.look_at(eye, (0, 0, 0), yfov=0.3)
        image = vernier.render(scene, size=(33, 33), spp=1, env="none", camera=camera, aov=["depth", "position"])
        assert image.layers["depth"][16, 16] == pytest.approx(np.linalg.norm(eye), rel=1e-4)
        assert np.allclose(image.layers["position"][16, 16], 0, atol=1e-4)
    right = vernier.Camera.look_at((0, 0, 4), (0, 0, 0), yfov=math.radians(20))
    position = vernier.render(scene, size=(33, 33), spp=1, env="none", camera=right, aov=["position"]).layers["position"]
    assert position[16, 24, 0] > 0 and position[8, 16, 1] > 0  # +x to the right, +y upward


def test_orthographic_camera_shows_ymag(make_square):
    scene = vernier.load([make_square()])
    camera = vernier.Camera(vernier.Camera.look_at((0, 0, 4), (0, 0, 0)).matrix, kind="orthographic", ymag=2)
    depth = vernier.render(scene, size=(80, 40), spp=1, env="none", camera=camera, aov=["depth"]).layers["depth"]
    assert np.isfinite(depth).sum() == pytest.approx(20 * 20, abs=2)  # of 80 x 40 pixels that show 8 x 4 m


def test_fitted_camera_sees_all(make_square):
    scene = vernier.load([make_square()])
    camera = scene.fitted_camera((64, 64), azimuth=0.0, elevation=0.0, margin=0.25)
    depth = vernier.render(scene, size=(64, 64), spp=1, env="none", camera=camera, aov=["depth"]).layers["depth"]
    rows = np.flatnonzero(np.isfinite(depth).any(1))
    assert (rows[0], rows[-1]) == (16, 47)


def test_arrays_become_what_they_say(make_square):
    red = vernier.Material(base_color=(1, 0, 0), roughness=1, specular=0)
    placed = np.eye(4)
    placed[:3, 3] = 5, 0, 0
    scene = vernier.load([make_square(material=red, name="left"), make_square(matrix=placed, name="right")])
    assert scene.objects == ["left", "right"]
    assert np.array_equal(scene.bounds, [[-1, -1, 0], [6, 1, 0]])
    camera = vernier.Camera.look_at((0, 0, 3), (0, 0, 0))
    image = vernier.render(scene, size=(9, 9), spp=4, env="sky", camera=camera, aov=["albedo", "normal", "id"])
    assert np.allclose(image.layers["albedo"][4, 4], (1, 0, 0), atol=1e-3)
    assert np.allclose(image.layers["normal"][4, 4], (0, 0, 1), atol=1e-6)
    assert image.layers["id"][4, 4] == 1


def test_irradiance_of_a_light(make_square):
    """A white diffuse square under a directional light of 1 W/m^2 has the radiance 1 / pi."""
    white = vernier.Material(base_color=(1, 1, 1), specular=0)
    light = vernier.Light("directional", matrix=vernier.Camera.look_at((0, 0, 1), (0, 0, 0)).matrix)
    scene = vernier.load(make_square(material=white), lights=[light])
    camera = vernier.Camera.look_at((0, 0, 3), (0, 0, 0), yfov=0.2)
    image = vernier.render(scene, size=(8, 8), spp=4, env="none", camera=camera)
    assert np.allclose(image.pixels, 1 / math.pi, rtol=2e-3)


def test_textures_are_looked_up_where_uvs_say(make_square):
    pixels = np.zeros((2, 2, 3), np.uint8)
    pixels[0, 1] = 255, 0, 0  # top right
    material = vernier.Material(base_color_texture=pixels, specular=0)
    scene = vernier.load(make_square(uvs=[[0, 1], [1, 1], [1, 0], [0, 0]], material=material))
    camera = vernier.Camera.look_at((0, 0, 3), (0, 0, 0), yfov=2 * math.atan(1 / 3))
    albedo = vernier.render(scene, size=(8, 8), spp=4, env="sky", camera=camera, aov=["albedo"]).layers["albedo"]
    assert albedo[1, 6, 0] > 0.6
    assert albedo[6, 1, 0] < 0.1


def test_every_factor_is_written_as_its_extension(make_square):
    colors = {name: (0.5, 0.5, 0.5) for name in _EXTENSIONS if name.endswith("color")}
    numbers = {name: 1.4 if name.endswith("ior") else 0.5 for name in _EXTENSIONS if name not in colors}
    scene = vernier.load([make_square(material=vernier.Material(**{name: value}))
                          for name, value in (colors | numbers).items()])
    features = {feature.name: feature.status for feature in scene.features}
    assert {extension for extension, _ in _EXTENSIONS.values()} <= set(features)
    assert "ignored" not in features.values()


def refused(part, **rest):
    with pytest.raises(vernier.UsageError, match=part):
        vernier.load([vernier.Mesh(**{"positions": np.eye(3), **rest})])


def test_arrays_that_are_no_meshes_are_refused():
    refused("mesh 0, positions: expected an array", positions=[[0, 0]])
    refused("row 1 has others", positions=[[0, 0, 0], [0, np.nan, 0], [0, 1, 0]])
    refused("from 0 to 2, the positions, got 0 to 3", indices=[[0, 1, 3]])
    refused("got -1 to 1", indices=[[0, 1, -1]])
    refused("expected whole numbers", indices=[[0.0, 1.0, 2.0]])
    refused("expected as many as positions, 3, got 2", normals=[[0, 0, 1]] * 2)
    refused("'part', uvs", uvs=[[0, 0, 0]] * 3, name="part")
    refused("expected three for each", positions=np.zeros((4, 3)))
    refused("4x4 matrix", matrix=np.eye(3))
    refused("expected a uint8 array", material=vernier.Material(base_color_texture=np.zeros((2, 2, 3))))
    refused("'felt', alpha_mode: expected one of OPAQUE, MASK, BLEND, got 'SOFT'",
            material=vernier.Material(alpha_mode="SOFT", name="felt"))
    clamped = vernier.load([vernier.Mesh(np.eye(3), material=vernier.Material(roughness=3))])
    assert clamped.notices[0].place == "/materials/0" and "clamped" in clamped.notices[0].text
    with pytest.raises(vernier.UsageError, match="orthonormal"):
        vernier.Camera(np.diag([2, 2, 2, 1]))
    with pytest.raises(vernier.UsageError, match="vernier.Mesh, got int"):
        vernier.load([1])
    with pytest.raises(vernier.UsageError, match="a file has its own"):
        vernier.load(SCENES / "cornell_box.gltf", lights=[vernier.Light()])


def test_trimesh_exports_are_scenes():
    trimesh = pytest.importorskip("trimesh", reason="trimesh is not installed")
    ball = trimesh.creation.icosphere(subdivisions=2, radius=0.5)
    scene = vernier.load(ball.export(file_type="glb"), name="ball")
    assert np.allclose(scene.bounds, [[-0.5] * 3, [0.5] * 3])
    camera = vernier.Camera(trimesh.transformations.translation_matrix((0, 0, 3)))
    image = vernier.render(scene, size=(33, 33), spp=2, camera=camera, aov=["depth"])
    assert image.layers["depth"][16, 16] == pytest.approx(2.5, abs=0.01)
    mesh = vernier.Mesh(ball.vertices, ball.faces, normals=ball.vertex_normals)
    same = vernier.render(vernier.load(mesh), size=(33, 33), spp=2, camera=camera, aov=["depth"])
    assert np.allclose(same.layers["depth"], image.layers["depth"])


def test_other_times_of_a_file_share_it(tmp_path):
    """What is described again needs the file no more."""
    shutil.copy(SCENES / "cornell_box.gltf", tmp_path / "a.gltf")
    scene = vernier.load(tmp_path / "a.gltf")
    (tmp_path / "a.gltf").unlink()
    again = scene.at()
    assert again.hash == scene.hash
    with pytest.raises(vernier.UsageError, match="variant"):
        scene.at(variant="blue")
