#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the glTF scenes of this folder: python3 tests/scenes/make_scenes.py

Everything is in metres. Each mesh has its own small buffer as a data URI, so that a scene is one file and its JSON
can be read and changed by hand.
"""

import base64
import json
import math
import pathlib
import re
import struct
import zlib

FOLDER = pathlib.Path(__file__).resolve().parent


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode("ascii")


class Scene:
    """A glTF document under construction."""

    def __init__(self, generator):
        self.json = {
            "asset": {"version": "2.0", "generator": generator},
            "scene": 0,
            "scenes": [{"nodes": []}],
            "nodes": [],
            "cameras": [],
            "materials": [],
            "meshes": [],
            "accessors": [],
            "bufferViews": [],
            "buffers": [],
        }

    def add(self, key, item):
        items = self.json.setdefault(key, [])
        items.append(item)
        return len(items) - 1

    def node(self, **fields):
        self.json["scenes"][0]["nodes"].append(self.add("nodes", fields))

    def use_extension(self, name):
        names = self.json.setdefault("extensionsUsed", [])
        if name not in names:
            names.append(name)

    def mesh(self, name, material, attributes, triangles):
        """attributes: {"POSITION": [(x, y, z), ...], ...}; triangles: [(a, b, c), ...]"""
        data = b""
        accessors = {}
        buffer = len(self.json["buffers"])

        def view(chunk, target):
            nonlocal data
            offset = len(data)
            data += chunk
            return self.add("bufferViews", {"buffer": buffer, "byteOffset": offset, "byteLength": len(chunk),
                                            "target": target})

        for semantic, values in attributes.items():
            values = [struct.unpack(f"<{len(v)}f", struct.pack(f"<{len(v)}f", *v)) for v in values]
            accessor = {"bufferView": view(b"".join(struct.pack(f"<{len(v)}f", *v) for v in values), 34962),
                        "componentType": 5126, "count": len(values), "type": f"VEC{len(values[0])}"}
            if semantic == "POSITION":
                accessor["min"] = [min(axis) for axis in zip(*values)]
                accessor["max"] = [max(axis) for axis in zip(*values)]
            accessors[semantic] = self.add("accessors", accessor)
        flat = [index for triangle in triangles for index in triangle]
        indices = self.add("accessors", {"bufferView": view(struct.pack(f"<{len(flat)}H", *flat), 34963),
                                         "componentType": 5123, "count": len(flat), "type": "SCALAR"})
        self.add("buffers", {"byteLength": len(data), "uri": data_uri("application/octet-stream", data)})
        return self.add("meshes", {"name": name, "primitives": [
            {"attributes": accessors, "indices": indices, "material": material}]})

    def with_material(self, mesh, name, material):
        """The same triangles once more, of another material."""
        primitive = {**self.json["meshes"][mesh]["primitives"][0], "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def write(self, name):
        text = json.dumps(self.json, indent=1)
        # Arrays of numbers on one line.
        text = re.sub(r"\[[-+.e\d\s,]+\]", lambda match: " ".join(match.group().split()), text)
        (FOLDER / name).write_text(text + "\n", encoding="ascii")


def quads(corners):
    """Positions and triangles of quadrilaterals given by their corners, counter-clockwise from the front."""
    positions = [corner for quad in corners for corner in quad]
    triangles = [t for i in range(0, len(positions), 4) for t in ((i, i + 1, i + 2), (i, i + 2, i + 3))]
    return positions, triangles


def matte(scene, name, color):
    return scene.add("materials", {"name": name, "pbrMetallicRoughness": {
        "baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": 1},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})


def glowing(scene, name, color, strength):
    return scene.add("materials", {
        "name": name, "emissiveFactor": color,
        "pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
        "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength},
                       "KHR_materials_specular": {"specularFactor": 0}}})


def cornell_box():
    """The Cornell box as measured: Cornell University Program of Computer Graphics, "Cornell Box Data", 1998.

    Reflectances and the light's radiance are Rec.709 stand-ins for the measured spectra.
    """
    scene = Scene("tests/scenes/make_scenes.py cornell_box")
    scene.use_extension("KHR_materials_specular")
    scene.use_extension("KHR_materials_emissive_strength")

    def millimetres(*rows):
        return [[tuple(value / 1000 for value in corner) for corner in quad] for quad in rows]

    white = matte(scene, "white", (0.725, 0.71, 0.68))
    red = matte(scene, "red", (0.63, 0.065, 0.05))
    green = matte(scene, "green", (0.14, 0.45, 0.091))
    light = glowing(scene, "light", [1, 0.705882, 0.235294], 17)

    parts = [
        ("floor", white, millimetres(
            [(552.8, 0, 0), (0, 0, 0), (0, 0, 559.2), (549.6, 0, 559.2)])),
        ("ceiling", white, millimetres(
            [(556, 548.8, 0), (556, 548.8, 559.2), (0, 548.8, 559.2), (0, 548.8, 0)])),
        ("back wall", white, millimetres(
            [(549.6, 0, 559.2), (0, 0, 559.2), (0, 548.8, 559.2), (556, 548.8, 559.2)])),
        ("right wall", green, millimetres(
            [(0, 0, 559.2), (0, 0, 0), (0, 548.8, 0), (0, 548.8, 559.2)])),
        ("left wall", red, millimetres(
            [(552.8, 0, 0), (549.6, 0, 559.2), (556, 548.8, 559.2), (556, 548.8, 0)])),
        ("short block", white, millimetres(
            [(130, 165, 65), (82, 165, 225), (240, 165, 272), (290, 165, 114)],
            [(290, 0, 114), (290, 165, 114), (240, 165, 272), (240, 0, 272)],
            [(130, 0, 65), (130, 165, 65), (290, 165, 114), (290, 0, 114)],
            [(82, 0, 225), (82, 165, 225), (130, 165, 65), (130, 0, 65)],
            [(240, 0, 272), (240, 165, 272), (82, 165, 225), (82, 0, 225)])),
        ("tall block", white, millimetres(
            [(423, 330, 247), (265, 330, 296), (314, 330, 456), (472, 330, 406)],
            [(423, 0, 247), (423, 330, 247), (472, 330, 406), (472, 0, 406)],
            [(472, 0, 406), (472, 330, 406), (314, 330, 456), (314, 0, 456)],
            [(314, 0, 456), (314, 330, 456), (265, 330, 296), (265, 0, 296)],
            [(265, 0, 296), (265, 330, 296), (423, 330, 247), (423, 0, 247)])),
        ("light", light, millimetres(  # a tenth of a millimetre below the ceiling
            [(343, 548.7, 227), (343, 548.7, 332), (213, 548.7, 332), (213, 548.7, 227)])),
    ]
    for name, material, corners in parts:
        positions, triangles = quads(corners)
        scene.node(name=name, mesh=scene.mesh(name, material, {"POSITION": positions}, triangles))

    # A 25 mm square of film behind a 35 mm lens, looking along +z.
    camera = scene.add("cameras", {"name": "front", "type": "perspective", "perspective": {
        "yfov": 2 * math.atan(12.5 / 35), "aspectRatio": 1, "znear": 0.01}})
    scene.node(name="camera", camera=camera, translation=[0.278, 0.273, -0.8], rotation=[0, 1, 0, 0])
    scene.write("cornell_box.gltf")


def png(rows):
    """An 8-bit grey PNG of the given rows of values."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    pixels = b"".join(b"\0" + bytes(row) for row in rows)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(pixels, 9)) + chunk(b"IEND", b"")


