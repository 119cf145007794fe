# SPDX-License-Identifier: Apache-2.0
"""Renders: at once, or in sessions that go on."""

from __future__ import annotations

import difflib
import json
import math
import os
from typing import Any, Callable, Mapping, NamedTuple, Sequence, TypedDict

from . import _core
from ._camera import Camera, settings_with
from ._errors import UsageError
from ._image import ErrorEstimate, Image
from ._notices import logged
from ._scene import EnvLike, Environment, Fog, Kind, Request, Scene

LAYERS_FOR_DENOISING: tuple[str, ...] = tuple(_core.layers_for_denoising.split(","))
"""Layers that Image.denoise() wants."""


class Settings(TypedDict, total=False):
    """All that a picture depends on beside its scene. The defaults are those of the command line, but for the size."""

    size: tuple[int, int]
    """Width and height, pixels (640, 480)."""
    camera: Camera | int | str | None
    """One of your own, or one of the scene's by number or name. None: the scene's first, else one that is fitted."""
    env: EnvLike
    """Surroundings: "studio", "sky", "none", a latitude-longitude picture by file or as an array (height, width, 3).
    None: the scene's own, and a studio where those leave it dark."""
    env_rotation: float
    """Radians counter-clockwise seen from above (0)."""
    env_scale: float
    """Multiplies the radiance of the surroundings (1)."""
    background: str | os.PathLike[str] | Sequence[float] | None
    """What the camera sees behind the scene, which does not light it: "transparent", three scene-linear numbers, or a
    picture file. None: the surroundings."""
    ground: str | None
    """Under the scene: "matte", a grey plane, or "shadow", of which only its shadow shows (None)."""
    fog: Fog | float | None
    """What fills the air and scatters light; a number is its density per metre (None: nothing)."""
    integrator: str
    """"path", "gradient", "light", "whitted" or "raycast" ("path")."""
    max_depth: int
    """Path vertices after the camera (16)."""
    caustics: str
    """path, gradient: what lamps cast by mirrors and bending glass, "auto", "on" or "off" ("auto")."""
    show: str
    """raycast: what is shown ("normal")."""
    ambient: float
    """whitted: constant ambient radiance (0.05)."""
    cutoff: float
    """whitted: rays that would bring less than this are not traced (0.001)."""
    accelerator: str
    """"embree", "bvh" or "list" (the quickest for the scene)."""
    filter: str
    """"box", "gaussian" or "blackman-harris", with ":WIDTH" in pixels if it is not to be the usual one ("box")."""
    texture_filter: str
    """Colours of textures: "none", read at points, or "mip", averaged over what a sample stands for, with ":WIDTH" in
    pixels if it is not to be 1: less noise, approximated ("none")."""
    crop: tuple[int, int, int, int] | None
    """x, y, width and height of the part of the picture that is rendered (None: all)."""
    row_exposure: float
    """Part of the shutter for which each row is exposed, the first from its opening on, the last until its closing (1)."""
    adaptive: bool
    """Spend samples where they lower the picture's error (True)."""
    seed: int
    """Of the random numbers (0)."""
    light_ways: Sequence[str]
    """Light that is kept apart by its way to the camera, as layers: "emission", "diffuse_direct", ... (none)."""
    light_groups: Mapping[str, Sequence[str]]
    """Light that is kept apart by its source, as layers light_NAME: names of lights, of nodes or materials that emit, or
    "environment", by the name of their group (none)."""


class Progress(NamedTuple):
    """How far a render is; ``fraction`` is of what was asked for, by the limit that is nearest."""

    seconds: float
    fraction: float
    samples_per_pixel: float
    samples: int
    rays: Mapping[str, int]
    error: ErrorEstimate | None


Observer = Callable[[Progress], Any]


def _whole(value: Any, what: str, least: int = 0) -> int:
    number = int(value)
    if number != value or number < least:
        raise UsageError(f"{what}: expected a whole number from {least} on, got {value}")
    return number


