# SPDX-License-Identifier: Apache-2.0
"""Vernier's layers as Blender's passes: one line a pass."""
from __future__ import annotations

import re
from dataclasses import dataclass
from typing import Callable

import numpy

Planes = dict[str, numpy.ndarray]
_FAR = 1e10  # Cycles' depth of nothing


@dataclass(frozen=True)
class Pass:
    name: str  # as Blender's compositor knows it
    channels: str  # a letter each
    kind: str  # VALUE, VECTOR, COLOR
    layer: str  # of `vernier render --aov`
    is_wanted: Callable  # of a view layer
    read: Callable[[Planes], list[numpy.ndarray]]  # a plane for each channel


def _z_up(prefix: str) -> Callable[[Planes], list[numpy.ndarray]]:
    return lambda planes: [planes[f"{prefix}.X"], -planes[f"{prefix}.Z"], planes[f"{prefix}.Y"]]


def _planes(*names: str) -> Callable[[Planes], list[numpy.ndarray]]:
    return lambda planes: [planes[name] for name in names]


def _depth(planes: Planes) -> list[numpy.ndarray]:
    return [numpy.where(numpy.isfinite(planes["Z"]), planes["Z"], _FAR)]


def _mattes(kind: str, property_name: str) -> tuple[Pass, ...]:
    """Cryptomatte's passes of a kind, each of two names a pixel and how much of it they cover."""
    layer = f"crypto_{kind.lower()}"
    return tuple(
        Pass(f"Crypto{kind}{rank:02d}", "RGBA", "COLOR", layer,
             lambda view_layer, first=2 * rank: (getattr(view_layer, property_name)
                                                 and view_layer.pass_cryptomatte_depth > first),
             _planes(*(f"Crypto{kind}{rank:02d}.{channel}" for channel in "rgba")))
        for rank in range(3))


_PASSES = (
    Pass("Depth", "Z", "VALUE", "depth", lambda layer: layer.use_pass_z, _depth),
    Pass("Normal", "XYZ", "VECTOR", "normal", lambda layer: layer.use_pass_normal, _z_up("N")),
    Pass("Position", "XYZ", "VECTOR", "position", lambda layer: layer.use_pass_position, _z_up("P")),
    Pass("Vector", "XYZW", "VECTOR", "motion", lambda layer: layer.use_pass_vector,
         _planes("Vector.X", "Vector.Y", "Vector.Z", "Vector.W")),
    Pass("IndexOB", "X", "VALUE", "id", lambda layer: layer.use_pass_object_index, _planes("pass_index")),
    Pass("Denoising Albedo", "RGB", "COLOR", "albedo", lambda layer: layer.vernier.use_pass_albedo,
         _planes("albedo.R", "albedo.G", "albedo.B")),
    Pass("Debug Sample Count", "X", "VALUE", "samples", lambda layer: layer.vernier.use_pass_samples,
         _planes("samples")),
    Pass("Vernier Error", "RGB", "COLOR", "error", lambda layer: layer.vernier.use_pass_error,
         _planes("error.R", "error.G", "error.B")),
    Pass("Vernier Unreliable", "X", "VALUE", "error", lambda layer: layer.vernier.use_pass_error,
         _planes("error.unreliable")),
    *_mattes("Object", "use_pass_cryptomatte_object"),
    *_mattes("Material", "use_pass_cryptomatte_material"),
    *_mattes("Asset", "use_pass_cryptomatte_asset"),
)


def wanted_passes(view_layer) -> list[Pass]:
    return [entry for entry in _PASSES if entry.is_wanted(view_layer)]


def add_pass_indices(planes: Planes, pass_indices: list[int]) -> None:
    """Blender's own numbers of the objects, whose ids count from 1."""
    if "id" in planes:
        planes["pass_index"] = numpy.array([0, *pass_indices], dtype=numpy.float32)[planes["id"].astype(int)]


def cryptomatte_fields(texts: dict[str, str], view_layer: str) -> dict[str, str]:
    """What a picture's header says of its mattes, for those of a view layer: the specification's key is seven digits of
    the hash of the whole name."""
    fields = {}
    for key, name in texts.items():
        match = re.fullmatch(r"(cryptomatte/[0-9a-f]{7}/)name", key)
        if not match:
            continue
        whole = f"{view_layer}.{name}"
        new = f"cryptomatte/{murmur3(whole.encode()):08x}"[:-1] + "/"
        fields.update({new + other[len(match[1]):]: text for other, text in texts.items()
                       if other.startswith(match[1])})
        fields[new + "name"] = whole
    return fields


def murmur3(data: bytes) -> int:
    """Cryptomatte's hash of names: MurmurHash3 for x86, 32 bits, seed 0 (Appleby 2011)."""

    def mixed(word: int) -> int:
        word = word * 0xCC9E2D51 & 0xFFFFFFFF
        return (word << 15 | word >> 17) * 0x1B873593 & 0xFFFFFFFF

    state = 0
    whole = len(data) // 4 * 4
    for at in range(0, whole, 4):
        state ^= mixed(int.from_bytes(data[at:at + 4], "little"))
        state = (state << 13 | state >> 19) * 5 + 0xE6546B64 & 0xFFFFFFFF
    state ^= mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        state = (state ^ state >> shift) * factor & 0xFFFFFFFF
    return state


def combined(planes: Planes) -> list[numpy.ndarray]:
    """The picture itself, opaque unless it says otherwise."""
    return [planes["R"], planes["G"], planes["B"], planes.get("A", numpy.ones_like(planes["R"]))]


def as_pixels(planes: list[numpy.ndarray]) -> numpy.ndarray:
    """As Blender stores a pass: pixel by pixel, the bottom line first."""
    return numpy.ascontiguousarray(numpy.stack(planes, axis=-1)[::-1], dtype=numpy.float32)
