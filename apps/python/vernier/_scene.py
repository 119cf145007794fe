# SPDX-License-Identifier: Apache-2.0
"""Scenes: read from a file, bytes or arrays, and built once for many pictures."""

from __future__ import annotations

import difflib
import json
import os
import re
import threading
import weakref
from dataclasses import dataclass, field, replace
from typing import Any, Callable, Iterable, NamedTuple, Sequence, Union

import numpy as np

from . import _core
from ._camera import DEFAULT_YFOV, Camera, camera_from_settings
from ._errors import InputError, UsageError
from ._glb import glb
from ._notices import Notice, logged
from ._parts import Light, Mesh

EnvLike = Union[str, "os.PathLike[str]", np.ndarray, None]
SceneSource = Union[str, "os.PathLike[str]", bytes, bytearray, memoryview, Mesh, Iterable[Mesh]]


_NAMED = ("none", "studio", "sky")


class Feature(NamedTuple):
    """How a glTF feature of the file is honoured: "exact", "approximated" or "ignored", and why."""

    name: str
    status: str
    note: str


@dataclass(frozen=True)
class _Reading:
    """What is read of a file."""

    variant: str = ""
    time: float | None = None
    shutter: tuple[float, float] | None = None
    animation: str = ""
    strict: bool = False
    max_memory: int | None = None

    def __post_init__(self) -> None:
        most = self.max_memory
        if most is not None and (int(most) != most or not 1 <= most < 2**64):
            raise UsageError(f"max_memory: expected bytes, a whole number from 1 on, got {most}")


@dataclass(frozen=True)
class Fog:
    """What scatters light all over a scene, as ``--fog`` has it."""

    density: float
    """Per metre: part of the light that a short way takes, over its length."""
    albedo: tuple[float, float, float] = (1.0, 1.0, 1.0)
    """Part of it that is scattered rather than absorbed, 0 to 1, scene-linear; a number stands for all three."""
    anisotropy: float = 0.0
    """Mean cosine of the deflection, in (-1, 1)."""
    radius: float = 0.0
    """Metres, of the ball about the scene's center that it fills; 0: four times the scene's."""

    def __post_init__(self) -> None:
        albedo = np.broadcast_to(np.asarray(self.albedo, float), 3)  # which must be one number or three
        object.__setattr__(self, "albedo", tuple(map(float, albedo)))


class Kind(NamedTuple):
    """What a scene is built with."""

    ground: str = ""
    accelerator: str = ""
    fog: Fog | None = None


@dataclass(eq=False)
class _Slot:
    """A built scene, what is around it, and who renders it."""

    built: _core.BuiltScene
    kind: Kind
    around: object = None  # equal ones mean the same surroundings
    name: str = ""
    users: weakref.WeakSet[Any] = field(default_factory=weakref.WeakSet)


