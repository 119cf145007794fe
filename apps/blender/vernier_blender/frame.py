# SPDX-License-Identifier: Apache-2.0
"""The part of a camera's view that a picture is: size, border, shift of the lens. Knows nothing of Blender.

glTF cameras look straight ahead. A shifted lens sees a part of what a larger straight one would, so the larger
picture is asked for, cropped to that part; a border is a part of the part.
"""
from __future__ import annotations

import math
import struct
from dataclasses import dataclass


@dataclass(frozen=True)
class Projection:
    """How Blender's camera sees: half the width and height of the picture at unit distance, or in metres where
    it is orthographic, and where the picture's middle lies, in these halves, to the right and up."""

    half_width: float
    half_height: float
    shift_x: float = 0.0
    shift_y: float = 0.0
    is_orthographic: bool = False

    @staticmethod
    def of_matrix(matrix, is_orthographic: bool) -> "Projection":
        """Of a projection matrix as OpenGL has it."""
        column, sign = (3, -1) if is_orthographic else (2, 1)
        return Projection(1 / matrix[0][0], 1 / matrix[1][1], sign * matrix[0][column],
                          sign * matrix[1][column], is_orthographic)


@dataclass(frozen=True)
class Border:
    """Part of the picture, as fractions of it from its lower left."""

    left: float
    right: float
    bottom: float
    top: float


@dataclass(frozen=True)
class Frame:
    """What Vernier is asked for: a picture, and the part of it that is wanted, counted from the upper left."""

    width: int
    height: int
    part_x: int
    part_y: int
    part_width: int
    part_height: int
    half_width: float
    half_height: float

    def flags(self) -> list[str]:
        flags = ["--size", f"{self.width}x{self.height}"]
        if (self.part_width, self.part_height) != (self.width, self.height):
            flags += ["--crop", f"{self.part_width}x{self.part_height}+{self.part_x}+{self.part_y}"]
        return flags

    def camera(self, is_orthographic: bool) -> dict:
        """The glTF camera of the whole picture."""
        if is_orthographic:
            view = {"xmag": self.half_width, "ymag": self.half_height, "znear": 0, "zfar": 1000}
            return {"type": "orthographic", "orthographic": view}
        view = {"yfov": 2 * math.atan(self.half_height), "aspectRatio": self.half_width / self.half_height,
                "znear": 0.01}
        return {"type": "perspective", "perspective": view}


def frame_of(width: int, height: int, projection: Projection, border: Border | None) -> Frame:
    """The frame for a picture of that size. A shift is rounded to half a pixel."""
    right, up = round(projection.shift_x * width), round(projection.shift_y * height)
    whole_width, whole_height = width + abs(right), height + abs(up)
    x, y = max(right, 0), max(-up, 0)
    part = (x, y, width, height)
    if border:
        left, end = _pixels(border.left, width), _pixels(border.right, width)
        bottom, top = _pixels(border.bottom, height), _pixels(border.top, height)
        part = (x + left, y + height - top, max(end - left, 1), max(top - bottom, 1))
    return Frame(whole_width, whole_height, *part, projection.half_width * whole_width / width,
                 projection.half_height * whole_height / height)


def lens_flags(frame: Frame, focal_length: float, f_number: float, distance: float) -> list[str]:
    """Of a thin lens; the focal length in millimetres, the distance in metres."""
    sensor = 2 * focal_length * max(frame.half_width, frame.half_height)
    return ["--fstop", repr(f_number), "--focus", repr(distance), "--sensor", repr(sensor)]


def _pixels(fraction: float, size: int) -> int:
    """Blender multiplies in single precision and cuts off."""
    return int(_single(_single(fraction) * size))


def _single(value: float) -> float:
    return struct.unpack("f", struct.pack("f", value))[0]
