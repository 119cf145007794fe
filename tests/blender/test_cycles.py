# SPDX-License-Identifier: Apache-2.0
"""Lamps, worlds and cameras are as bright as Cycles has them, within both renderers' errors, on diffuse surfaces."""
import math
import sys
import unittest

import bpy
import numpy
import pictures

SQUARE = 8  # pixels a side over which differences are averaged
SIZE = (32, 32)


def room(size=SIZE):
    """A cube on a ground, so that there are shadows and light from one to the other."""
    scene = pictures.new_scene(size)
    pictures.add_square(20)
    pictures.add_cube(0.8, (0.5, 0.3, 0.4), (0, 0, 0.4))
    scene.vernier.samples = 128
    scene.vernier.pixel_filter = "box"
    cycles = scene.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = 128, False, False
    cycles.pixel_filter_type, cycles.filter_width, cycles.device = "BOX", 1, "CPU"
    cycles.sample_clamp_indirect = cycles.light_sampling_threshold = 0
    cycles.max_bounces = cycles.diffuse_bounces = 16
    return scene


def uniform_world(scene, color):
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs["Color"].default_value = (*color, 1)


def picture_world(scene, rotation, strength):
    """Bright where +x is, dim elsewhere, another colour below; turned about z."""
    image = bpy.data.images.new("Sky", 64, 32, float_buffer=True)
    pixels = numpy.full((32, 64, 4), 0.2, dtype=numpy.float32)
    pixels[16:26, 24:40, :3] = (6, 4, 2)
    pixels[:16, :, :3] = (0.1, 0.3, 0.1)
    pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.pack()
    scene.world.use_nodes = True
    nodes, links = scene.world.node_tree.nodes, scene.world.node_tree.links
    texture, mapping = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeMapping")
    place = nodes.new("ShaderNodeTexCoord")
    texture.image = image
    mapping.inputs["Rotation"].default_value[2] = rotation
    links.new(place.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], nodes["Background"].inputs["Color"])
    nodes["Background"].inputs["Strength"].default_value = strength


def squares(picture):
    rows, columns = picture.shape[0] // SQUARE, picture.shape[1] // SQUARE
    return picture.reshape(rows, SQUARE, columns, SQUARE, 3).mean(axis=(1, 3))


def twice(scene, engine):
    """The mean of two renders by other random numbers, over squares, and its standard error over the picture."""
    scene.render.engine = engine
    both = []
    for seed in (1, 2):
        scene.vernier.seed = scene.cycles.seed = seed
        both.append(squares(pictures.colors(pictures.rendered(scene))))
    mean = (both[0] + both[1]) / 2
    relative = (both[0] - both[1]) / 2 / numpy.maximum(mean, 1e-3)
    return mean, math.sqrt((relative ** 2).mean())


