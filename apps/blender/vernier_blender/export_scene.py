# SPDX-License-Identifier: Apache-2.0
"""Writes what a scene shows at a frame as a .gltf for Vernier. Runs in the child process alone."""
from __future__ import annotations

import os

import bpy

from .collect import Collected, PlacedMesh
from .flat_lamps import radiance_of_watt
from .frame import Border, Frame, frame_of, lens_flags
from .gltf_file import GltfFile
from .lamps import add_lamps
from .materials import make_readable
from .motion import (Motion, MovingNode, add_shape_keys, animate, follow, moments_of, rolling_part, shapes_at,
                     shutter_of)
from .world import WorldPainter


class SceneExporter:
    """Answers requests for frames of one scene."""

    def __init__(self, scene: bpy.types.Scene):
        self._scene = scene
        self._world = WorldPainter(scene)
        self._border = _border(scene.render)
        self._notes = _notes_on_render(scene.render)
        self._stage = bpy.data.scenes.new("Vernier's stage")

    def export(self, request: dict) -> dict:
        """Writes the files of a frame; returns the scene's name and the flags that the picture needs."""
        frame, folder = request["frame"], request["folder"]
        shutter, render = shutter_of(self._scene), self._scene.render
        motion = Motion(render.fps / render.fps_base, shutter, moments_of(shutter, request["wants_vectors"]))
        collected = follow(self._scene, request["layer"], frame + request["subframe"], motion)
        if not collected.camera:
            raise ValueError(f"scene '{self._scene.name}' has no camera; add one, or make one active")
        notes = self._notes | make_readable(collected.materials())
        width, height = request["size"]
        view = frame_of(width, height, collected.camera.projection, self._border)
        path = os.path.join(folder, f"{request['name']}.gltf")
        placed, moving = self._write_meshes(collected, motion, path)
        has_flat_lamps = any(lamp.kind == "AREA" for lamp in collected.lamps)
        gltf = _completed(path, collected, view, radiance_of_watt(folder) if has_flat_lamps else 0)
        # Beside the objects that they show, those on the stage have names of their own.
        shown = [placed.get(name) for name in gltf.names_of_objects()]
        moves = len(motion.moments) > 1
        if moves:
            animate(gltf, motion, moving, collected.camera.name)
        gltf.rename_nodes({name: mesh.name for name, mesh in placed.items()})
        gltf.save()
        world = self._world.picture(folder, frame)
        flags = _flags(collected, view, world)
        if moves:
            flags += motion.flags(rolling_part(self._scene))
        return {"scene": path, "flags": flags,
                "part": [view.part_width, view.part_height],
                "pass_indices": [mesh.pass_index if mesh else 0 for mesh in shown],
                "notes": sorted(notes | collected.notes)}

    def _write_meshes(self, collected: Collected, motion: Motion,
                      path: str) -> tuple[dict[str, PlacedMesh], dict[str, MovingNode]]:
        """Puts the meshes on a stage of their own, each where it stands, and has the exporter write that. Returns
        them, and how they move, by their names in the file."""
        objects, by_name, moving = [], {}, {}
        for placed in collected.meshes:
            thing, moving_node = _stage_object(placed, motion, collected.notes)
            objects.append(thing)
            by_name[thing.name], moving[thing.name] = placed, moving_node
            self._stage.collection.objects.link(thing)
        try:
            bpy.context.window.scene = self._stage
            bpy.ops.export_scene.gltf(filepath=path, **_EXPORT)
        finally:
            bpy.context.window.scene = self._scene
            bpy.data.batch_remove({*objects, *(thing.data for thing in objects)})
        return by_name, moving


# Poses, modifiers and visibility are those of the meshes already; lamps and the camera are the add-on's own.
_EXPORT = {
    "export_format": "GLTF_SEPARATE", "use_active_scene": True, "export_yup": True, "export_apply": False,
    "export_animations": False, "export_skins": False, "export_morph": True, "export_morph_normal": True,
    "export_cameras": False,
    "export_lights": False, "export_extras": False, "export_draco_mesh_compression_enable": False}


def _stage_object(placed: PlacedMesh, motion: Motion, notes: set[str]) -> tuple[bpy.types.Object, MovingNode]:
    """Its mesh is sheared itself where no place, turn and scale do what the matrix does."""
    matrix = placed.matrix
    rest = type(matrix).LocRotScale(*matrix.decompose())
    size = max(max(abs(value) for value in row) for row in matrix)
    is_sheared = max(abs(a - b) for p, q in zip(matrix, rest) for a, b in zip(p, q)) > 1e-5 * size
    shapes = shapes_at(motion, placed, is_sheared, notes)
    thing = bpy.data.objects.new(placed.name, placed.mesh.copy() if is_sheared or shapes else placed.mesh)
    if is_sheared:
        thing.data.transform(matrix)
    else:
        thing.matrix_world = matrix
    if shapes:
        add_shape_keys(thing, shapes, motion.moments.index(0))
    return thing, MovingNode(None if is_sheared else motion.matrices(placed), bool(shapes))


def _completed(path: str, collected: Collected, view: Frame, watt: float) -> GltfFile:
    """Adds what the exporter does not know or does not keep."""
    camera = collected.camera
    gltf = GltfFile(path)
    gltf.remove_black_mirrors()
    gltf.make_glass_solid()
    add_lamps(collected.lamps, gltf, watt)
    entry = {"name": camera.name, **view.camera(camera.projection.is_orthographic)}
    gltf.add_node(camera.name, camera.matrix, {"camera": gltf.add("cameras", entry)})
    return gltf


def _flags(collected: Collected, view: Frame, world: str | None) -> list[str]:
    camera = collected.camera
    flags = view.flags() + ["--env", world or "none"]
    if camera.f_number:
        flags += lens_flags(view, camera.lens, camera.f_number, camera.focus)
    return flags


def _border(render) -> Border | None:
    if not render.use_border:
        return None
    return Border(render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y)


def _notes_on_render(render) -> set[str]:
    notes = set()
    if render.use_multiview:
        notes.add("there is no stereo: every view is that of the camera itself")
    return notes