def _background(value: str | os.PathLike[str] | Sequence[float] | None) -> dict[str, Any]:
    result: dict[str, Any] = {"kind": "surroundings", "color": [0.0, 0.0, 0.0], "file": ""}
    if value is None:
        return result
    if isinstance(value, str) and value == "transparent":
        return result | {"kind": "transparent"}
    if isinstance(value, (str, os.PathLike)):
        return result | {"kind": "picture", "file": os.fspath(value)}
    color = [float(v) for v in value]
    if len(color) != 3 or not all(math.isfinite(v) for v in color):
        raise UsageError(f"background: expected 'transparent', three numbers or a picture file, got {value}")
    return result | {"kind": "color", "color": color}


def _fog(value: Fog | float | None) -> Fog | None:
    fog = value if isinstance(value, Fog) or value is None else Fog(float(value))
    return fog if fog and fog.density != 0 else None


def _request(scene: Scene, given: Settings) -> Request:
    """Raises UsageError on settings that there are not, or that cannot be."""
    for name in given:
        if name not in Settings.__annotations__:
            near = difflib.get_close_matches(name, Settings.__annotations__, 1)
            raise UsageError(f"unknown setting '{name}'" + (f"; did you mean '{near[0]}'?" if near else "") +
                             f" There are: {', '.join(Settings.__annotations__)}")
    width, height = (_whole(side, "size", 1) for side in given.get("size", (640, 480)))
    camera = scene._camera(given.get("camera"), (width, height))
    settings = settings_with(camera, width / height)
    settings |= {"size": [width, height], "background": _background(given.get("background"))}
    crop = given.get("crop")
    settings["crop"] = None if crop is None else [_whole(number, "crop") for number in crop]
    settings["seed"] = _whole(given.get("seed", 0), "seed")
    settings["max-depth"] = _whole(given.get("max_depth", settings["max-depth"]), "max_depth", 1)
    for name in ("filter", "integrator", "caustics", "show"):
        settings[name] = str(given.get(name, settings[name]))
    settings["texture-filter"] = str(given.get("texture_filter", settings["texture-filter"]))
    for name in ("ambient", "cutoff"):
        settings[name] = float(given.get(name, settings[name]))  # type: ignore[arg-type]
    settings["row-exposure"] = float(given.get("row_exposure", 1.0))
    settings["adaptive"] = bool(given.get("adaptive", True))
    groups = given.get("light_groups", {})
    settings["light-split"] = {"ways": [str(way) for way in given.get("light_ways", ())],
                               "groups": [{"name": name, "lights": list(lights)} for name, lights in groups.items()]}
    env = Environment(given.get("env"), given.get("env_rotation", 0.0), given.get("env_scale", 1.0))
    kind = Kind(given.get("ground") or "", str(given.get("accelerator", "")), _fog(given.get("fog")))
    return Request(settings, env, kind, camera.name)