class Scene:
    """A scene that can be rendered; load() makes one. May be used by several threads and sessions at once.

    Attributes:
        source: the file, or what errors call it.
        hash: fingerprint of every byte that was read.
        cameras: those of the file that a picture can be taken with.
        objects: names of the mesh instances: the layer "id" holds 1 + their index.
        bounds: (2, 3) float32, metres: lower and upper corner of all there is; None: there is nothing.
        features, notices: how the file is honoured, and what came up when it was read and built.
        variants: names of the file's material variants.
    """

    def __init__(self, file: _core.SceneFile, file_lock: threading.Lock, reading: _Reading) -> None:
        self._file, self._file_lock, self._reading = file, file_lock, reading
        self._lock = threading.Lock()
        self._slots: list[_Slot] = []
        built = self._add_slot(Kind()).built
        self._cameras = [(camera_from_settings(settings), defect) for settings, defect in built.cameras]
        self.source: str = built.source
        self.hash: str = built.hash
        self.objects: list[str] = built.objects
        self.bounds = None if built.bounds is None else np.array(built.bounds, np.float32)
        self.features = [Feature(*feature) for feature in built.features]
        self.notices: list[Notice] = logged(built.notices)
        self.variants: list[str] = file.variants

    @property
    def cameras(self) -> list[Camera]:
        return [camera for camera, defect in self._cameras if not defect]

    def at(self, time: float | None = None, *, shutter: tuple[float, float] | None = None, animation: str | None = None,
           variant: str | None = None) -> Scene:
        """The same file at another time (seconds), with another shutter, by another animation, or in another material
        variant.

        What is told nothing of stays. Textures and what does not move are not read again.
        """
        old = self._reading
        reading = replace(old, time=old.time if time is None else time,
                          shutter=old.shutter if shutter is None else shutter,
                          variant=old.variant if variant is None else variant,
                          animation=old.animation if animation is None else animation)
        return Scene(self._file, self._file_lock, reading)

    def fitted_camera(self, size: tuple[int, int] = (640, 480), *, azimuth: float | None = None,
                      elevation: float | None = None, roll: float = 0.0, yfov: float = DEFAULT_YFOV,
                      orthographic: bool = False, margin: float = 0.08) -> Camera:
        """A camera that sees the scene whole in a picture of that width and height.

        Angles in radians: azimuth of the viewer about the scene, 0 on +z, toward +x; None: from the front right and a
        little above, what is flat from its face. ``margin``: part of the picture left free at either end.
        """
        settings = self._slots[0].built.fitted_camera(size[0] / size[1], azimuth, elevation, roll, yfov, orthographic,
                                                      margin)
        return camera_from_settings(settings)

    def _camera(self, wanted: Camera | int | str | None, size: tuple[int, int]) -> Camera:
        """The camera that is meant, as the command line means it: none, the first of the scene, else a fitted one."""
        if isinstance(wanted, Camera):
            return wanted
        if wanted is None:
            if not self._cameras:
                return self.fitted_camera(size)
            wanted = 0
        names = [camera.name for camera, _ in self._cameras]
        index = names.index(wanted) if wanted in names else wanted
        if not isinstance(index, int) or not 0 <= index < len(names):
            there = ", ".join(f"{i} ({name})" if name else str(i) for i, name in enumerate(names)) or "none"
            raise UsageError(f"unknown camera '{wanted}'; there are: {there}")
        camera, defect = self._cameras[index]
        if defect:
            raise InputError(defect)
        return camera if camera.name else replace(camera, name=str(index))

    def _build(self, kind: Kind) -> _core.BuiltScene:
        reading = self._reading
        with self._file_lock:
            built = _core.BuiltScene(self._file, reading.variant, reading.time, reading.shutter, reading.animation,
                                     reading.strict, int(reading.max_memory or 0), kind.ground, kind.accelerator)
        if fog := kind.fog:
            built.fill_air(fog.density, fog.albedo, fog.anisotropy, fog.radius)
        return built

    def _add_slot(self, kind: Kind) -> _Slot:
        slot = _Slot(self._build(kind), kind)
        self._slots.append(slot)
        return slot

    def _slot_with(self, kind: Kind, around: object) -> _Slot:
        """One that has these surroundings or may get them, since nobody renders it."""
        alike = [slot for slot in self._slots if slot.kind == kind]
        for slot in alike:
            if slot.around == around:
                return slot
        for slot in alike:
            if not slot.users:
                return slot
        return self._add_slot(kind)

    def _open(self, request: Request, threads: int, make: Callable[[_core.Session], Any]) -> Any:
        """A session of it: what ``make`` makes of one of libvernier."""
        with self._lock:
            around = request.env.key(request)
            slot = self._slot_with(request.kind, around)
            if slot.around != around:
                slot.around = None  # until it is there
                slot.name = request.env.put_around(slot.built, request)
                slot.around = around
            request.surroundings = slot.name
            session = make(_core.Session(slot.built, json.dumps(request.settings), threads))
            slot.users.add(session)
            return session

    def __repr__(self) -> str:
        return f"<vernier.Scene {self.source}: {len(self.objects)} objects, {len(self._cameras)} cameras>"