class BesideCycles(unittest.TestCase):
    def expect_alike(self, scene, systematic=0.003):
        """`systematic`: relative difference that is explained in docs/blender.md."""
        ours, our_error = twice(scene, "VERNIER")
        theirs, their_error = twice(scene, "CYCLES")
        self.assertGreater(theirs.max(), 0.01)
        difference = (ours - theirs) / numpy.maximum(theirs, 1e-3)
        rms = math.sqrt((difference ** 2).mean())
        expected = math.hypot(our_error, their_error)
        print(f"{self.id()}: rms difference {rms:.4f}, errors {our_error:.4f} and {their_error:.4f}, mean "
              f"{difference.mean():+.4f}", file=sys.stderr)
        self.assertLess(rms, 2 * expected + systematic)
        self.assertLess(abs(difference.mean()), 3 * expected / math.sqrt(difference.size / 3) + systematic)

    def test_point_lamp(self):
        scene = room()
        pictures.add_lamp("POINT", (-1, 0.5, 3), energy=300, shadow_soft_size=0, color=(1, 0.5, 0.2))
        self.expect_alike(scene)

    def test_round_lamp(self):
        scene = room()
        pictures.add_lamp("POINT", (-1, 0.5, 3), energy=300, shadow_soft_size=0.4)
        # Cycles' is a disk that faces what it lights, and so darker by the squared radius over distance.
        self.expect_alike(scene, 0.02)

    def test_sun(self):
        scene = room()
        pictures.add_lamp("SUN", (0, 0, 9), (0.6, 0.3, 0), energy=3, angle=0)
        self.expect_alike(scene)

    def test_spot_within_its_cone(self):
        scene = room()
        pictures.add_lamp("SPOT", (0, 0, 20), energy=9000, shadow_soft_size=0, spot_size=0.6, spot_blend=0.1)
        self.expect_alike(scene, 0.01)

    def test_area_lamps(self):
        scene = room()
        pictures.add_lamp("AREA", (-1, 0.5, 3), (0.3, -0.2, 0), energy=200, shape="RECTANGLE", size=1, size_y=0.5)
        pictures.add_lamp("AREA", (1, -1, 3), (-0.3, 0.2, 0), energy=100, shape="ELLIPSE", size=0.5, size_y=1)
        self.expect_alike(scene)

    def test_uniform_world(self):
        scene = room()
        uniform_world(scene, (0.2, 0.4, 0.8))
        self.expect_alike(scene)

    def test_turned_world(self):
        scene = room()
        picture_world(scene, 0.9, 1.5)
        self.expect_alike(scene)

    def test_world_through_lamps(self):
        scene = room()
        uniform_world(scene, (0.5, 0.5, 0.5))
        pictures.add_lamp("AREA", (0, 0, 11), energy=1, size=6)
        self.expect_alike(scene)

    def test_world_seen(self):
        scene = pictures.new_scene(SIZE)
        scene.vernier.samples = scene.cycles.samples = 64
        scene.cycles.use_denoising = False
        scene.cycles.pixel_filter_type, scene.cycles.filter_width = "BOX", 1
        scene.camera.rotation_euler = (1.4, 0.1, -1.2)
        scene.camera.data.angle = 1.5
        picture_world(scene, 0.5, 1)
        self.expect_alike(scene, 0.01)

    def test_cameras(self):
        for change in ({"type": "ORTHO", "ortho_scale": 3.0}, {"sensor_fit": "VERTICAL", "shift_y": 0.125},
                       {"shift_x": -0.125, "lens": 90.0}):
            with self.subTest(change):
                scene = room((48, 32))
                pictures.add_lamp("SUN", (0, 0, 9), (0.6, 0.3, 0), energy=3, angle=0)
                for name, value in change.items():
                    setattr(scene.camera.data, name, value)
                self.expect_alike(scene, 0.005)

    def test_motion_blur(self):
        """Of what moves along and turns, of what changes its shape, and of the camera."""
        for position in ("CENTER", "START"):
            scene = room((48, 32))
            pictures.add_lamp("SUN", (0, 0, 9), (0.6, 0.3, 0), energy=3, angle=0)
            cube = bpy.data.objects["Cube"]
            for frame, x, turn in ((0, -0.2, 0.0), (1, 0.5, 0.4), (2, 1.2, 0.8)):
                cube.location.x, cube.rotation_euler.z = x, turn
                cube.keyframe_insert("location", frame=frame)
                cube.keyframe_insert("rotation_euler", frame=frame)
            bulge = pictures.add_cube(0.6, (-1, -0.4, 0.3))
            bulge.shape_key_add(name="Basis")
            key = bulge.shape_key_add(name="Wide")
            for point in key.data:
                point.co.y *= 3
            for frame, value in ((0, 0.0), (2, 1.0)):
                key.value = value
                key.keyframe_insert("value", frame=frame)
                scene.camera.location.y = 0.2 * value
                scene.camera.keyframe_insert("location", frame=frame)
            for curve in [curve for action in bpy.data.actions for curve in action.fcurves]:
                for point in curve.keyframe_points:
                    point.interpolation = "LINEAR"
            scene.frame_set(1)
            scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
            owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
            owner.motion_blur_position = position
            self.expect_alike(scene)

    def test_depth_of_field(self):
        scene = room()
        pictures.add_lamp("SUN", (0, 0, 9), (0.6, 0.3, 0), energy=3, angle=0)
        dof = scene.camera.data.dof
        dof.use_dof, dof.aperture_fstop, dof.focus_distance = True, 0.05, 8
        self.expect_alike(scene, 0.005)
