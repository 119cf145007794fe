# SPDX-License-Identifier: Apache-2.0
"""What moves about a frame, as a glTF animation. Runs in the child process alone.

Moments are frames before (negative) or after the one that is rendered, which is moment 0.
"""
from __future__ import annotations

import math
from dataclasses import dataclass, field

import bpy
import numpy
from mathutils import Matrix

from .collect import Collected, PlacedMesh, collect
from .gltf_file import GltfFile

_LEAD = 16  # frames of the animation before moment 0
_Y_UP = Matrix.Rotation(-math.pi / 2, 4, "X")


@dataclass
class Motion:
    """Of the things of one frame."""

    fps: float
    shutter: tuple[float, float] | None  # when it opens and closes
    moments: list[float]  # in order, 0 among them
    views: list = field(default_factory=list)  # the camera's matrix at each
    placed: dict[tuple, list[PlacedMesh]] = field(default_factory=dict)  # by key, at each
    vertices: dict[tuple, list[numpy.ndarray]] = field(default_factory=dict)  # likewise, in the mesh's space

    def matrices(self, placed: PlacedMesh) -> list[Matrix] | None:
        """At each moment, of what moves as a whole."""
        matrices = [other.matrix for other in self.placed.get(placed.key, [])]
        return matrices if any(matrix != matrices[0] for matrix in matrices[1:]) else None

    def flags(self, rolling: float) -> list[str]:
        """That the picture needs; `rolling` as rolling_part() gives it."""
        flags = ["--at", repr(_LEAD / self.fps), "--fps", repr(self.fps)]
        if self.shutter:
            flags += ["--shutter", ",".join(repr(frames / self.fps) for frames in self.shutter)]
        if self.shutter and rolling:
            flags += ["--shutter-shape", f"rolling:{rolling!r}"]
        return flags

    def seconds(self) -> list[float]:
        return [(_LEAD + moment) / self.fps for moment in self.moments]


def shutter_of(scene: bpy.types.Scene) -> tuple[float, float] | None:
    """When it opens and closes, in frames about the frame."""
    render = scene.render
    if not render.use_motion_blur:
        return None
    owner = render if hasattr(render, "motion_blur_position") else getattr(scene, "cycles", None)
    place = getattr(owner, "motion_blur_position", "CENTER")
    length = render.motion_blur_shutter
    start = {"START": 0.0, "CENTER": -length / 2, "END": -length}[place]
    return start, start + length


def rolling_part(scene: bpy.types.Scene) -> float:
    """Part of the shutter's time that a row is exposed; 0: all rows are throughout."""
    cycles = getattr(scene, "cycles", None)
    is_rolling = getattr(cycles, "rolling_shutter_type", "NONE") == "TOP"
    return getattr(cycles, "rolling_shutter_duration", 0.0) if is_rolling else 0.0


def moments_of(shutter: tuple[float, float] | None, wants_vectors: bool) -> list[float]:
    moments = {0.0} | ({-1.0, 1.0} if wants_vectors else set())
    if shutter:
        moments |= {shutter[0], sum(shutter) / 2, shutter[1]}
    return sorted(moments)


def follow(scene: bpy.types.Scene, layer: str, frame: float, motion: Motion) -> Collected:
    """Collects the scene at each moment; what moment 0 shows is returned, with the scene left there."""
    at = motion.moments.index(0)
    order = [i for i in range(len(motion.moments)) if i != at] + [at]
    shown = {}
    for i in order:
        time = frame + motion.moments[i]
        scene.frame_set(math.floor(time), subframe=time - math.floor(time))
        shown[i] = collect(scene, layer)
    now, count = shown[at], len(motion.moments)
    if count == 1:
        return now
    by_key = [{placed.key: placed for placed in shown[i].meshes} for i in range(count)]
    vertices: dict[bpy.types.Mesh, numpy.ndarray] = {}  # one array for all instances of a mesh
    for placed in now.meshes:
        if all(placed.key in others for others in by_key):
            motion.placed[placed.key] = [others[placed.key] for others in by_key]
            for other in motion.placed[placed.key]:
                if other.mesh not in vertices:
                    vertices[other.mesh] = _vertices(other.mesh)
            motion.vertices[placed.key] = [vertices[other.mesh] for other in motion.placed[placed.key]]
    # A marker may change the camera from one frame to the next: that is a cut, not a motion.
    cameras = [shown[i].camera for i in range(count)]
    motion.views = [(camera if camera and now.camera and camera.name == now.camera.name else now.camera).matrix
                    for camera in cameras] if now.camera else []
    places = [[lamp.matrix for lamp in shown[i].lamps] for i in range(count)]
    if motion.shutter and any(place != places[0] for place in places[1:]):
        now.notes.add("lamps stand still while the shutter is open")
    kept = {placed.mesh for placed in now.meshes}
    bpy.data.batch_remove({placed.mesh for i in order for placed in shown[i].meshes} - kept)
    return now


