# SPDX-License-Identifier: Apache-2.0
"""Runs `vernier render` and follows what it tells (docs/progress.md)."""
from __future__ import annotations

import json
import os
import shlex
from dataclasses import dataclass, field
from typing import Callable

from .line_process import LineProcess, Stopped

_STOPPED_EARLY = 5  # exit code: a signal, and the picture so far is written
_PREVIEW_EVERY = "2s"


class RenderError(Exception):
    """The command failed; its own line, for people."""


@dataclass
class Outcome:
    """What is known at the end."""

    was_stopped: bool = False
    error: dict | None = None  # rel_rmse, low, high of the picture; none while unknown
    samples_per_pixel: float = 0
    notes: list[str] = field(default_factory=list)


def render_flags(settings, render, layers: list[str]) -> list[str]:
    """Those that the user's settings ask for; `settings` of the add-on, `render` of the scene."""
    flags = ["--integrator", settings.integrator, "--max-depth", str(settings.max_depth),
             "--filter", settings.pixel_filter, "--seed", str(settings.seed),
             "--adaptive", "on" if settings.use_adaptive else "off"]
    if settings.samples:
        flags += ["--spp", str(settings.samples)]
    if settings.time_limit:
        flags += ["--time", f"{settings.time_limit:g}s"]
    if settings.error:
        flags += ["--error", f"{settings.error:g}%"]
    if settings.denoiser != "none":
        flags += ["--denoise", settings.denoiser]
    if render.threads_mode == "FIXED":
        flags += ["--threads", str(render.threads)]
    if render.film_transparent:
        flags.append("--transparent")
    if layers:
        flags += ["--aov", ",".join(dict.fromkeys(layers))]
    try:
        return flags + shlex.split(settings.further_flags)
    except ValueError as problem:
        raise RenderError(f"Further Flags: {settings.further_flags}: {problem}") from problem


def run(program: str, scene: str, output: str, flags: list[str], watcher: "Watcher") -> Outcome:
    """Renders. Raises RenderError; where the watcher asks for an end, the picture so far is written."""
    command = [program, "render", scene, "-o", output, "--progress", "json",
               "--write-every", _PREVIEW_EVERY if watcher.on_preview else "never", *flags]
    process, follower = LineProcess(command), _Follower(watcher, output)
    try:
        for line in process.lines(watcher.should_stop):
            follower.follow(line)
    except Stopped:
        follower.outcome.was_stopped = True
        for line in process.finish():
            follower.follow(line)
    code = process.exit_code()
    if code == _STOPPED_EARLY:
        follower.outcome.was_stopped = True
    elif code and not follower.outcome.was_stopped:
        raise RenderError(follower.failure or f"vernier ended with exit code {code}: {follower.last_line}")
    return follower.outcome


@dataclass
class Watcher:
    """Who looks on."""

    should_stop: Callable[[], bool]
    on_progress: Callable[[float, str], None]  # fraction done, and how it stands
    on_preview: Callable[[], None] | None = None  # the picture so far is in the output


class _Follower:
    def __init__(self, watcher: Watcher, output: str):
        self._watcher = watcher
        self._output = output
        self._shown = self._written()
        self.outcome = Outcome()
        self.failure = self.last_line = ""

    def follow(self, line: str) -> None:
        self.last_line = line
        try:
            event = json.loads(line)
        except ValueError:
            return  # a library's own words, or the loader's
        kind = event.get("event")
        if kind == "progress":
            self._watcher.on_progress(event["fraction"], describe_state(event))
            self._look_at_picture()
        elif kind == "wrote":
            self.outcome.samples_per_pixel = event.get("samples_per_pixel", 0)
            self.outcome.error = event if event.get("rel_rmse") is not None else None
        elif kind in ("warning", "note"):
            self.outcome.notes.append(": ".join(filter(None, (event.get("place"), event["text"]))))
        elif kind == "failed":
            self.failure = event["text"]

    def _look_at_picture(self) -> None:
        """Pictures of a render that goes on replace the file without a word."""
        if self._watcher.on_preview and (written := self._written()) != self._shown:
            self._shown = written
            self._watcher.on_preview()

    def _written(self) -> int:
        try:
            return os.stat(self._output).st_mtime_ns
        except FileNotFoundError:
            return 0


def describe_state(event: dict) -> str:
    """'Error 1.23 % (1.2 to 1.26 %), 37 samples a pixel'"""
    samples = f"{event.get('samples_per_pixel', 0):.3g} samples a pixel"
    if event.get("rel_rmse") is None:
        return samples
    text = f"Error {percent(event['rel_rmse'])} %"
    if event.get("low") is not None and event.get("high") is not None:
        text += f" ({percent(event['low'])} to {percent(event['high'])} %)"
    return f"{text}, {samples}"


def percent(fraction: float) -> str:
    return f"{100 * fraction:.3g}"
