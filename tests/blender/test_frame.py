# SPDX-License-Identifier: Apache-2.0
"""The part of a view that a picture is."""
import math
import pathlib
import re
import tomllib
import unittest

import vernier_blender
from vernier_blender.frame import Border, Projection, frame_of, lens_flags

ROOT = pathlib.Path(__file__).resolve().parents[2]
PLAIN = Projection(0.5, 0.25)


class Frames(unittest.TestCase):
    def test_plain_view_has_no_crop(self):
        self.assertEqual(frame_of(200, 100, PLAIN, None).flags(), ["--size", "200x100"])

    def test_shift_is_a_part_of_a_larger_view(self):
        frame = frame_of(200, 100, Projection(0.5, 0.25, 0.1, -0.2), None)
        self.assertEqual(frame.flags(), ["--size", "220x120", "--crop", "200x100+20+20"])
        # A pixel keeps its size.
        self.assertAlmostEqual(frame.half_width / 220, 0.5 / 200)
        self.assertAlmostEqual(frame.half_height / 120, 0.25 / 100)
        other = frame_of(200, 100, Projection(0.5, 0.25, -0.1, 0.2), None)
        self.assertEqual(other.flags(), ["--size", "220x120", "--crop", "200x100+0+0"])

    def test_shifted_middle_lies_where_the_projection_says(self):
        frame = frame_of(200, 100, Projection(0.5, 0.25, 0.1, -0.2), None)
        middle = frame.part_x + 100, frame.part_y + 50
        x = (middle[0] - frame.width / 2) / (frame.width / 2) * frame.half_width
        y = (frame.height / 2 - middle[1]) / (frame.height / 2) * frame.half_height
        self.assertAlmostEqual(x, 0.1 * 0.5)
        self.assertAlmostEqual(y, -0.2 * 0.25)

    def test_border_counts_from_below(self):
        frame = frame_of(200, 100, PLAIN, Border(0.25, 0.75, 0.1, 0.4))
        self.assertEqual(frame.flags(), ["--size", "200x100", "--crop", "100x30+50+60"])

    def test_border_is_cut_off_as_blender_does(self):
        # 0.7 is less than seven tenths in single precision.
        self.assertEqual(frame_of(10, 10, PLAIN, Border(0, 0.7, 0, 1)).part_width, 7)
        self.assertEqual(frame_of(100, 10, PLAIN, Border(0, 0.29, 0, 1)).part_width, 29)

    def test_cameras(self):
        frame = frame_of(200, 100, PLAIN, None)
        self.assertAlmostEqual(math.tan(frame.camera(False)["perspective"]["yfov"] / 2), 0.25)
        self.assertEqual(frame.camera(True)["orthographic"]["xmag"], 0.5)

    def test_matrices(self):
        perspective = [[2, 0, 0.1, 0], [0, 4, 0.3, 0], [0, 0, -1, -1], [0, 0, -1, 0]]
        self.assertEqual(Projection.of_matrix(perspective, False), Projection(0.5, 0.25, 0.1, 0.3))
        flat = [[2, 0, 0, 0.1], [0, 4, 0, 0.3], [0, 0, -1, -1], [0, 0, 0, 1]]
        self.assertEqual(Projection.of_matrix(flat, True), Projection(0.5, 0.25, -0.1, -0.3, True))

    def test_lens_has_the_focal_length_of_the_camera(self):
        flags = lens_flags(frame_of(200, 100, PLAIN, None), 50, 2.8, 3)
        sensor = float(flags[flags.index("--sensor") + 1])
        self.assertAlmostEqual(sensor / 2 / 0.5, 50)


class Versions(unittest.TestCase):
    def test_are_the_projects(self):
        project = re.search(r"project\(vernier VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text())[1]
        manifest = pathlib.Path(vernier_blender.__file__).with_name("blender_manifest.toml").read_text()
        self.assertEqual(tomllib.loads(manifest)["version"], project)
        self.assertEqual(".".join(map(str, vernier_blender.bl_info["version"])), project)
