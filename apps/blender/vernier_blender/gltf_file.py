# SPDX-License-Identifier: Apache-2.0
"""A .gltf that an exporter wrote, and what is added to it. Knows nothing of Blender.

Matrices are row by row, as lists of lists, and place things in Blender's world, whose +z is up.
"""
from __future__ import annotations

import base64
import json
import struct
from array import array

_FLOATS, _INDICES = 5126, 5125  # component types of accessors
_GENERATOR_NOTE = "lamps and camera by Vernier's add-on"


class GltfFile:
    def __init__(self, path: str):
        self._path = path
        with open(path, encoding="utf-8") as file:
            self.document = json.load(file)
        scenes = self.document.setdefault("scenes", [{}])
        self._scene = scenes[self.document.setdefault("scene", 0)]

    def save(self) -> None:
        asset = self.document.setdefault("asset", {"version": "2.0"})
        asset["generator"] = f"{asset.get('generator', '')}; {_GENERATOR_NOTE}".lstrip("; ")
        with open(self._path, "w", encoding="utf-8") as file:
            json.dump(self.document, file, indent=1)

    def names_of_objects(self) -> list[str]:
        """Of the nodes that show a mesh, once for each of its primitives, as Vernier numbers these."""
        nodes = [self.document["nodes"][index] for index in self._scene.get("nodes", [])]
        return [node.get("name", "") for node in nodes if "mesh" in node
                for _ in self.document["meshes"][node["mesh"]]["primitives"]]

    def rename_nodes(self, names: dict[str, str]) -> None:
        for node in self.document.get("nodes", []):
            if node.get("name") in names:
                node["name"] = names[node["name"]]

    def add(self, table: str, entry: dict) -> int:
        """Appends to one of the document's arrays; returns the entry's index."""
        entries = self.document.setdefault(table, [])
        entries.append(entry)
        return len(entries) - 1

    def add_node(self, name: str, matrix, content: dict) -> None:
        """Places a mesh, a camera or a light in the scene."""
        node = self.add("nodes", {"name": name, "matrix": _to_y_up(matrix), **content})
        self._scene.setdefault("nodes", []).append(node)

    def add_animation(self, seconds: list[float]) -> "Animation":
        return Animation(self, seconds)

    def add_floats(self, rows: list[list[float]], kind: str, has_bounds: bool = False) -> int:
        """An accessor of that type, a row of numbers an element."""
        values = array("f", [value for row in rows for value in row])
        uri = "data:application/octet-stream;base64," + base64.b64encode(
            struct.pack(f"<{len(values)}f", *values)).decode()
        buffer = self.add("buffers", {"byteLength": 4 * len(values), "uri": uri})
        view = self.add("bufferViews", {"buffer": buffer, "byteLength": 4 * len(values)})
        size = len(values) // len(rows)
        bounds = {"min": [min(values[i::size]) for i in range(size)],
                  "max": [max(values[i::size]) for i in range(size)]} if has_bounds else {}
        return self.add("accessors", {"bufferView": view, "componentType": _FLOATS, "type": kind,
                                      "count": len(rows), **bounds})

    def add_punctual_light(self, light: dict) -> int:
        lights = self._use("KHR_lights_punctual").setdefault("lights", [])
        lights.append(light)
        return len(lights) - 1

    def add_emitter(self, name: str, radiance: list[float]) -> int:
        """A material whose front gives light, and which is not there for other light, being a clear wall, nor for
        the camera."""
        strength = max(max(radiance), 1e-30)
        extensions = {"KHR_materials_emissive_strength": {"emissiveStrength": strength},
                      "KHR_materials_transmission": {"transmissionFactor": 1},
                      "KHR_materials_ior": {"ior": 1}}
        for extension in extensions:
            self._declare(extension)
        return self.add("materials", {
            "name": name,
            "emissiveFactor": [value / strength for value in radiance],
            "pbrMetallicRoughness": {"metallicFactor": 0, "roughnessFactor": 0},
            "extensions": extensions,
            "extras": {"vernier": {"hiddenFromCamera": True}}})

    def add_shape(self, points: list[tuple[float, ...]], triangles: list[tuple[int, ...]]) -> dict[str, int]:
        """Stores a shape; returns the primitive of a mesh that still lacks its material."""
        corners = array("f", [value for point in points for value in point])
        indices = array("I", [index for triangle in triangles for index in triangle])
        data = struct.pack(f"<{len(corners)}f{len(indices)}I", *corners, *indices)
        uri = "data:application/octet-stream;base64," + base64.b64encode(data).decode()
        buffer = self.add("buffers", {"byteLength": len(data), "uri": uri})
        size = 4 * len(corners)
        views = [self.add("bufferViews", {"buffer": buffer, "byteOffset": 0, "byteLength": size}),
                 self.add("bufferViews", {"buffer": buffer, "byteOffset": size, "byteLength": len(data) - size})]
        position = self.add("accessors", {
            "bufferView": views[0], "componentType": _FLOATS, "type": "VEC3", "count": len(points),
            "min": [min(corners[axis::3]) for axis in range(3)],
            "max": [max(corners[axis::3]) for axis in range(3)]})
        index = self.add("accessors", {
            "bufferView": views[1], "componentType": _INDICES, "type": "SCALAR", "count": len(indices)})
        return {"position": position, "indices": index}

    def add_mesh(self, name: str, shape: dict[str, int], material: int) -> int:
        primitive = {"attributes": {"POSITION": shape["position"]}, "indices": shape["indices"],
                     "material": material}
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def remove_black_mirrors(self) -> None:
        """Blender's specular of 0 mirrors nothing; the exporter makes a black colour of it, which still mirrors
        what is seen at grazing angles."""
        for material in self.document.get("materials", []):
            specular = material.get("extensions", {}).get("KHR_materials_specular", {})
            if specular.get("specularColorFactor") == [0, 0, 0]:
                specular["specularFactor"] = 0

    def make_glass_solid(self) -> None:
        """In Blender a closed surface that transmits is solid glass; glTF takes it for a bubble unless it says so."""
        for material in self.document.get("materials", []):
            extensions = material.get("extensions", {})
            if "KHR_materials_transmission" in extensions and "KHR_materials_volume" not in extensions:
                extensions["KHR_materials_volume"] = {"thicknessFactor": 1}
                self._declare("KHR_materials_volume")

    def _use(self, extension: str) -> dict:
        self._declare(extension)
        return self.document.setdefault("extensions", {}).setdefault(extension, {})

    def _declare(self, extension: str) -> None:
        used = self.document.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)


