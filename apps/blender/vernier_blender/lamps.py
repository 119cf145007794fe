# SPDX-License-Identifier: Apache-2.0
"""Blender's lamps as glTF lights, of the brightness that Cycles gives them. Knows nothing of Blender.

glTF's exporter leaves out area lamps and takes all others for points, so the add-on writes lamps itself. Watts
are what a point or spot would shine to all sides together; for flat lamps see flat_lamps.py.
"""
from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

from .gltf_file import GltfFile

# Cycles blurs a cone's edge by t^2 (3 - 2t) over its width, glTF by t^2. Over the outer 0.76 of that width
# glTF's comes closest (least squares); it is 0.15 brighter at most.
_EDGE_PART = 0.76


@dataclass(frozen=True)
class Lamp:
    """One lamp where it stands; lengths in metres, angles in radians."""

    name: str
    kind: str  # POINT, SUN, SPOT, AREA
    color: tuple[float, float, float]
    energy: float  # watts, of a sun W/m^2
    matrix: list[list[float]]
    radius: float = 0.0
    cone: float = 0.0  # from edge to edge
    blend: float = 0.0
    shape: str = "SQUARE"  # SQUARE, RECTANGLE, DISK, ELLIPSE
    size: tuple[float, float] = (0.0, 0.0)


def add_lamps(lamps: list[Lamp], gltf: GltfFile, radiance_of_watt: float) -> None:
    """`radiance_of_watt`: of a flat lamp of one watt and one square metre."""
    shapes: dict[str, dict[str, int]] = {}

    def shape_of(kind: str) -> dict[str, int]:
        if kind not in shapes:
            shapes[kind] = gltf.add_shape(*_SHAPES[kind]())
        return shapes[kind]

    for lamp in lamps:
        if max(lamp.color) * lamp.energy <= 0:
            continue
        if lamp.kind == "AREA":
            shape = shape_of("disk" if lamp.shape in ("DISK", "ELLIPSE") else "square")
            _add_area(lamp, gltf, shape, radiance_of_watt)
        elif lamp.kind == "POINT" and lamp.radius > 0:
            _add_sphere(lamp, gltf, shape_of("sphere"))
        else:
            _add_punctual(lamp, gltf)


def _add_punctual(lamp: Lamp, gltf: GltfFile) -> None:
    kind = {"POINT": "point", "SUN": "directional", "SPOT": "spot"}[lamp.kind]
    brightest = max(lamp.color)
    intensity = brightest * (lamp.energy if lamp.kind == "SUN" else lamp.energy / (4 * math.pi))
    light = {"name": lamp.name, "type": kind, "color": [value / brightest for value in lamp.color],
             "intensity": intensity}
    if kind == "spot":
        light["spot"] = _cone(lamp)
    use = {"light": gltf.add_punctual_light(light)}
    gltf.add_node(lamp.name, _rigid(lamp.matrix), {"extensions": {"KHR_lights_punctual": use}})


def _cone(lamp: Lamp) -> dict[str, float]:
    outer = math.cos(min(lamp.cone / 2, math.pi / 2))
    inner = outer + _EDGE_PART * lamp.blend * (1 - outer)
    return {"innerConeAngle": math.acos(inner), "outerConeAngle": math.acos(outer)}


def _add_area(lamp: Lamp, gltf: GltfFile, shape: dict[str, int], radiance_of_watt: float) -> None:
    width, height = lamp.size
    if lamp.shape in ("SQUARE", "DISK"):
        height = width
    matrix = _scaled(lamp.matrix, (width, height, 1))
    area = _unit_area(lamp.shape) * _length(_cross(_column(matrix, 0), _column(matrix, 1)))
    if area > 0:
        _add_emitter(lamp, gltf, shape, matrix, radiance_of_watt * lamp.energy / area)


