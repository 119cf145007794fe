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


if __name__ == "__main__":
    cornell_box()
    two_spheres()
    sphere_grid()
    layer_spheres()