class Animation:
    """One of the file's, whose channels all have the same times."""

    def __init__(self, file: GltfFile, seconds: list[float]):
        self._file = file
        self._times = file.add_floats([[time] for time in seconds], "SCALAR", has_bounds=True)
        self._animation: dict = {"channels": [], "samplers": []}
        file.add("animations", self._animation)

    def add_places(self, node: int, places: list[tuple[list[float], list[float], list[float]]], now: int) -> None:
        """Translation, rotation and scale at each time; outside the animation the node is as at time `now`."""
        entry = self._file.document["nodes"][node]
        entry.pop("matrix", None)
        for part, (path, kind) in enumerate((("translation", "VEC3"), ("rotation", "VEC4"), ("scale", "VEC3"))):
            entry[path] = places[now][part]
            self._add(node, path, self._file.add_floats([place[part] for place in places], kind))

    def add_weights(self, node: int, rows: list[list[float]]) -> None:
        """Of the node's morph targets, at each time."""
        self._add(node, "weights", self._file.add_floats([[weight] for row in rows for weight in row], "SCALAR"))

    def _add(self, node: int, path: str, values: int) -> None:
        samplers = self._animation["samplers"]
        samplers.append({"input": self._times, "output": values, "interpolation": "LINEAR"})
        self._animation["channels"].append({"sampler": len(samplers) - 1, "target": {"node": node, "path": path}})


def _to_y_up(matrix) -> list[float]:
    """The matrix in glTF's world, whose +y is up, column by column."""
    x, y, z, w = ([float(value) for value in row] for row in matrix)
    rows = [x, z, [-value for value in y], w]
    return [rows[row][column] for column in range(4) for row in range(4)]