def sphere(slices, stacks):
    """Unit sphere about the origin: positions (which are its normals, too) and triangles."""
    points = []
    for stack in range(stacks + 1):
        polar = math.pi * stack / stacks
        for around in range(slices + 1):
            angle = 2 * math.pi * (around % slices) / slices
            points.append((math.sin(polar) * math.cos(angle), math.cos(polar), -math.sin(polar) * math.sin(angle)))
    triangles = []
    for stack in range(stacks):
        for around in range(slices):
            a = stack * (slices + 1) + around
            b = a + slices + 1
            if stack > 0:
                triangles.append((a, b, a + 1))
            if stack + 1 < stacks:
                triangles.append((a + 1, b, b + 1))
    return points, triangles


def two_spheres():
    """A glass and a mirror sphere over a chequered floor, after Whitted, "An improved illumination model for shaded
    display", 1980: all that recursive ray tracing is about, under a lamp and a sky."""
    scene = Scene("tests/scenes/make_scenes.py two_spheres")
    for name in ("KHR_materials_transmission", "KHR_materials_volume", "KHR_materials_ior", "KHR_materials_specular",
                 "KHR_materials_emissive_strength"):
        scene.use_extension(name)
    image = scene.add("images", {"name": "chequers", "uri": data_uri("image/png", png([[230, 60], [60, 230]]))})
    sampler = scene.add("samplers", {"magFilter": 9728, "minFilter": 9728, "wrapS": 10497, "wrapT": 10497})
    texture = scene.add("textures", {"source": image, "sampler": sampler})
    floor = scene.add("materials", {"name": "floor", "pbrMetallicRoughness": {
        "baseColorTexture": {"index": texture}, "metallicFactor": 0, "roughnessFactor": 1},
        "extensions": {"KHR_materials_specular": {"specularFactor": 0}}})
    glass = scene.add("materials", {"name": "glass", "pbrMetallicRoughness": {
        "metallicFactor": 0, "roughnessFactor": 0},
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1},
                       "KHR_materials_ior": {"ior": 1.5},
                       "KHR_materials_volume": {"thicknessFactor": 1, "attenuationDistance": 2,
                                                "attenuationColor": [0.7, 0.9, 0.8]}}})
    mirror = scene.add("materials", {"name": "mirror", "pbrMetallicRoughness": {
        "baseColorFactor": [0.9, 0.9, 0.9, 1], "metallicFactor": 1, "roughnessFactor": 0}})

    positions, triangles = quads([[(-8, 0, 8), (8, 0, 8), (8, 0, -8), (-8, 0, -8)]])
    texcoords = [(0, 8), (8, 8), (8, 0), (0, 0)]
    scene.node(name="floor", mesh=scene.mesh("floor", floor, {"POSITION": positions, "TEXCOORD_0": texcoords},
                                             triangles))
    points, triangles = sphere(48, 24)
    for name, material, centre, radius in (("glass sphere", glass, [0.1, 1.25, 1.2], 0.75),
                                           ("mirror sphere", mirror, [-0.9, 0.9, -0.9], 0.9)):
        mesh = scene.mesh(name, material, {"POSITION": points, "NORMAL": points}, triangles)
        scene.node(name=name, mesh=mesh, translation=centre, scale=[radius] * 3)

    positions, triangles = quads([[(1.5, 5, 1.5), (1.5, 5, 3), (3, 5, 3), (3, 5, 1.5)][::-1]])
    scene.node(name="lamp", mesh=scene.mesh("lamp", glowing(scene, "lamp", [1, 0.9, 0.75], 30),
                                            {"POSITION": positions}, triangles))
    points, triangles = sphere(16, 8)  # seen from inside
    scene.node(name="sky", mesh=scene.mesh("sky", glowing(scene, "sky", [0.25, 0.45, 0.8], 0.6), {"POSITION": points},
                                           [triangle[::-1] for triangle in triangles]), scale=[30] * 3)
    camera = scene.add("cameras", {"name": "front", "type": "perspective", "perspective": {
        "yfov": math.radians(36), "aspectRatio": 4 / 3, "znear": 0.1}})
    tilt = math.radians(-12)  # looking a little down
    scene.node(name="camera", camera=camera, translation=[0, 2.3, 6.5],
               rotation=[math.sin(tilt / 2), 0, 0, math.cos(tilt / 2)])
    scene.write("two_spheres.gltf")


