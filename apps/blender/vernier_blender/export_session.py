# SPDX-License-Identifier: Apache-2.0
"""The parent's side of the export: saves the scene once, keeps the child process, asks it for frames."""
from __future__ import annotations

import collections
import json
import os
import shutil
import sys
import tempfile
from typing import Callable

import bpy

from .export_child import MARK
from .line_process import LineProcess

_LINES_TOLD = 8


class ExportError(Exception):
    """The scene cannot be exported; one line for people."""


class ExportSession:
    """A scene as it is now, and a child process that exports frames of it, all of an animation in one."""

    def __init__(self, scene: bpy.types.Scene, kept: str):
        self.scene_name = scene.name
        self._is_kept = bool(kept)
        self.folder = kept or tempfile.mkdtemp(prefix="vernier-", dir=bpy.app.tempdir)
        os.makedirs(self.folder, exist_ok=True)
        blend = os.path.join(self.folder, "scene.blend")
        # As data: no operator may run inside a render.
        bpy.data.libraries.write(blend, {scene}, path_remap="ABSOLUTE", fake_user=False)
        self._child = LineProcess(_command(blend, scene.name))

    def export(self, request: dict, should_stop: Callable[[], bool]) -> dict:
        """What the child answers. Raises ExportError or line_process.Stopped."""
        last: collections.deque[str] = collections.deque(maxlen=_LINES_TOLD)
        try:
            self._child.write(json.dumps({**request, "folder": self.folder}))
        except OSError:
            pass  # why it has ended is among its lines
        for line in self._child.lines(should_stop):
            if not line.startswith(MARK):
                last.append(line)
                continue
            answer = json.loads(line[len(MARK):])
            if "error" in answer:
                raise ExportError(f"export: {answer['error']}")
            return answer
        print("\n".join(last), file=sys.stderr)
        raise ExportError("export: the background Blender that writes the scene ended; its last lines are on "
                          "the terminal")

    def close(self) -> None:
        self._child.end()
        if not self._is_kept:
            shutil.rmtree(self.folder, ignore_errors=True)


def _command(blend: str, scene_name: str) -> list[str]:
    """Scripts in the file run in the child only if this Blender runs those of every file."""
    root, package = os.path.split(os.path.dirname(os.path.abspath(__file__)))
    code = (f"import sys; sys.path.insert(0, {root!r}); "
            f"from {package} import export_child; export_child.main()")
    if not bpy.app.binary_path:  # Blender as a Python module
        return [sys.executable, "-c", "import bpy; " + code, "--", blend, scene_name]
    trusts = bpy.context.preferences.filepaths.use_scripts_auto_execute
    return [bpy.app.binary_path, "--background", "--factory-startup",
            "--enable-autoexec" if trusts else "--disable-autoexec",
            "--python-exit-code", "1", "--python-expr", code, "--", blend, scene_name]


_session: ExportSession | None = None


def session_for(scene: bpy.types.Scene, kept: str) -> ExportSession:
    """The session of the render that goes on, begun if there is none."""
    global _session
    if _session and _session.scene_name != scene.name:
        end_session()
    if not _session:
        _session = ExportSession(scene, kept)
    return _session


@bpy.app.handlers.persistent
def end_session(*_) -> None:
    """When a render begins, so that it sees the scene as it is, and when one ends."""
    global _session
    session, _session = _session, None
    if session:
        session.close()


def register() -> None:
    for handlers in _handlers():
        handlers.append(end_session)


def unregister() -> None:
    end_session()
    for handlers in _handlers():
        handlers.remove(end_session)


def _handlers():
    return bpy.app.handlers.render_init, bpy.app.handlers.render_complete, bpy.app.handlers.render_cancel
