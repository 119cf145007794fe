# SPDX-License-Identifier: Apache-2.0
"""A glTF scene as far as every renderer means the same by it: meshes of diffuse surfaces and rough metal, what glows evenly,
lamps, one perspective camera. Whatever else a scene has makes it not comparable; the first such thing is said."""
import json
import math
import pathlib
import struct

import numpy

COMPONENTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
KNOWN_EXTENSIONS = {"KHR_materials_emissive_strength", "KHR_materials_specular", "KHR_lights_punctual"}


class NotComparable(Exception):
    """What the scene has that renderers do not mean alike."""


class Scene:
    """`meshes`: dicts of positions, triangles, material, in the world; `lamps`: dicts of position and intensity in W/sr;
    `camera`: matrix to the world (it looks along -z) and vertical angle in degrees."""

    def __init__(self, path):
        self._folder = pathlib.Path(path).parent
        self._json, self._binary = _parts_of(path)
        self.meshes, self.lamps, self.camera = [], [], None
        for name in self._json.get("extensionsUsed", []):
            if name not in KNOWN_EXTENSIONS:
                raise NotComparable(name)
        if self._json.get("animations") or self._json.get("skins"):
            raise NotComparable("animation")
        self._buffers = [self._buffer(buffer) for buffer in self._json.get("buffers", [])]
        self._materials = [_material(material) for material in self._json.get("materials", [])]
        scene = self._json.get("scenes", [{}])[self._json.get("scene", 0)]
        for root in scene.get("nodes", []):
            self._add_node(root, numpy.eye(4))
        if not self.camera:
            raise NotComparable("no perspective camera")

    def _buffer(self, buffer):
        uri = buffer.get("uri")
        if uri is None:
            return self._binary
        if uri.startswith("data:"):
            raise NotComparable("a data URI")
        return (self._folder / uri).read_bytes()

    def _array(self, index):
        accessor = self._json["accessors"][index]
        if "bufferView" not in accessor or "sparse" in accessor:
            raise NotComparable("a sparse accessor")
        view, kind = self._json["bufferViews"][accessor["bufferView"]], numpy.dtype(TYPES[accessor["componentType"]])
        width = COMPONENTS[accessor["type"]]
        stride = view.get("byteStride", width * kind.itemsize)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return numpy.ndarray((accessor["count"], width), kind, self._buffers[view["buffer"]], start,
                             (stride, kind.itemsize))

    def _add_node(self, index, parent):
        node = self._json["nodes"][index]
        to_world = parent @ _matrix(node)
        if "mesh" in node:
            for primitive in self._json["meshes"][node["mesh"]]["primitives"]:
                self._add_primitive(primitive, to_world)
        camera = node.get("camera")
        if camera is not None and not self.camera and "perspective" in self._json["cameras"][camera]:
            yfov = self._json["cameras"][camera]["perspective"]["yfov"]
            self.camera = {"to_world": to_world.tolist(), "yfov": math.degrees(yfov)}
        lamp = node.get("extensions", {}).get("KHR_lights_punctual")
        if lamp:
            self._add_lamp(self._json["extensions"]["KHR_lights_punctual"]["lights"][lamp["light"]], to_world)
        for child in node.get("children", []):
            self._add_node(child, to_world)

    def _add_lamp(self, lamp, to_world):
        if lamp["type"] != "point" or "range" in lamp:
            raise NotComparable(f"a {lamp['type']} lamp, or one with a range")
        intensity = numpy.array(lamp.get("color", [1, 1, 1])) * lamp.get("intensity", 1)
        self.lamps.append({"position": to_world[:3, 3].tolist(), "intensity": intensity.tolist()})

    def _add_primitive(self, primitive, to_world):
        if primitive.get("mode", 4) != 4:
            raise NotComparable("points or lines")
        if "NORMAL" in primitive["attributes"]:
            raise NotComparable("smooth normals")
        if "COLOR_0" in primitive["attributes"]:
            raise NotComparable("vertex colors")
        local = self._array(primitive["attributes"]["POSITION"]).astype(numpy.float64)
        positions = local @ to_world[:3, :3].T + to_world[:3, 3]
        indices = numpy.arange(len(positions))
        if "indices" in primitive:
            indices = self._array(primitive["indices"]).astype(numpy.int64)
        triangles = indices.reshape(-1, 3)
        if numpy.linalg.det(to_world[:3, :3]) < 0:
            triangles = triangles[:, [0, 2, 1]]
        material = self._materials[primitive["material"]] if "material" in primitive else _material({})
        if max(material["emission"]) > 0 and material["two_sided"] and not _is_closed(positions, triangles):
            raise NotComparable("a light that shines to both sides")
        self.meshes.append({"positions": positions.astype(numpy.float32), "triangles": triangles.astype(numpy.uint32),
                            "material": material})


def _parts_of(path):
    data = pathlib.Path(path).read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data), b""
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[28 + length :]


def _matrix(node):
    if "matrix" in node:
        return numpy.array(node["matrix"], float).reshape(4, 4).T
    x, y, z, w = node.get("rotation", (0, 0, 0, 1))
    matrix = numpy.eye(4)
    matrix[:3, :3] = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                      [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                      [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    matrix[:3, :3] *= node.get("scale", (1, 1, 1))
    matrix[:3, 3] = node.get("translation", (0, 0, 0))
    return matrix


def _material(material):
    surface, extensions = material.get("pbrMetallicRoughness", {}), material.get("extensions", {})
    textures = [key for part in (material, surface) for key in part if key.endswith("Texture")]
    if textures:
        raise NotComparable(textures[0])
    if material.get("alphaMode", "OPAQUE") != "OPAQUE":
        raise NotComparable("alpha")
    metallic, specular = surface.get("metallicFactor", 1), extensions.get("KHR_materials_specular", {})
    if metallic not in (0, 1) or (metallic == 0 and specular.get("specularFactor", 1) != 0):
        raise NotComparable("a coat of specular reflection over diffuse (diffuse is metallicFactor 0, specularFactor 0)")
    strength = extensions.get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
    return {"color": surface.get("baseColorFactor", [1, 1, 1, 1])[:3], "is_metal": metallic == 1,
            "roughness": surface.get("roughnessFactor", 1), "two_sided": material.get("doubleSided", False),
            "emission": [strength * value for value in material.get("emissiveFactor", [0, 0, 0])]}


def _is_closed(positions, triangles):
    """By the sum of its areas as vectors, which is zero of a closed surface."""
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    areas = numpy.cross(b - a, c - a)
    return numpy.linalg.norm(areas.sum(0)) < 1e-3 * numpy.linalg.norm(areas, axis=1).sum()