def _add_sphere(lamp: Lamp, gltf: GltfFile, shape: dict[str, int]) -> None:
    matrix = _scaled(_unrotated(lamp.matrix), (lamp.radius,) * 3)
    # A convex body shows a quarter of its surface on average: intensity is radiance times that.
    surface = lamp.radius ** 2 * _surface(*_SHAPES["sphere"]())
    _add_emitter(lamp, gltf, shape, matrix, lamp.energy / (math.pi * surface))


def _add_emitter(lamp: Lamp, gltf: GltfFile, shape: dict[str, int], matrix, radiance: float) -> None:
    material = gltf.add_emitter(lamp.name, [radiance * value for value in lamp.color])
    gltf.add_node(lamp.name, matrix, {"mesh": gltf.add_mesh(lamp.name, shape, material)})


# Shapes: points and triangles. Flat ones have a side or diameter of 1 and face -z, as lamps do.


def _square():
    points = [(-0.5, -0.5, 0.0), (0.5, -0.5, 0.0), (0.5, 0.5, 0.0), (-0.5, 0.5, 0.0)]
    return points, [(0, 2, 1), (0, 3, 2)]


_DISK_SIDES = 64


def _disk():
    """A polygon of the disk's area."""
    radius = math.sqrt(math.pi / 4 / (_DISK_SIDES / 2 * math.sin(2 * math.pi / _DISK_SIDES)))
    angles = [2 * math.pi * i / _DISK_SIDES for i in range(_DISK_SIDES)]
    points = [(radius * math.cos(angle), radius * math.sin(angle), 0.0) for angle in angles]
    return points, [(0, i + 1, i) for i in range(1, _DISK_SIDES - 1)]


@lru_cache(maxsize=None)
def _sphere():
    """An octahedron, each of its faces divided twice into four."""
    axes = [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (-1.0, 0.0, 0.0), (0.0, -1.0, 0.0)]
    top, bottom = (0.0, 0.0, 1.0), (0.0, 0.0, -1.0)
    faces = [(axes[i], axes[(i + 1) % 4], top) for i in range(4)]
    faces += [(axes[(i + 1) % 4], axes[i], bottom) for i in range(4)]
    for _ in range(2):
        faces = [part for face in faces for part in _divided(*face)]
    points = sorted({point for face in faces for point in face})
    places = {point: index for index, point in enumerate(points)}
    return points, [tuple(places[point] for point in face) for face in faces]


def _divided(a, b, c):
    ab, bc, ca = _between(a, b), _between(b, c), _between(c, a)
    return [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]


def _between(a, b):
    middle = [p + q for p, q in zip(a, b)]
    return tuple(value / _length(middle) for value in middle)


_SHAPES = {"square": _square, "disk": _disk, "sphere": _sphere}


def _unit_area(shape: str) -> float:
    return math.pi / 4 if shape in ("DISK", "ELLIPSE") else 1.0


def _surface(points, triangles) -> float:
    return sum(_length(_cross(_minus(points[b], points[a]), _minus(points[c], points[a]))) / 2
               for a, b, c in triangles)


def _column(matrix, index: int) -> list[float]:
    return [matrix[row][index] for row in range(3)]


def _minus(a, b) -> list[float]:
    return [p - q for p, q in zip(a, b)]


def _cross(a, b) -> list[float]:
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def _length(vector) -> float:
    return math.sqrt(sum(value * value for value in vector))


def _scaled(matrix, factors) -> list[list[float]]:
    return [[value * factor for value, factor in zip(row, (*factors, 1))] for row in matrix]


def _unrotated(matrix) -> list[list[float]]:
    """The place alone: Cycles scales no point lamp."""
    return [[float(row == column) for column in range(3)] + [matrix[row][3]] for row in range(4)]


def _rigid(matrix) -> list[list[float]]:
    """Without scale, which means nothing to a light without size."""
    lengths = [_length(_column(matrix, axis)) or 1.0 for axis in range(3)]
    return _scaled(matrix, [1 / length for length in lengths])
