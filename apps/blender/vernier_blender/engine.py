# SPDX-License-Identifier: Apache-2.0
"""The render engine as Blender sees it."""
from __future__ import annotations

import os
import pathlib
import time
import traceback

import bpy

from . import command
from .command import Outcome, RenderError, Watcher
from .exr import ExrError, read_picture
from .export_session import ExportError, session_for
from .line_process import Stopped
from .passes import Pass, add_pass_indices, as_pixels, combined, cryptomatte_fields, wanted_passes
from .settings import find_program


_SECONDS_BETWEEN_LINES = 2  # without a window, where each word on the state is a line


class VernierRenderEngine(bpy.types.RenderEngine):
    bl_idname = "VERNIER"
    bl_label = "Vernier"
    bl_use_preview = False
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False  # materials are those of Cycles and Eevee

    def render(self, depsgraph):
        try:
            _Picture(self, depsgraph).render()
        except Stopped:
            pass  # Blender has been told by the one who stopped it
        except (RenderError, ExportError, ExrError, OSError) as problem:
            self._fail(str(problem))
        except Exception as problem:  # Blender would crash
            traceback.print_exc()
            self._fail(f"fault of the add-on: {problem!r}; where it lies is on the terminal")

    def _fail(self, text: str) -> None:
        self.error_set(text)  # beside the picture
        self.report({"ERROR"}, text)  # to who called the operator

    def update_render_passes(self, scene=None, renderlayer=None):
        self.register_pass(scene, renderlayer, "Combined", 4, "RGBA", "COLOR")
        for entry in wanted_passes(renderlayer):
            self.register_pass(scene, renderlayer, entry.name, len(entry.channels), entry.channels, entry.kind)


class _Picture:
    """One view layer of one frame."""

    def __init__(self, engine: VernierRenderEngine, depsgraph):
        self._engine = engine
        self._scene: bpy.types.Scene = depsgraph.scene.original
        self._layer: bpy.types.ViewLayer = self._scene.view_layers[depsgraph.view_layer_eval.name]
        self._evaluated = depsgraph.scene_eval
        self._passes: list[Pass] = wanted_passes(self._layer)
        self._output = ""
        self._part = (0, 0)
        self._pass_indices: list[int] = []

    def render(self) -> None:
        program = find_program()
        if not program:
            raise RenderError("there is no program 'vernier'; install it, or name its file in the add-on's "
                              "preferences")
        settings = self._evaluated.vernier
        session = session_for(self._scene, bpy.path.abspath(settings.kept_folder))
        self._engine.update_stats("", "Exporting")
        request = self._request()
        exported = session.export(request, self._engine.test_break)
        self._tell(exported["notes"])
        self._part, self._pass_indices = tuple(exported["part"]), exported["pass_indices"]
        self._output = os.path.join(session.folder, request["name"] + ".exr")
        pathlib.Path(self._output).unlink(missing_ok=True)  # of an earlier render into a kept folder
        layers = [entry.layer for entry in self._passes]
        flags = exported["flags"] + command.render_flags(settings, self._evaluated.render, layers)
        outcome = command.run(program, exported["scene"], self._output, flags, self._watcher())
        self._show(outcome)

    def _request(self) -> dict:
        scene = self._evaluated
        render = scene.render
        size = [pixels * render.resolution_percentage // 100
                for pixels in (render.resolution_x, render.resolution_y)]
        name = f"{_file_name(self._layer.name)}_{scene.frame_current:04d}"
        return {"frame": scene.frame_current, "subframe": scene.frame_subframe, "layer": self._layer.name,
                "name": name, "size": size, "wants_vectors": self._layer.use_pass_vector}

    def _watcher(self) -> Watcher:
        told = 0.0

        def on_progress(fraction: float, text: str) -> None:
            nonlocal told
            if bpy.app.background and time.monotonic() - told < _SECONDS_BETWEEN_LINES:
                return
            told = time.monotonic()
            self._engine.update_progress(fraction)
            self._engine.update_stats("", text)

        return Watcher(self._engine.test_break, on_progress, None if bpy.app.background else self._preview)

    def _preview(self) -> None:
        """Shows the picture so far; its passes too, for the compositor's backdrop."""
        result = self._begin()
        self._fill(result)
        self._engine.end_result(result, do_merge_results=True)

    def _show(self, outcome: Outcome) -> None:
        if not os.path.exists(self._output):
            raise Stopped  # before there was a sample
        result = self._begin()
        texts = self._fill(result)
        state = {"samples_per_pixel": outcome.samples_per_pixel, **(outcome.error or {})}
        text = command.describe_state(state)
        self._engine.end_result(result)
        fields = {f"Vernier.{self._layer.name}": text, **cryptomatte_fields(texts, self._layer.name)}
        for name, value in fields.items():
            self._engine.get_result().stamp_data_add_field(name, value)
        # Blender forgets the state at the end; this stays in its status bar and log, or goes to the terminal.
        self._engine.report({"INFO"}, f"Vernier: {text}")
        self._tell(outcome.notes)

    def _begin(self):
        return self._engine.begin_result(0, 0, *self._part, layer=self._layer.name)

    def _fill(self, result) -> dict[str, str]:
        """Returns the texts of the picture's header."""
        planes, texts = read_picture(self._output)
        add_pass_indices(planes, self._pass_indices)
        passes = result.layers[0].passes
        _put(passes["Combined"], combined(planes))
        for entry in self._passes:
            if entry.name in passes:
                _put(passes[entry.name], entry.read(planes))
        return texts

    def _tell(self, notes: list[str]) -> None:
        for note in notes:
            self._engine.report({"WARNING"}, f"Vernier: {note}")


def _put(render_pass, planes) -> None:
    pixels = as_pixels(planes)
    try:
        render_pass.rect.foreach_set(pixels.ravel())
    except TypeError:  # older Blenders count pixels, not numbers
        render_pass.rect.foreach_set(pixels.reshape(-1, render_pass.channels))


def _file_name(text: str) -> str:
    return "".join(letter if letter.isalnum() else "_" for letter in text)


def register() -> None:
    bpy.utils.register_class(VernierRenderEngine)


def unregister() -> None:
    bpy.utils.unregister_class(VernierRenderEngine)
