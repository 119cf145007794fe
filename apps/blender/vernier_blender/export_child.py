# SPDX-License-Identifier: Apache-2.0
"""The child process: a background Blender that loads a saved scene and exports frames of it on request.

It exists because Blender crashes when an operator, such as glTF's exporter, runs inside a render. Requests are
JSON objects, one a line of standard input; answers are lines of standard output that begin with MARK, among
whatever else Blender prints. It ends with its input.
"""
from __future__ import annotations

import json
import sys
import traceback

MARK = "vernier-export: "


def main() -> None:
    import bpy  # here, so that the parent may read MARK in a Blender that is not to be changed

    from .collect import NoteTaker
    from .export_scene import SceneExporter

    blend, scene_name = sys.argv[sys.argv.index("--") + 1:]
    bpy.utils.register_class(NoteTaker)
    exporter = SceneExporter(_load(bpy, blend, scene_name))
    for line in sys.stdin:
        try:
            answer = exporter.export(json.loads(line))
        except Exception as problem:  # told to the parent, which shows it
            traceback.print_exc()
            answer = {"error": str(problem) or type(problem).__name__}
        print(MARK + json.dumps(answer), flush=True)


def _load(bpy, blend: str, name: str):
    """The scene of that name, into an empty session, so that nothing is renamed."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.name = "Vernier's empty scene"
    with bpy.data.libraries.load(blend) as (there, here):
        here.scenes = [scene for scene in there.scenes if scene == name]
    scene = here.scenes[0]
    bpy.context.window.scene = scene
    return scene
