# SPDX-License-Identifier: Apache-2.0
"""Renders glTF scenes on the CPU and says how wrong each picture is.

    import vernier
    scene = vernier.load("scene.glb")
    image = vernier.render(scene, size=(640, 480), error=0.02)
    print(image.error)
    image.save("picture.exr")

Metres, right-handed, +y up; cameras look along -z; angles in radians; light is radiometric, scene-linear Rec.709.
docs/python.md of the project has more.
"""

from . import _core
from ._camera import Camera
from ._errors import Error, InputError, OutOfMemoryError, OutputError, UsageError
from ._glb import glb
from ._image import ErrorEstimate, Image, Missing, MissingFigure, compare, merge, read, to_display
from ._notices import Notice
from ._parts import Light, Material, Mesh
from ._render import LAYERS_FOR_DENOISING, Progress, Session, Settings, render
from ._scene import Feature, Fog, Scene, load

__version__: str = _core.version

__all__ = [
    "Camera", "Error", "ErrorEstimate", "Feature", "Fog", "Image", "InputError", "LAYERS_FOR_DENOISING", "Light",
    "Material", "Mesh", "Missing", "MissingFigure", "Notice", "OutOfMemoryError", "OutputError", "Progress", "Scene", "Session",
    "Settings", "UsageError", "compare", "glb", "load", "merge", "read", "render", "to_display",
]