def _vertices(mesh: bpy.types.Mesh) -> numpy.ndarray:
    values = numpy.empty(3 * len(mesh.vertices), dtype=numpy.float32)
    mesh.vertices.foreach_get("co", values)
    return values.reshape(-1, 3)


def shapes_at(motion: Motion, placed: PlacedMesh, is_in_world: bool, notes: set[str]) -> list[numpy.ndarray] | None:
    """The vertices at each moment where a mesh changes its shape, in its own space or the world's; none where it
    does not, or has other vertices then."""
    shapes = motion.vertices.get(placed.key)
    if not shapes or len(shapes) < 2 or not len(shapes[0]):
        return None
    if len({len(shape) for shape in shapes}) > 1:
        notes.add(f"what has other vertices in other frames keeps its shape while the shutter is open: '{placed.name}'")
        return None
    if is_in_world:
        shapes = [shape @ numpy.array(other.matrix.to_3x3()).T + numpy.array(other.matrix.translation)
                  for shape, other in zip(shapes, motion.placed[placed.key])]
    size = max(float(numpy.ptp(shapes[0], axis=0).max()), 1e-9)
    return shapes if any(float(abs(shape - shapes[0]).max()) > 1e-6 * size for shape in shapes[1:]) else None


def add_shape_keys(thing: bpy.types.Object, shapes: list[numpy.ndarray], now: int) -> None:
    """Which the exporter writes as morph targets: one for each moment but `now`."""
    thing.shape_key_add(name="now", from_mix=False)
    for i, shape in enumerate(shapes):
        if i != now:
            thing.shape_key_add(name=str(i), from_mix=False).data.foreach_set(
                "co", numpy.ascontiguousarray(shape, dtype=numpy.float32).ravel())


@dataclass
class MovingNode:
    """A mesh of the file, by how it moves."""

    matrices: list[Matrix] | None = None  # at each moment; none: it stands still
    is_reshaped: bool = False  # by the morph targets of add_shape_keys()


def animate(gltf: GltfFile, motion: Motion, moving: dict[str, MovingNode], camera: str) -> None:
    """Adds the animation of the nodes of those names, and of the camera's."""
    animation = gltf.add_animation(motion.seconds())
    now, count = motion.moments.index(0), len(motion.moments)
    others = [i for i in range(count) if i != now]
    for index, node in enumerate(gltf.document["nodes"]):
        name = node.get("name", "")
        if "camera" in node and name == camera:
            animation.add_places(index, _places([_Y_UP @ Matrix(view) for view in motion.views]), now)
        elif "mesh" in node and name in moving:
            if moving[name].matrices:
                matrices = [_Y_UP @ matrix @ _Y_UP.inverted() for matrix in moving[name].matrices]
                animation.add_places(index, _places(matrices), now)
            if moving[name].is_reshaped:
                animation.add_weights(index, [[float(i == other) for other in others] for i in range(count)])


def _places(matrices: list[Matrix]) -> list[tuple]:
    """Translation, rotation (x, y, z, w) and scale of each, turned by the shorter way from one to the next."""
    places, last = [], None
    for matrix in matrices:
        translation, rotation, scale = matrix.decompose()
        if last is not None and rotation.dot(last) < 0:
            rotation.negate()
        last = rotation
        places.append((list(translation), [rotation.x, rotation.y, rotation.z, rotation.w], list(scale)))
    return places
