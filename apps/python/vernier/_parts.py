# SPDX-License-Identifier: Apache-2.0
"""What scenes of arrays are made of."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Sequence

import numpy as np
from numpy.typing import ArrayLike


@dataclass(eq=False)
class Material:
    """A glTF 2.0 material. Colors are scene-linear; what is None has glTF's default.

    ``metallic`` is 0 here unless it is said, while glTF files have 1. Textures are uint8 arrays (height, width, 3 or
    4), top row first, encoded as glTF says of each: base color, emission and sheen sRGB, others linear.
    """

    base_color: Sequence[float] = (1.0, 1.0, 1.0, 1.0)
    metallic: float = 0.0
    roughness: float = 1.0
    emissive: Sequence[float] = (0.0, 0.0, 0.0)
    """Radiance, W m^-2 sr^-1; may be above 1."""
    alpha_mode: str = "OPAQUE"
    alpha_cutoff: float = 0.5
    double_sided: bool = False
    base_color_texture: np.ndarray | None = None
    metallic_roughness_texture: np.ndarray | None = None
    """Green roughness, blue metallic."""
    normal_texture: np.ndarray | None = None
    emissive_texture: np.ndarray | None = None
    ior: float | None = None
    specular: float | None = None
    specular_color: Sequence[float] | None = None
    transmission: float | None = None
    thickness: float | None = None
    """Above 0: the mesh encloses a volume."""
    attenuation_distance: float | None = None
    """Metres."""
    attenuation_color: Sequence[float] | None = None
    multiscatter_color: Sequence[float] | None = None
    """Of a volume that scatters light: about its colour when it is thick."""
    scatter_anisotropy: float | None = None
    """Mean cosine of the deflection, in (-1, 1)."""
    clearcoat: float | None = None
    clearcoat_roughness: float | None = None
    sheen_color: Sequence[float] | None = None
    sheen_roughness: float | None = None
    anisotropy: float | None = None
    anisotropy_rotation: float | None = None
    """Radians."""
    iridescence: float | None = None
    iridescence_ior: float | None = None
    dispersion: float | None = None
    """20 over the Abbe number."""
    diffuse_roughness: float | None = None
    diffuse_transmission: float | None = None
    diffuse_transmission_color: Sequence[float] | None = None
    unlit: bool = False
    name: str = ""


@dataclass(eq=False)
class Mesh:
    """Triangles of one material, placed in the world.

    Attributes:
        positions: (n, 3), metres.
        indices: (m, 3) whole numbers below n, counter-clockwise seen from the front; None: each three positions.
        normals: (n, 3); None: flat shading.
        uvs: (n, 2), v downward as in glTF.
        colors: (n, 3 or 4), linear, multiplies the base color.
        matrix: (4, 4), mesh to world, points as columns.
    """

    positions: ArrayLike
    indices: ArrayLike | None = None
    normals: ArrayLike | None = None
    uvs: ArrayLike | None = None
    colors: ArrayLike | None = None
    material: Material = field(default_factory=Material)
    matrix: ArrayLike = field(default_factory=lambda: np.eye(4))
    name: str = ""


@dataclass(eq=False)
class Light:
    """A light of KHR_lights_punctual, which shines along the local -z of ``matrix`` (4, 4) where it has a direction.

    ``intensity`` is in W/sr for "point" and "spot", in W/m^2 for "directional"; cones are half angles in radians.
    """

    kind: str = "point"
    color: Sequence[float] = (1.0, 1.0, 1.0)
    intensity: float = 1.0
    matrix: ArrayLike = field(default_factory=lambda: np.eye(4))
    inner_cone: float = 0.0
    outer_cone: float = np.pi / 4
    name: str = ""
