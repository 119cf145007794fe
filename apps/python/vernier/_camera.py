# SPDX-License-Identifier: Apache-2.0
"""Cameras, and the JSON of settings that they travel to libvernier in."""

from __future__ import annotations

import json
import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._errors import UsageError

DEFAULT_YFOV = math.radians(40)
"""Full vertical angle of a camera that nothing else is said of, radians."""


def matrix44(value: ArrayLike, what: str) -> np.ndarray:
    """A finite 4x4 matrix with 0 0 0 1 as its last row."""
    matrix = np.asarray(value, dtype=np.float64)
    if matrix.shape != (4, 4) or not np.isfinite(matrix).all() or not np.allclose(matrix[3], (0, 0, 0, 1)):
        raise UsageError(f"{what}: expected a finite 4x4 matrix whose last row is 0 0 0 1, got {matrix.tolist()}")
    return matrix


@dataclass(frozen=True, eq=False)
class Camera:
    """A camera as glTF has it: it looks along its local -z, +y is up in its picture.

    Attributes:
        matrix: (4, 4), camera to world, metres, points as columns: what trimesh and pyrender call a camera's pose.
            Its axes must be orthonormal.
        yfov: full vertical angle of a perspective camera, radians.
        kind: "perspective", "orthographic" or "panorama" (all around; latitude-longitude).
        aspect: width over height of what it shows; 0: the picture's. In a picture of another shape it shows more.
        ymag: half the height that an orthographic camera shows, metres; xmag: half its width, None: by the picture.
        lens_radius: of a thin lens, metres; 0: a pinhole, which shows all sharp.
        focus_distance: along the axis to the plane that the lens shows sharp, metres.
        moments: of one that moves while the shutter is open, where it is at 2, 3, 5 and so on to 33 evenly spaced moments
            from the opening to the closing, as ``matrix``, which is that of the middle; none: it stands still.
        name: that error messages and picture headers call it.
    """

    matrix: np.ndarray = field(default_factory=lambda: np.eye(4))
    yfov: float = DEFAULT_YFOV
    kind: str = "perspective"
    aspect: float = 0.0
    ymag: float = 1.0
    xmag: float | None = None
    lens_radius: float = 0.0
    focus_distance: float = 1.0
    name: str = ""
    moments: tuple[np.ndarray, ...] = ()

    def __post_init__(self) -> None:
        object.__setattr__(self, "matrix", matrix44(self.matrix, "camera matrix"))
        object.__setattr__(self, "moments", tuple(matrix44(moment, "camera moment") for moment in self.moments))
        for matrix in (self.matrix, *self.moments):
            axes = matrix[:3, :3]
            if not np.allclose(axes.T @ axes, np.eye(3), atol=1e-4):
                raise UsageError("camera matrix: expected orthonormal axes, without scale or shear")

    @staticmethod
    def look_at(eye: ArrayLike, target: ArrayLike, up: ArrayLike = (0, 1, 0), **rest: Any) -> Camera:
        """A camera at ``eye`` that looks at ``target``, ``up`` upward in its picture; three numbers each, metres."""
        at, to, upward = (np.asarray(v, dtype=np.float64) for v in (eye, target, up))
        back = at - to
        right = np.cross(upward, back)
        if not (np.linalg.norm(back) > 0 and np.linalg.norm(right) > 0):
            raise UsageError("look_at: expected a target away from the eye, not in the direction of up")
        z, x = back / np.linalg.norm(back), right / np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = x, np.cross(z, x), z, at
        return Camera(matrix, **rest)

    def _half_width(self, shape: float) -> float:
        if self.xmag is not None:
            return self.xmag
        return self.ymag * shape if self.kind == "orthographic" else 1.0

    def _to_json(self, shape: float) -> dict[str, Any]:
        """As settings hold it; ``shape`` is the picture's width over height."""
        moments = {"moments": [_columns(moment) for moment in self.moments]} if self.moments else {}
        return moments | {
            "name": self.name,
            "kind": self.kind,
            "yfov": float(self.yfov),
            "aspect": float(self.aspect),
            "xmag": float(self._half_width(shape)),
            "ymag": float(self.ymag),
            "lens_radius": float(self.lens_radius),
            "focus_distance": float(self.focus_distance) if math.isfinite(self.focus_distance) else None,
            "to_world": _columns(self.matrix),
        }


def _columns(matrix: np.ndarray) -> list[list[float]]:
    return [matrix[:3, column].tolist() for column in range(4)]


def _matrix(columns: list[list[float]]) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, :] = np.array(columns).T
    return matrix


def camera_from_settings(settings: str) -> Camera:
    """The camera of settings in JSON."""
    values = json.loads(settings)["camera"]
    matrix, moments = _matrix(values.pop("to_world")), tuple(_matrix(m) for m in values.pop("moments", []))
    focus = values.pop("focus_distance")
    return Camera(matrix=matrix, moments=moments, focus_distance=math.inf if focus is None else focus, **values)


def settings_with(camera: Camera, shape: float) -> dict[str, Any]:
    """Default settings with this camera."""
    settings: dict[str, Any] = json.loads(_core.default_settings)
    return settings | {"camera": camera._to_json(shape)}