def add_spheres(scene, materials, columns):
    """A row of spheres for every `columns` materials, from the top left, and a camera that sees them all."""
    points, triangles = sphere(64, 32)
    texcoords = [((i % 65) / 64, (i // 65) / 32) for i in range(len(points))]
    first = scene.mesh("sphere", materials[0], {"POSITION": points, "NORMAL": points, "TEXCOORD_0": texcoords},
                       triangles)
    rows = (len(materials) + columns - 1) // columns
    for i, material in enumerate(materials):
        name = scene.json["materials"][material]["name"]
        mesh = first if i == 0 else scene.with_material(first, name, material)
        scene.node(name=name, mesh=mesh, scale=[0.45] * 3,
                   translation=[i % columns - (columns - 1) / 2, (rows - 1) / 2 - i // columns, 0])
    yfov = math.radians(20)
    camera = scene.add("cameras", {"name": "front", "type": "perspective", "perspective": {
        "yfov": yfov, "aspectRatio": columns / rows, "znear": 0.1}})
    scene.node(name="camera", camera=camera, translation=[0, 0, (rows / 2 + 0.05) / math.tan(yfov / 2) + 0.45])


def sphere_grid():
    """Roughness 0 to 1 from left to right, metallic 0, 0.5 and 1 from top to bottom; to be lit by --env."""
    scene = Scene("tests/scenes/make_scenes.py sphere_grid")
    materials = [scene.add("materials", {"name": f"metallic {metallic}, roughness {roughness}",
                                         "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.4, 0.15, 1],
                                                                  "metallicFactor": metallic,
                                                                  "roughnessFactor": roughness}})
                 for metallic in (0, 0.5, 1) for roughness in (0, 0.25, 0.5, 0.75, 1)]
    add_spheres(scene, materials, 5)
    scene.write("sphere_grid.gltf")


def layer_spheres():
    """One sphere for each kind of layer and lobe that the KHR_materials extensions add; to be lit by --env."""
    scene = Scene("tests/scenes/make_scenes.py layer_spheres")
    red = [0.7, 0.05, 0.03, 1]

    def material(name, color, metallic, roughness, **extensions):
        names = {f"KHR_materials_{key}": value for key, value in extensions.items()}
        for key in names:
            scene.use_extension(key)
        return scene.add("materials", {"name": name, "pbrMetallicRoughness": {
            "baseColorFactor": color, "metallicFactor": metallic, "roughnessFactor": roughness},
            "extensions": names})

    solid = {"thicknessFactor": 1, "attenuationDistance": 1}
    add_spheres(scene, [
        material("clear coat", red, 0, 0.6, clearcoat={"clearcoatFactor": 1}),
        material("rough coat on metal", [0.9, 0.6, 0.2, 1], 1, 0.5,
                 clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.3}),
        material("sheen", [0.05, 0.03, 0.2, 1], 0, 0.9,
                 sheen={"sheenColorFactor": [0.9, 0.7, 0.6], "sheenRoughnessFactor": 0.4}),
        material("anisotropy", [0.8, 0.8, 0.8, 1], 1, 0.25, anisotropy={"anisotropyStrength": 0.8}),
        material("film on metal", [0.6, 0.6, 0.6, 1], 1, 0.15,
                 iridescence={"iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceThicknessMaximum": 380}),
        material("film on black plastic", [0.01, 0.01, 0.01, 1], 0, 0.1,
                 iridescence={"iridescenceFactor": 1, "iridescenceIor": 1.5, "iridescenceThicknessMaximum": 500},
                 ior={"ior": 2}),
        material("dispersion", [1, 1, 1, 1], 0, 0, transmission={"transmissionFactor": 1}, volume=solid,
                 ior={"ior": 1.7}, dispersion={"dispersion": 2}),
        material("leaf", [0.1, 0.5, 0.05, 1], 0, 0.5, diffuse_transmission={
            "diffuseTransmissionFactor": 0.7, "diffuseTransmissionColorFactor": [0.6, 0.9, 0.2]}),
        material("wax", [0.9, 0.8, 0.7, 1], 0, 0.4,
                 volume={"thicknessFactor": 1, "attenuationDistance": 0.3, "attenuationColor": [0.9, 0.5, 0.2]},
                 diffuse_transmission={"diffuseTransmissionFactor": 1}),
        material("rough thin glass", [0.6, 0.8, 1, 1], 0, 0.3, transmission={"transmissionFactor": 1})], 5)
    scene.write("layer_spheres.gltf")


def smooth(points, steps):
    """A Catmull-Rom curve (1974) through the points, with `steps` samples from each to the next."""
    if len(points) < 3:
        return points
    ends = [tuple(2 * a - b for a, b in zip(points[0], points[1])), *points,
            tuple(2 * a - b for a, b in zip(points[-1], points[-2]))]
    curve = []
    for p, q, r, s in zip(ends, ends[1:], ends[2:], ends[3:]):
        for step in range(steps):
            t = step / steps
            curve.append(tuple((2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t
                                + (3 * b - a - 3 * c + d) * t ** 3) / 2 for a, b, c, d in zip(p, q, r, s)))
    return [*curve, points[-1]]


def lathe(curves, slices=56, steps=5):
    """What a lathe turns about the y axis: positions, normals and triangles.

    curves: smooth parts of the profile as (radius, height), in the order in which the outside is on the right hand.
    """
    points, normals, triangles = [], [], []
    for control in curves:
        curve = [(max(0, radius), height) for radius, height in smooth(control, steps)]
        first = len(points)
        for i, (radius, height) in enumerate(curve):
            (r0, h0), (r1, h1) = curve[max(0, i - 1)], curve[min(len(curve) - 1, i + 1)]
            length = math.hypot(r1 - r0, h1 - h0)
            out, up = (h1 - h0) / length, (r0 - r1) / length
            for around in range(slices + 1):
                angle = 2 * math.pi * (around % slices) / slices
                points.append((radius * math.cos(angle), height, -radius * math.sin(angle)))
                normals.append((out * math.cos(angle), up, -out * math.sin(angle)))
        for row in range(len(curve) - 1):
            for around in range(slices):
                a = first + row * (slices + 1) + around
                b = a + slices + 1
                if curve[row][0] > 0:
                    triangles.append((a, a + 1, b))
                if curve[row + 1][0] > 0:
                    triangles.append((a + 1, b + 1, b))
    return points, normals, triangles


def turned(scene, name, material, curves, **options):
    points, normals, triangles = lathe(curves, **options)
    return scene.mesh(name, material, {"POSITION": points, "NORMAL": normals}, triangles)


def block(low, high):
    """The six sides of a box from one corner to the other."""
    (a, b, c), (d, e, f) = low, high
    return [[(a, b, f), (d, b, f), (d, e, f), (a, e, f)], [(d, b, c), (a, b, c), (a, e, c), (d, e, c)],
            [(a, b, c), (a, b, f), (a, e, f), (a, e, c)], [(d, b, f), (d, b, c), (d, e, c), (d, e, f)],
            [(a, e, f), (d, e, f), (d, e, c), (a, e, c)], [(a, b, c), (d, b, c), (d, b, f), (a, b, f)]]


class Tableware:
    """Things of the still life, in decimetres: materials and meshes, to be placed by their names."""

    GLASS_OUTSIDE = [(0.55, 0), (0.66, 0.05), (0.78, 0.5), (0.66, 1), (0.34, 1.5), (0.27, 1.85), (0.4, 2.3)]
    GLASS_INSIDE = [(0.36, 2.3), (0.23, 1.85), (0.3, 1.5), (0.61, 1), (0.73, 0.5), (0.6, 0.14), (0, 0.12)]
    # The water reaches into the glass by half of its wall, so that no air is left between the two.
    WATER = [(0, 0.1), (0.6, 0.12), (0.755, 0.5), (0.68, 0.85), (0.6, 1.02)]

    def __init__(self, scene):
        self.scene = scene
        glass = self.material("glass", [1, 1, 1], 0, ior={"ior": 1.5}, transmission={"transmissionFactor": 1},
                              volume={"thicknessFactor": 0.04, "attenuationDistance": 3,
                                      "attenuationColor": [0.75, 0.92, 0.85]})
        water = self.material("water", [1, 1, 1], 0, ior={"ior": 1.33}, transmission={"transmissionFactor": 1},
                              volume={"thicknessFactor": 1, "attenuationDistance": 4,
                                      "attenuationColor": [0.5, 0.85, 0.95]})
        glaze = self.material("glaze", [0.03, 0.11, 0.3], 0.6, clearcoat={"clearcoatFactor": 1,
                                                                         "clearcoatRoughnessFactor": 0.03})
        peel = self.material("peel", [0.95, 0.68, 0.05], 0.4)
        pearl = self.material("pearl", [0.75, 0.7, 0.68], 0.3, iridescence={
            "iridescenceFactor": 1, "iridescenceIor": 1.6, "iridescenceThicknessMaximum": 420})
        velvet = self.material("velvet", [0.25, 0.01, 0.06], 0.9, sheen={"sheenColorFactor": [0.9, 0.35, 0.45],
                                                                          "sheenRoughnessFactor": 0.35})
        gold = scene.add("materials", {"name": "gold", "pbrMetallicRoughness": {
            "baseColorFactor": [1, 0.77, 0.34, 1], "metallicFactor": 1, "roughnessFactor": 0.18}})
        self.meshes = {
            "carafe": turned(scene, "carafe", glass, [
                [(0, 0), (0.55, 0)], self.GLASS_OUTSIDE, [(0.4, 2.3), (0.36, 2.3)], self.GLASS_INSIDE]),
            "water": turned(scene, "water", water, [self.WATER, [(0.6, 1.02), (0, 1.02)]]),
            "bowl": turned(scene, "bowl", glaze, [
                [(0, 0), (0.45, 0)], [(0.45, 0), (0.44, 0.1), (0.8, 0.32), (1.12, 0.75)],
                [(1.12, 0.75), (1.09, 0.79), (1.04, 0.76)], [(1.04, 0.76), (0.74, 0.4), (0.3, 0.2), (0, 0.18)]]),
            "lemon": turned(scene, "lemon", peel, [
                [(0, -0.44), (0.07, -0.4), (0.22, -0.3), (0.31, 0), (0.22, 0.3), (0.07, 0.4), (0, 0.44)]], slices=32),
            "pearl": turned(scene, "pearl", pearl, [self.ball(0.2)], slices=40),
            "ball": turned(scene, "ball", gold, [self.ball(0.36)], slices=48),
            "cushion": turned(scene, "cushion", velvet, [
                [(0, 0.02), (0.45, 0), (0.62, 0.12), (0.45, 0.27), (0, 0.24)]])}

    @staticmethod
    def ball(radius):
        return [(radius * math.sin(math.pi * i / 8), radius * (1 - math.cos(math.pi * i / 8))) for i in range(9)]

    def material(self, name, color, roughness, **extensions):
        names = {f"KHR_materials_{key}": value for key, value in extensions.items()}
        for key in names:
            self.scene.use_extension(key)
        return self.scene.add("materials", {"name": name, "extensions": names, "pbrMetallicRoughness": {
            "baseColorFactor": [*color, 1], "metallicFactor": 0, "roughnessFactor": roughness}})

    def place(self, table, scale):
        """All of it about a point of the table."""
        half = math.sqrt(0.5)
        lying = {(0.62, 0.52, -0.32): (half, 0, 0, half), (0.95, 0.55, 0.12): (0, 0, half, half),
                 (0.35, 0.52, 0.12): (0.35, 0.25, 0.6, 0.67)}
        things = [("carafe", (-0.75, 0, -0.45), None), ("water", (-0.75, 0, -0.45), None),
                  ("bowl", (0.65, 0, -0.1), None), ("ball", (-0.25, 0, 0.75), None),
                  ("cushion", (-1.35, 0, 0.75), None), ("pearl", (-1.35, 0.24, 0.75), None),
                  *(("lemon", at, turn) for at, turn in lying.items()), ("lemon", (0.75, 0.31, 1.25), (0, 0.3, half, 0.64))]
        for name, at, turn in things:
            fields = {"name": name, "mesh": self.meshes[name], "scale": [scale] * 3,
                      "translation": [t + scale * a for t, a in zip(table, at)]}
            if turn:
                length = math.hypot(*turn)
                fields["rotation"] = [q / length for q in turn]
            self.scene.node(**fields)


def look_at(scene, name, eye, target, yfov, aspect):
    """A camera at `eye` that sees `target` in the middle; up is up."""
    camera = scene.add("cameras", {"name": name, "type": "perspective", "perspective": {
        "yfov": yfov, "aspectRatio": aspect, "znear": 0.01}})
    x, y, z = (t - e for t, e in zip(target, eye))
    yaw, pitch = math.atan2(-x, -z) / 2, math.atan2(y, math.hypot(x, z)) / 2
    scene.node(name=name, camera=camera, translation=list(eye), rotation=[
        math.cos(yaw) * math.sin(pitch), math.sin(yaw) * math.cos(pitch),
        -math.sin(yaw) * math.sin(pitch), math.cos(yaw) * math.cos(pitch)])


def still_life():
    """Glass, water, glaze, metal, velvet and peel before a backdrop; to be lit by a studio."""
    scene = Scene("tests/scenes/make_scenes.py still_life")
    scene.use_extension("KHR_materials_specular")
    ware = Tableware(scene)
    ware.place((0, 0, 0), 0.1)
    # From the table up into the wall without an edge.
    profile = smooth([(0.9, 0), (-0.15, 0), (-0.55, 0.08), (-0.75, 0.35), (-0.78, 0.9), (-0.78, 1.6)], 6)
    corners = [[(-2, y0, z0), (2, y0, z0), (2, y1, z1), (-2, y1, z1)]
               for (z0, y0), (z1, y1) in zip(profile, profile[1:])]
    positions, triangles = quads(corners)
    normals = []
    for i, (z, y) in enumerate(profile[:-1]):
        for j in (i, i, i + 1, i + 1):
            (z0, y0), (z1, y1) = profile[max(0, j - 1)], profile[min(len(profile) - 1, j + 1)]
            length = math.hypot(z1 - z0, y1 - y0)
            normals.append((0, (z0 - z1) / length, (y1 - y0) / length))
    backdrop = matte(scene, "backdrop", (0.55, 0.5, 0.45))
    scene.node(name="backdrop", mesh=scene.mesh("backdrop", backdrop, {"POSITION": positions, "NORMAL": normals},
                                                triangles))
    look_at(scene, "front", (0.08, 0.32, 0.86), (-0.01, 0.1, 0), math.radians(22), 16 / 9)
    scene.write("still_life.gltf")


def night_room():
    """A table under three lamps, a window on the evening and a mirror that sees both."""
    scene = Scene("tests/scenes/make_scenes.py night_room")
    for name in ("KHR_materials_specular", "KHR_materials_emissive_strength"):
        scene.use_extension(name)
    ware = Tableware(scene)

    planks, seed = [], 1
    for plank in range(8):  # each of its own shade, with a dark joint and a grain that a small generator draws
        seed = (seed * 16807) % 2147483647
        shade = 150 + seed % 90
        row = []
        for _ in range(64):
            seed = (seed * 16807) % 2147483647
            row.append(min(255, shade + seed % 14))
        planks += [[60] * 64, row, row, [max(0, v - 6) for v in row], row, row]
    image = scene.add("images", {"name": "planks", "uri": data_uri("image/png", png(planks))})
    texture = scene.add("textures", {"source": image})
    wood = scene.add("materials", {"name": "planks", "pbrMetallicRoughness": {
        "baseColorTexture": {"index": texture}, "baseColorFactor": [0.62, 0.36, 0.2, 1], "metallicFactor": 0,
        "roughnessFactor": 0.3}})
    oak = ware.material("oak", [0.3, 0.15, 0.06], 0.25)
    wall = matte(scene, "wall", (0.42, 0.5, 0.52))
    ceiling = matte(scene, "ceiling", (0.8, 0.78, 0.74))
    frame = ware.material("frame", [0.8, 0.78, 0.72], 0.4)
    mirror = scene.add("materials", {"name": "mirror", "pbrMetallicRoughness": {
        "baseColorFactor": [0.92, 0.92, 0.92, 1], "metallicFactor": 1, "roughnessFactor": 0}})
    pane = ware.material("pane", [1, 1, 1], 0, transmission={"transmissionFactor": 1})
    enamel = matte(scene, "enamel", (0.05, 0.05, 0.05))
    rug = ware.material("rug", [0.3, 0.06, 0.05], 0.95, sheen={"sheenColorFactor": [0.8, 0.4, 0.3],
                                                                "sheenRoughnessFactor": 0.5})
    lamp = glowing(scene, "lamp", [1, 0.62, 0.34], 80)
    evening = glowing(scene, "evening", [0.1, 0.2, 0.5], 2)

    def add(name, material, corners):
        positions, triangles = quads(corners)
        scene.node(name=name, mesh=scene.mesh(name, material, {"POSITION": positions}, triangles))

    # A room of 4 x 2.6 x 4.4 m; the window is in the wall behind the table.
    positions, triangles = quads([[(-2, 0, 2.2), (2, 0, 2.2), (2, 0, -2.2), (-2, 0, -2.2)]])
    scene.node(name="floor", mesh=scene.mesh("floor", wood, {
        "POSITION": positions, "TEXCOORD_0": [(0, 4.4), (4, 4.4), (4, 0), (0, 0)]}, triangles))
    add("ceiling", ceiling, [[(-2, 2.6, -2.2), (2, 2.6, -2.2), (2, 2.6, 2.2), (-2, 2.6, 2.2)]])
    left, right, low, high = 0.1, 1.5, 0.9, 2.1
    add("walls", wall, [
        [(-2, 0, 2.2), (-2, 0, -2.2), (-2, 2.6, -2.2), (-2, 2.6, 2.2)],
        [(2, 0, -2.2), (2, 0, 2.2), (2, 2.6, 2.2), (2, 2.6, -2.2)],
        [(2, 0, 2.2), (-2, 0, 2.2), (-2, 2.6, 2.2), (2, 2.6, 2.2)],
        [(-2, 0, -2.2), (left, 0, -2.2), (left, 2.6, -2.2), (-2, 2.6, -2.2)],
        [(right, 0, -2.2), (2, 0, -2.2), (2, 2.6, -2.2), (right, 2.6, -2.2)],
        [(left, 0, -2.2), (right, 0, -2.2), (right, low, -2.2), (left, low, -2.2)],
        [(left, high, -2.2), (right, high, -2.2), (right, 2.6, -2.2), (left, 2.6, -2.2)]])
    middle = (left + right) / 2
    bars = [((left, low, -2.26), (right, low + 0.05, -2.16)), ((left, high - 0.05, -2.26), (right, high, -2.16)),
            ((left, low, -2.26), (left + 0.05, high, -2.16)), ((right - 0.05, low, -2.26), (right, high, -2.16)),
            ((middle - 0.02, low, -2.24), (middle + 0.02, high, -2.18)),
            ((left - 0.06, low - 0.05, -2.2), (right + 0.06, low, -2.04))]
    add("window frame", frame, [side for bar in bars for side in block(*bar)])
    add("panes", pane, [[(left, low, -2.21), (right, low, -2.21), (right, high, -2.21), (left, high, -2.21)]])
    add("evening", evening, [[(-3, -1, -4), (4.5, -1, -4), (4.5, 4, -4), (-3, 4, -4)]])
    add("mirror", mirror, [[(-1.985, 1, 0.2), (-1.985, 1, -1), (-1.985, 2.1, -1), (-1.985, 2.1, 0.2)]])
    add("mirror frame", oak, [side for bar in (((-2, 0.94, -1.06), (-1.97, 1, 0.26)), ((-2, 2.1, -1.06), (-1.97, 2.16, 0.26)),
                                               ((-2, 1, -1.06), (-1.97, 2.1, -1)), ((-2, 1, 0.2), (-1.97, 2.1, 0.26)))
                              for side in block(*bar)])
    scene.node(name="table", mesh=turned(scene, "table", oak, [
        [(0, 0), (0.3, 0)], [(0.3, 0), (0.28, 0.03), (0.05, 0.08), (0.045, 0.4), (0.07, 0.68), (0.2, 0.72)],
        [(0.2, 0.72), (0.6, 0.72)], [(0.6, 0.72), (0.615, 0.735), (0.6, 0.75)], [(0.6, 0.75), (0, 0.75)]]),
        translation=[0, 0, -0.4])
    scene.node(name="rug", mesh=turned(scene, "rug", rug, [[(1.05, 0), (1.05, 0.012)], [(1.05, 0.012), (0, 0.012)]]),
               translation=[0, 0, -0.4])
    globe = turned(scene, "lamp", lamp, [Tableware.ball(0.085)], slices=24, steps=2)
    cap = turned(scene, "cap", enamel, [[(0.1, 0), (0.09, 0.05), (0.03, 0.08), (0.006, 0.1)],
                                       [(0.006, 0.1), (0.006, 1)]], slices=24)
    for x, y, z in ((-0.28, 1.5, -0.45), (0, 1.62, -0.3), (0.28, 1.54, -0.5)):
        scene.node(name="lamp", mesh=globe, translation=[x, y, z])
        scene.node(name="cap", mesh=cap, translation=[x, y + 0.1, z])
    ware.place((0, 0.75, -0.4), 0.16)
    look_at(scene, "door", (0.8, 1.38, 1.35), (-0.08, 1.1, -0.6), math.radians(45), 16 / 9)
    scene.write("night_room.gltf")


if __name__ == "__main__":
    cornell_box()
    two_spheres()
    sphere_grid()
    layer_spheres()
    still_life()
    night_room()