class Session:
    """One picture of a scene, rendered until its limits, and further when they grow.

    The picture is the same to the bit for any number of threads, and wherever the render was stopped and gone on with.
    One call at a time; several sessions may run at once.
    """

    def __init__(self, scene: Scene, *, threads: int = 0, **settings: Any) -> None:
        """Settings are those of vernier.Settings. ``threads`` 0: as many as the machine has."""
        self._request = _request(scene, settings)  # type: ignore[arg-type]
        self._scene = scene
        self._reason = "interrupted"

        def keep(session: _core.Session) -> Session:
            self._session = session
            return self

        scene._open(self._request, _whole(threads, "threads"), keep)

    def run(self, *, spp: int | None = None, error: float | None = None, time: float | None = None,
            progress: Observer | None = None) -> str:
        """Goes on to the limits, which count from the beginning of the render, and returns what ended it.

        Args:
            spp: samples a pixel on average; 64 unless another limit is given.
            error: relative RMSE (0.01 is 1 %), once the end of its interval is at most a tenth above.
            time: seconds of rendering.
            progress: told a few times a second how far it is, on the calling thread. What it raises ends the run.

        Returns:
            "samples", "time" or "error".

        Ctrl-C ends it within about a tile and raises KeyboardInterrupt; image() then has the picture so far, and
        another run() goes on.
        """
        if spp is None:
            spp = 64 if error is None and time is None else 0
        self._reason = "interrupted"
        observe = None if progress is None else lambda state: progress(_progress(state))
        self._reason = self._session.run(_whole(spp, "spp"), math.inf if time is None else float(time),
                                         0.0 if error is None else float(error), observe)
        return self._reason

    def image(self, *, aov: str | Sequence[str] = ()) -> Image:
        """The picture so far, with the layers of these names ("all": every one; docs/layers.md), and light in parts."""
        request = self._request
        split = request.settings["light-split"]
        names = [aov] if isinstance(aov, str) else [*aov]
        names += split["ways"] + (["light_groups"] if split["groups"] else [])
        picture = self._session.picture(",".join(name for name in names if name))
        width, height = request.settings["size"]
        about = {"camera": request.camera, "surroundings": request.surroundings,
                 "integrator": request.settings["integrator"], "seed": request.settings["seed"],
                 "stopped_by": self._reason}
        picture.metadata = picture.metadata | {
            "vernier:scene": self._scene.source, "vernier:sceneHash": self._scene.hash, "vernier:camera": request.camera,
            "vernier:surroundings": request.surroundings, "vernier:integrator": request.settings["integrator"],
            "vernier:seed": str(request.settings["seed"]), "vernier:size": f"{width}x{height}",
            "vernier:stoppedBy": self._reason}
        return Image._of_render(picture, self._session.status, stats=about, notices=request.notices,
                                view="" if request.shows_light else "raw")

    @property
    def error(self) -> ErrorEstimate:
        """Of the picture so far."""
        return ErrorEstimate(**self._session.status["error"])

    @property
    def samples_per_pixel(self) -> float:
        return float(self._session.status["samples_per_pixel"])

    def save(self, path: str | os.PathLike[str]) -> None:
        """All that it takes to go on elsewhere; ``vernier render --resume`` takes it too (docs/resume.md)."""
        self._session.save(os.fspath(path))

    def load(self, path: str | os.PathLike[str]) -> None:
        """Goes on from such a file, of the same scene and settings. What may differ in last bits is logged."""
        warnings = self._session.load(os.fspath(path))
        self._request.notices += logged([("warning", "", text) for text in warnings])


def _progress(state: Mapping[str, Any]) -> Progress:
    error = state["error"]
    return Progress(**{**state, "error": None if error is None else ErrorEstimate(**error)})


def render(scene: Scene, *, spp: int | None = None, error: float | None = None, time: float | None = None,
           aov: str | Sequence[str] = (), denoise: str | None = None, progress: Observer | None = None,
           threads: int = 0, **settings: Any) -> Image:
    """Renders a picture.

    Args:
        scene: of load().
        spp, error, time: when to stop, whichever comes first: samples a pixel (64 unless another is given), relative
            RMSE, seconds.
        aov: layers, "all" or names: "albedo", "normal", "depth", "position", "id", "error", ... (docs/layers.md)
        denoise: a filter of ``vernier denoise``: "nlm", ...; the picture's error is then that after filtering.
        progress: see Session.run.
        threads: 0: as many as the machine has. The picture does not depend on it.
        settings: those of vernier.Settings: size, camera, env, background, integrator, seed, ...

    The same settings give the same picture as the command line, to the bit. Ctrl-C raises KeyboardInterrupt; a Session
    keeps what is there.
    """
    session = Session(scene, threads=threads, **settings)
    names = [aov] if isinstance(aov, str) else [*aov]
    session.run(spp=spp, error=error, time=time, progress=progress)
    image = session.image(aov=names if denoise is None else [*names, *LAYERS_FOR_DENOISING])
    return image if denoise is None else image.denoise(denoise)
