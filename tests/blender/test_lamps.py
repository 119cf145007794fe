# SPDX-License-Identifier: Apache-2.0
"""Lamps as they stand in the exported file."""
import base64
import json
import math
import pathlib
import struct
import tempfile
import unittest

from vernier_blender.gltf_file import GltfFile
from vernier_blender.lamps import Lamp, add_lamps

PLACE = [[1, 0, 0, 1], [0, 1, 0, 2], [0, 0, 1, 3], [0, 0, 0, 1]]
WHITE = (1.0, 1.0, 1.0)


def exported(*lamps: Lamp) -> dict:
    """The document that has these lamps alone."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / "scene.gltf"
        path.write_text('{"asset": {"version": "2.0"}}')
        gltf = GltfFile(str(path))
        add_lamps(list(lamps), gltf, 1 / 4)
        gltf.save()
        return json.loads(path.read_text())


def punctual(document: dict) -> dict:
    return document["extensions"]["KHR_lights_punctual"]["lights"][0]


def triangles(document: dict) -> list[list[tuple[float, ...]]]:
    """Of the only mesh, where its node puts it, in glTF's axes."""
    data = base64.b64decode(document["buffers"][0]["uri"].split(",")[1])
    points, indices = document["accessors"][:2]
    floats = struct.unpack_from(f"<{3 * points['count']}f", data)
    order = struct.unpack_from(f"<{indices['count']}I", data, 12 * points["count"])
    m = document["nodes"][0]["matrix"]

    def placed(index):
        x, y, z = floats[3 * index:3 * index + 3]
        return tuple(m[row] * x + m[4 + row] * y + m[8 + row] * z + m[12 + row] for row in range(3))

    return [[placed(index) for index in order[i:i + 3]] for i in range(0, len(order), 3)]


def normal(triangle) -> tuple[float, ...]:
    """Of twice the area."""
    (a, b, c) = triangle
    p, q = [x - y for x, y in zip(b, a)], [x - y for x, y in zip(c, a)]
    return (p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0])


def length(vector) -> float:
    return math.sqrt(sum(value * value for value in vector))


def radiance(document: dict) -> float:
    material = document["materials"][0]
    strength = material["extensions"]["KHR_materials_emissive_strength"]["emissiveStrength"]
    return strength * material["emissiveFactor"][0]


class Lamps(unittest.TestCase):
    def test_point_without_size(self):
        light = punctual(exported(Lamp("a", "POINT", (0.5, 1, 2), 100, PLACE)))
        self.assertEqual(light["type"], "point")
        self.assertAlmostEqual(light["intensity"] * light["color"][1], 100 / (4 * math.pi))
        self.assertEqual(light["color"], [0.25, 0.5, 1])

    def test_sun_is_irradiance(self):
        light = punctual(exported(Lamp("a", "SUN", WHITE, 3, PLACE)))
        self.assertEqual((light["type"], light["intensity"]), ("directional", 3))

    def test_places_and_directions(self):
        node = exported(Lamp("a", "SUN", WHITE, 3, PLACE))["nodes"][0]
        self.assertEqual(node["matrix"][12:15], [1, 3, -2])
        self.assertEqual(node["matrix"][8:11], [0, 1, 0])  # its -z looks down

    def test_spot_without_blend_has_a_sharp_edge(self):
        spot = punctual(exported(Lamp("a", "SPOT", WHITE, 3, PLACE, cone=1.0)))["spot"]
        self.assertAlmostEqual(spot["outerConeAngle"], 0.5)
        self.assertAlmostEqual(spot["innerConeAngle"], 0.5)

    def test_spot_with_blend(self):
        spot = punctual(exported(Lamp("a", "SPOT", WHITE, 3, PLACE, cone=1.0, blend=0.5)))["spot"]
        self.assertAlmostEqual(spot["outerConeAngle"], 0.5)
        self.assertTrue(0 < spot["innerConeAngle"] < 0.5)

    def test_flat_lamps_have_their_radiance(self):
        for shape, size, area in (("SQUARE", (2, 9), 4), ("RECTANGLE", (2, 3), 6), ("DISK", (2, 9), math.pi),
                                  ("ELLIPSE", (2, 4), 2 * math.pi)):
            document = exported(Lamp("a", "AREA", WHITE, 100, PLACE, shape=shape, size=size))
            faces = [normal(triangle) for triangle in triangles(document)]
            self.assertAlmostEqual(sum(length(face) for face in faces) / 2, area, 4)
            self.assertAlmostEqual(radiance(document), 100 / (4 * area), 4)
            self.assertTrue(all(face[1] < 0 for face in faces), "a lamp shines along its -z, which is down")

    def test_scaled_lamp_keeps_its_power(self):
        scaled = [[value * (3 if column < 2 else 1) for column, value in enumerate(row)] for row in PLACE]
        document = exported(Lamp("a", "AREA", WHITE, 100, scaled, size=(2, 2)))
        self.assertAlmostEqual(radiance(document), 100 / (4 * 36), 5)

    def test_round_lamp_sends_its_watts_to_all_sides(self):
        document = exported(Lamp("a", "POINT", WHITE, 100, PLACE, radius=0.5))
        faces = triangles(document)
        surface = sum(length(normal(face)) for face in faces) / 2
        self.assertAlmostEqual(radiance(document) * math.pi * surface, 100, 3)
        self.assertTrue(0.94 < surface / math.pi < 1)
        for face in faces:
            outward = [sum(corner[axis] for corner in face) / 3 - (1, 3, -2)[axis] for axis in range(3)]
            self.assertGreater(sum(p * q for p, q in zip(outward, normal(face))), 0)

    def test_dark_lamps_are_left_out(self):
        self.assertNotIn("nodes", exported(Lamp("a", "POINT", WHITE, 0, PLACE), Lamp("b", "SUN", (0, 0, 0), 1, PLACE)))

    def test_lamps_of_a_kind_share_their_shape(self):
        document = exported(*[Lamp(name, "AREA", WHITE, 1, PLACE, size=(1, 1)) for name in "abc"])
        self.assertEqual((len(document["buffers"]), len(document["meshes"])), (1, 3))
