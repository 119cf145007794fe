# SPDX-License-Identifier: Apache-2.0
"""Scenes of arrays as .glb files in memory, so that they are checked, fingerprinted and read as any other scene."""

from __future__ import annotations

import json
import struct
import zlib
from dataclasses import fields
from typing import Any, Iterable

import numpy as np
from numpy.typing import ArrayLike

from ._camera import Camera, matrix44
from ._errors import UsageError
from ._parts import Light, Material, Mesh

_ALPHA_MODES = ("OPAQUE", "MASK", "BLEND")
_EXTENSIONS = {
    "ior": ("KHR_materials_ior", "ior"),
    "specular": ("KHR_materials_specular", "specularFactor"),
    "specular_color": ("KHR_materials_specular", "specularColorFactor"),
    "transmission": ("KHR_materials_transmission", "transmissionFactor"),
    "thickness": ("KHR_materials_volume", "thicknessFactor"),
    "attenuation_distance": ("KHR_materials_volume", "attenuationDistance"),
    "attenuation_color": ("KHR_materials_volume", "attenuationColor"),
    "multiscatter_color": ("KHR_materials_volume_scatter", "multiscatterColor"),
    "scatter_anisotropy": ("KHR_materials_volume_scatter", "scatterAnisotropy"),
    "clearcoat": ("KHR_materials_clearcoat", "clearcoatFactor"),
    "clearcoat_roughness": ("KHR_materials_clearcoat", "clearcoatRoughnessFactor"),
    "sheen_color": ("KHR_materials_sheen", "sheenColorFactor"),
    "sheen_roughness": ("KHR_materials_sheen", "sheenRoughnessFactor"),
    "anisotropy": ("KHR_materials_anisotropy", "anisotropyStrength"),
    "anisotropy_rotation": ("KHR_materials_anisotropy", "anisotropyRotation"),
    "iridescence": ("KHR_materials_iridescence", "iridescenceFactor"),
    "iridescence_ior": ("KHR_materials_iridescence", "iridescenceIor"),
    "dispersion": ("KHR_materials_dispersion", "dispersion"),
    "diffuse_roughness": ("KHR_materials_diffuse_roughness", "diffuseRoughnessFactor"),
    "diffuse_transmission": ("KHR_materials_diffuse_transmission", "diffuseTransmissionFactor"),
    "diffuse_transmission_color": ("KHR_materials_diffuse_transmission", "diffuseTransmissionColorFactor"),
}


def _png(pixels: np.ndarray, what: str) -> bytes:
    """A PNG file of 8 bits a channel."""
    if pixels.dtype != np.uint8 or pixels.ndim != 3 or pixels.shape[2] not in (3, 4) or 0 in pixels.shape:
        raise UsageError(f"{what}: expected a uint8 array (height, width, 3 or 4), got {pixels.dtype} {pixels.shape}")
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # a row begins with its filter: none
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2 if channels == 3 else 6, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) +
            chunk(b"IEND", b""))


def _floats(value: ArrayLike, widths: tuple[int, ...], count: int | None, what: str) -> np.ndarray:
    """A finite float32 array (count, one of widths)."""
    array = np.ascontiguousarray(value, dtype=np.float32)
    width = " or ".join(map(str, widths))
    if array.ndim != 2 or array.shape[1] not in widths or len(array) == 0:
        raise UsageError(f"{what}: expected an array ({count or 'n'}, {width}), got {array.shape}")
    if count is not None and len(array) != count:
        raise UsageError(f"{what}: expected as many as positions, {count}, got {len(array)}")
    if not np.isfinite(array).all():
        raise UsageError(f"{what}: expected finite numbers; row {int(np.argmin(np.isfinite(array).all(1)))} has others")
    return array


def _indices(value: ArrayLike, count: int, what: str) -> np.ndarray:
    """A uint32 array of numbers below ``count``."""
    array = np.asarray(value)
    if array.ndim != 2 or array.shape[1] != 3 or not np.issubdtype(array.dtype, np.integer):
        raise UsageError(f"{what}: expected whole numbers (m, 3), got {array.dtype} {array.shape}")
    if len(array) == 0 or array.min() < 0 or array.max() >= count:
        found = f"{array.min()} to {array.max()}" if len(array) else "none"
        raise UsageError(f"{what}: expected numbers from 0 to {count - 1}, the positions, got {found}")
    return np.ascontiguousarray(array, dtype=np.uint32)