class Environment:
    """The surroundings that a render asks for."""

    def __init__(self, env: EnvLike, rotation: float, scale: float) -> None:
        self.env = env if env is None or isinstance(env, np.ndarray) else os.fspath(env)
        self.rotation, self.scale = float(rotation), float(scale)
        self._itself = object()
        if isinstance(self.env, np.ndarray):
            env = self.env
            if env.ndim != 3 or env.shape[2] != 3 or 0 in env.shape:
                raise UsageError(f"env: expected an array (height, width, 3), got shape {env.shape}")
        elif self.env is not None and self.env not in _NAMED and not re.search("[./]", self.env):
            self._refuse_word(self.env)
        elif self.env in (None, "none") and (self.rotation, self.scale) != (0, 1):
            raise UsageError("env_rotation and env_scale need env 'studio', 'sky', a file or an array")

    @staticmethod
    def _refuse_word(word: str) -> None:
        """A word that is neither a name nor a file is more likely a misspelt name."""
        if not os.path.exists(word):
            near = difflib.get_close_matches(word, _NAMED, 1)
            raise UsageError(f"env: '{word}' is no file and none of {', '.join(_NAMED)}" +
                             (f"; did you mean '{near[0]}'?" if near else ""))

    def key(self, request: Request) -> tuple[Any, ...]:
        """Equal for what gives the same surroundings."""
        seen = json.dumps([request.settings[part] for part in ("camera", "size")])
        if self.env is None:
            return ("own", request.shows_light, seen)
        if isinstance(self.env, np.ndarray):
            return (self._itself,)  # an array may have changed since the last render
        if self.env in _NAMED:
            return (self.env, self.rotation, self.scale, seen if self.env == "studio" else "")
        try:
            status = os.stat(self.env)
        except OSError:
            return (self.env,)  # reading it will say what is wrong
        return (self.env, status.st_mtime_ns, status.st_size, self.rotation, self.scale)

    def put_around(self, built: _core.BuiltScene, request: Request) -> str:
        """Returns what picture headers call it."""
        if self.env is None:
            return self._leave_or_light(built, request)
        if isinstance(self.env, np.ndarray):
            built.set_environment(_core.Environment.from_array(self.env, self.rotation, self.scale))
            return "array"
        if self.env == "none":
            built.set_environment(None)
        elif self.env in ("sky", "studio"):
            built.set_environment(_core.Environment.built_in(self.env, json.dumps(request.settings), self.rotation, self.scale))
        else:
            built.set_environment(_core.Environment.read(self.env, self.rotation, self.scale))
        return self.env

    @staticmethod
    def _leave_or_light(built: _core.BuiltScene, request: Request) -> str:
        """The file's own, or a studio where what the camera sees is dark without it."""
        own = built.own_environment
        settings = json.dumps(request.settings)
        built.set_environment(own)
        if not request.shows_light or not built.is_dark(settings):
            return "none" if own is None else "scene"
        built.set_environment(_core.Environment.built_in("studio", settings, 0.0, 1.0))
        request.notices += logged([("info", "", "the scene has no light that reaches what is seen; adding a studio "
                                    "around it, env='none' leaves it as it is")])
        return "studio"


@dataclass(eq=False)
class Request:
    """A picture that was asked for: settings as libvernier has them, and what goes around the scene."""

    settings: dict[str, Any]
    env: Environment
    kind: Kind
    camera: str
    notices: list[Notice] = field(default_factory=list)
    surroundings: str = ""

    @property
    def shows_light(self) -> bool:
        return bool(self.settings["integrator"] != "raycast")


def load(source: SceneSource, *, lights: Sequence[Light] = (), cameras: Sequence[Camera] = (), name: str = "",
         variant: str = "", time: float | None = None, shutter: tuple[float, float] | None = None, animation: str = "",
         strict: bool = False, allow_outside_files: bool = False, max_memory: int | None = None) -> Scene:
    """Reads a scene and builds what answers rays.

    Args:
        source: path of a .gltf or .glb file; the bytes of one that refers to no other files (trimesh gives them:
            ``mesh.export(file_type="glb")``); or a Mesh or several.
        lights, cameras: of a scene of meshes; files have their own.
        name: that errors call a scene of bytes or meshes.
        variant: of KHR_materials_variants, by name.
        time: seconds at which an animation poses the scene; None: at rest.
        shutter: seconds, from that time on, at which it opens and closes; what an animation moves meanwhile is blurred.
            None: everything stands still.
        animation: name, number or "all"; none: all when no two set the same thing, else the first.
        strict: raise InputError for anything that is not honoured exactly.
        allow_outside_files: the file may refer to others outside its folder.
        max_memory: bytes that the process may hold with the scene. Textures that do not fit are kept in a file in the
            folder of TMPDIR, or else /var/tmp, and read as rays meet them: the same picture, later. Pictures come on
            top (docs/textures.md). None: no limit.

    Raises:
        InputError: the scene cannot be used; the text names the file and the place in it.
        UsageError: arrays of wrong shapes or numbers, an unknown variant or animation.
        OutOfMemoryError: max_memory is too little to build the scene, whatever its textures are.
    """
    reading = _Reading(variant, time, shutter, animation, strict, max_memory)
    if isinstance(source, (str, os.PathLike)):
        file = _core.SceneFile(os.fspath(source), allow_outside_files)
    elif isinstance(source, (bytes, bytearray, memoryview)):
        file = _core.SceneFile.parse(name or "bytes", bytes(source))
    else:
        meshes = [source] if isinstance(source, Mesh) else source
        return load(glb(meshes, lights, cameras), name=name or "meshes", variant=variant, time=time, shutter=shutter,
                    animation=animation, strict=strict, max_memory=max_memory)
    if lights or cameras:
        raise UsageError("lights and cameras belong to scenes of meshes; a file has its own")
    return Scene(file, threading.Lock(), reading)
