# SPDX-License-Identifier: Apache-2.0
"""Vernier's layers as Blender's passes: one line a pass."""
from __future__ import annotations

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


_PASSES = (
    Pass("Depth", "Z", "VALUE", "depth", lambda layer: layer.use_pass_z, _depth),
    Pass("Normal", "XYZ", "VECTOR", "normal", lambda layer: layer.use_pass_normal, _z_up("N")),
    Pass("Position", "XYZ", "VECTOR", "position", lambda layer: layer.use_pass_position, _z_up("P")),
    Pass("IndexOB", "X", "VALUE", "id", lambda layer: layer.use_pass_object_index, _planes("pass_index")),
    Pass("Denoising Albedo", "RGB", "COLOR", "albedo", lambda layer: layer.vernier.use_pass_albedo,
         _planes("albedo.R", "albedo.G", "albedo.B")),
    Pass("Debug Sample Count", "X", "VALUE", "samples", lambda layer: layer.vernier.use_pass_samples,
         _planes("samples")),
    Pass("Vernier Error", "RGB", "COLOR", "error", lambda layer: layer.vernier.use_pass_error,
         _planes("error.R", "error.G", "error.B")),
    Pass("Vernier Unreliable", "X", "VALUE", "error", lambda layer: layer.vernier.use_pass_error,
         _planes("error.unreliable")),
)


def wanted_passes(view_layer) -> list[Pass]:
    return [entry for entry in _PASSES if entry.is_wanted(view_layer)]


def add_pass_indices(planes: Planes, pass_indices: list[int]) -> None:
    """Blender's own numbers of the objects, whose ids count from 1."""
    if "id" in planes:
        planes["pass_index"] = numpy.array([0, *pass_indices], dtype=numpy.float32)[planes["id"].astype(int)]


def combined(planes: Planes) -> list[numpy.ndarray]:
    """The picture itself, opaque unless it says otherwise."""
    return [planes["R"], planes["G"], planes["B"], planes.get("A", numpy.ones_like(planes["R"]))]


def as_pixels(planes: list[numpy.ndarray]) -> numpy.ndarray:
    """As Blender stores a pass: pixel by pixel, the bottom line first."""
    return numpy.ascontiguousarray(numpy.stack(planes, axis=-1)[::-1], dtype=numpy.float32)