class _Writer:
    """A glTF document and its one buffer."""

    def __init__(self) -> None:
        self.json: dict[str, Any] = {"asset": {"version": "2.0", "generator": "vernier for Python"}, "scene": 0}
        self.parts: list[bytes] = []
        self.size = 0
        self.materials: dict[int, int] = {}

    def add(self, kind: str, value: dict[str, Any]) -> int:
        values = self.json.setdefault(kind, [])
        values.append(value)
        return len(values) - 1

    def view(self, data: bytes) -> int:
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": self.size, "byteLength": len(data)})
        padded = data + b"\0" * (-len(data) % 4)
        self.parts.append(padded)
        self.size += len(padded)
        return view

    def accessor(self, array: np.ndarray, kind: str, bounds: bool = False) -> int:
        component = 5125 if array.dtype == np.uint32 else 5126
        count = array.size if kind == "SCALAR" else len(array)
        value = {"bufferView": self.view(array.tobytes()), "componentType": component, "count": count, "type": kind}
        if bounds:
            value |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        return self.add("accessors", value)

    def texture(self, pixels: np.ndarray, what: str) -> dict[str, int]:
        image = self.add("images", {"bufferView": self.view(_png(pixels, what)), "mimeType": "image/png"})
        return {"index": self.add("textures", {"source": image})}

    def use(self, extension: str) -> None:
        used = self.json.setdefault("extensionsUsed", [])
        if extension not in used:
            used.append(extension)

    def material(self, material: Material) -> int:
        """Of meshes that share a material, the same."""
        if id(material) not in self.materials:
            self.materials[id(material)] = self.add("materials", self.material_json(material))
        return self.materials[id(material)]

    def material_json(self, material: Material) -> dict[str, Any]:
        if material.alpha_mode not in _ALPHA_MODES:
            raise UsageError(f"material '{material.name}', alpha_mode: expected one of {', '.join(_ALPHA_MODES)}, "
                             f"got {material.alpha_mode!r}")
        surface: dict[str, Any] = {
            "baseColorFactor": [float(v) for v in (*material.base_color, 1.0)[:4]],
            "metallicFactor": float(material.metallic),
            "roughnessFactor": float(material.roughness),
        }
        brightest = max(1.0, *map(float, material.emissive))
        value: dict[str, Any] = {
            "name": material.name,
            "pbrMetallicRoughness": surface,
            "emissiveFactor": [float(v) / brightest for v in material.emissive],
            "alphaMode": material.alpha_mode,
            "doubleSided": material.double_sided,
        }
        if material.alpha_mode == "MASK":
            value["alphaCutoff"] = float(material.alpha_cutoff)
        for place, key, pixels in ((surface, "baseColorTexture", material.base_color_texture),
                                   (surface, "metallicRoughnessTexture", material.metallic_roughness_texture),
                                   (value, "normalTexture", material.normal_texture),
                                   (value, "emissiveTexture", material.emissive_texture)):
            if pixels is not None:
                place[key] = self.texture(pixels, f"material '{material.name}', {key}")
        extensions: dict[str, dict[str, Any]] = {}
        if brightest > 1:
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": brightest}
        if material.unlit:
            extensions["KHR_materials_unlit"] = {}
        for attribute in fields(material):
            factor = getattr(material, attribute.name)
            if attribute.name in _EXTENSIONS and factor is not None:
                extension, key = _EXTENSIONS[attribute.name]
                number = float(factor) if np.ndim(factor) == 0 else [float(v) for v in factor]
                extensions.setdefault(extension, {})[key] = number
        for extension in extensions:
            self.use(extension)
        return value | ({"extensions": extensions} if extensions else {})

    def node(self, value: dict[str, Any], matrix: ArrayLike, what: str) -> None:
        node = self.add("nodes", value | {"matrix": matrix44(matrix, what).T.ravel().tolist()})
        self.json.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(node)

    def mesh(self, mesh: Mesh, what: str) -> None:
        positions = _floats(mesh.positions, (3,), None, f"{what}, positions")
        count = len(positions)
        attributes = {"POSITION": self.accessor(positions, "VEC3", bounds=True)}
        if mesh.normals is not None:
            normals = _floats(mesh.normals, (3,), count, f"{what}, normals")
            lengths = np.linalg.norm(normals, axis=1, keepdims=True)
            attributes["NORMAL"] = self.accessor(normals / np.where(lengths > 0, lengths, 1), "VEC3")
        if mesh.uvs is not None:
            attributes["TEXCOORD_0"] = self.accessor(_floats(mesh.uvs, (2,), count, f"{what}, uvs"), "VEC2")
        if mesh.colors is not None:
            colors = _floats(mesh.colors, (3, 4), count, f"{what}, colors")
            attributes["COLOR_0"] = self.accessor(colors, f"VEC{colors.shape[1]}")
        primitive: dict[str, Any] = {"attributes": attributes, "material": self.material(mesh.material)}
        if mesh.indices is not None:
            primitive["indices"] = self.accessor(_indices(mesh.indices, count, f"{what}, indices"), "SCALAR")
        elif count % 3 != 0:
            raise UsageError(f"{what}: {count} positions without indices are no triangles; expected three for each")
        number = self.add("meshes", {"name": mesh.name, "primitives": [primitive]})
        self.node({"mesh": number, "name": mesh.name}, mesh.matrix, f"{what}, matrix")

    def light(self, light: Light, what: str) -> None:
        value: dict[str, Any] = {"type": light.kind, "color": [float(v) for v in light.color],
                                 "intensity": float(light.intensity), "name": light.name}
        if light.kind == "spot":
            value["spot"] = {"innerConeAngle": float(light.inner_cone), "outerConeAngle": float(light.outer_cone)}
        self.use("KHR_lights_punctual")
        lights = self.json.setdefault("extensions", {}).setdefault("KHR_lights_punctual", {"lights": []})["lights"]
        lights.append(value)
        self.node({"extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}, "name": light.name},
                  light.matrix, f"{what}, matrix")

    def camera(self, camera: Camera, what: str) -> None:
        if camera.kind == "perspective":
            lens: dict[str, Any] = {"yfov": float(camera.yfov), "znear": 0.01}
            if camera.aspect > 0:
                lens["aspectRatio"] = float(camera.aspect)
        elif camera.kind == "orthographic" and camera.xmag is not None:
            lens = {"xmag": float(camera.xmag), "ymag": float(camera.ymag), "znear": 0.0, "zfar": 1e6}
        else:
            raise UsageError(f"{what}: expected a perspective or an orthographic camera with xmag; give others to render()")
        number = self.add("cameras", {"type": camera.kind, camera.kind: lens, "name": camera.name})
        self.node({"camera": number, "name": camera.name}, camera.matrix, f"{what}, matrix")

    def file(self) -> bytes:
        if self.size:
            self.json["buffers"] = [{"byteLength": self.size}]
        text = json.dumps(self.json, allow_nan=False).encode()
        text += b" " * (-len(text) % 4)
        chunks = [struct.pack("<I4s", len(text), b"JSON"), text]
        if self.size:
            chunks += [struct.pack("<I4s", self.size, b"BIN\0"), *self.parts]
        return struct.pack("<4sII", b"glTF", 2, 12 + sum(map(len, chunks))) + b"".join(chunks)


def glb(meshes: Iterable[Mesh], lights: Iterable[Light] = (), cameras: Iterable[Camera] = ()) -> bytes:
    """A .glb file of these, as ``load`` reads it and any other program does. Raises UsageError on arrays that are none."""
    writer = _Writer()
    for index, mesh in enumerate(meshes):
        if not isinstance(mesh, Mesh):
            raise UsageError(f"expected objects of vernier.Mesh, got {type(mesh).__name__}")
        writer.mesh(mesh, f"mesh {index}" + (f" '{mesh.name}'" if mesh.name else ""))
    for index, light in enumerate(lights):
        writer.light(light, f"light {index}")
    for index, camera in enumerate(cameras):
        writer.camera(camera, f"camera {index}")
    return writer.file()
