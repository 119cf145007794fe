# SPDX-License-Identifier: Apache-2.0
"""What a scene is made of when Blender renders it: meshes as they stand, lamps, the camera.

Only a render engine is given what a render shows (modifiers, particles, instances, and what is hidden, at their
settings for renders), so the child process renders the scene once by an engine that only takes notes.
"""
from __future__ import annotations

from dataclasses import dataclass, field

import bpy

from .frame import Projection
from .lamps import Lamp

_SURFACES = {"MESH", "CURVE", "SURFACE", "FONT", "META"}
_IGNORED = {"CURVES": "hair curves", "VOLUME": "volumes", "GPENCIL": "grease pencil strokes",
            "GREASEPENCIL": "grease pencil strokes", "POINTCLOUD": "point clouds"}


@dataclass
class CameraView:
    name: str
    matrix: list[list[float]]
    projection: Projection
    lens: float  # mm
    f_number: float | None  # none: everything is sharp
    focus: float  # metres


@dataclass
class PlacedMesh:
    name: str
    mesh: bpy.types.Mesh
    matrix: object  # mathutils.Matrix
    pass_index: int
    key: tuple  # the same in every frame


@dataclass
class Collected:
    """Everything that a render of the scene shows, as Blender data that outlive the render."""

    meshes: list[PlacedMesh] = field(default_factory=list)
    lamps: list[Lamp] = field(default_factory=list)
    camera: CameraView | None = None
    notes: set[str] = field(default_factory=set)

    def materials(self) -> set[bpy.types.Material]:
        return {material for placed in self.meshes for material in placed.mesh.materials if material}


class NoteTaker(bpy.types.RenderEngine):
    """The engine of the child process: fills `collected` in place of a picture."""

    bl_idname = "VERNIER_NOTE_TAKER"
    bl_label = "Vernier's exporter"
    collected = Collected()
    problem: Exception | None = None

    def render(self, depsgraph):
        try:
            _collect(depsgraph, NoteTaker.collected)
        except Exception as problem:  # Blender would only print it
            NoteTaker.problem = problem


def collect(scene: bpy.types.Scene, layer: str) -> Collected:
    """Of the frame that the scene is at."""
    NoteTaker.collected, NoteTaker.problem = Collected(), None
    for other in scene.view_layers:
        other.use = other.name == layer
    render = scene.render
    render.engine = NoteTaker.bl_idname
    render.use_compositing = render.use_sequencer = render.use_multiview = render.use_border = False
    bpy.ops.render.render(scene=scene.name)
    if NoteTaker.problem:
        raise NoteTaker.problem
    return NoteTaker.collected


def _collect(depsgraph, collected: Collected) -> None:
    known: dict[tuple, bpy.types.Mesh] = {}
    for instance in depsgraph.object_instances:
        thing = instance.object
        if thing.type == "LIGHT":
            if not getattr(getattr(thing.data, "cycles", None), "is_portal", False):
                collected.lamps.append(_lamp(thing, instance.matrix_world, collected.notes))
        elif thing.type in _IGNORED:
            collected.notes.add(f"{_IGNORED[thing.type]} are left out: '{thing.name}'")
        elif thing.type in _SURFACES and instance.show_self:
            mesh = _mesh(thing, depsgraph, known)
            if mesh.polygons:
                parent = instance.parent.name if instance.is_instance and instance.parent else ""
                key = (thing.name, parent, tuple(instance.persistent_id))
                collected.meshes.append(
                    PlacedMesh(thing.name, mesh, instance.matrix_world.copy(), thing.pass_index, key))
        _note_strands(thing, collected.notes)
    collected.camera = _camera(depsgraph, collected.notes)


def _mesh(thing, depsgraph, known):
    """The mesh of an object, one for all instances that share its shape and materials."""
    materials = tuple(slot.material.name_full if slot.material else "" for slot in thing.material_slots)
    key = (thing.type, thing.data.as_pointer(), materials)
    if key not in known:
        known[key] = bpy.data.meshes.new_from_object(thing, depsgraph=depsgraph)
    return known[key]


def _note_strands(thing, notes: set[str]) -> None:
    for system in getattr(thing, "particle_systems", []):
        if system.settings.type == "HAIR" and system.settings.render_type == "PATH":
            notes.add(f"hair is left out: '{thing.name}'")


def _lamp(thing, matrix, notes: set[str]) -> Lamp:
    light = thing.data
    factor = _emission(light, notes)
    lamp = {"name": thing.name, "kind": light.type, "energy": light.energy,
            "color": tuple(value * light_value for value, light_value in zip(factor, light.color)),
            "matrix": [list(row) for row in matrix]}
    if light.type in ("POINT", "SPOT"):
        lamp["radius"] = light.shadow_soft_size
    if light.type == "SPOT":
        lamp.update(cone=light.spot_size, blend=light.spot_blend)
    if light.type == "AREA":
        lamp.update(shape=light.shape, size=(light.size, light.size_y))
        if getattr(light, "spread", 4) < 3.14:
            notes.add(f"the spread of area lamps is left out, they shine to all sides: '{thing.name}'")
    return Lamp(**lamp)


def _emission(light, notes: set[str]) -> tuple[float, float, float]:
    """What the nodes of a lamp multiply its light by."""
    tree = light.node_tree if light.use_nodes else None
    output = tree.get_output_node("CYCLES") if tree else None
    if not output:
        return (1.0, 1.0, 1.0)
    links = output.inputs["Surface"].links
    node = links[0].from_node if links else None
    if not node or node.type != "EMISSION":
        notes.add(f"nodes of lamps other than Emission are left out: '{light.name}'")
        return (1.0, 1.0, 1.0)
    if node.inputs["Color"].is_linked or node.inputs["Strength"].is_linked:
        notes.add(f"what is linked to the Emission of a lamp is left out: '{light.name}'")
    strength = 1.0 if node.inputs["Strength"].is_linked else node.inputs["Strength"].default_value
    color = (1.0, 1.0, 1.0) if node.inputs["Color"].is_linked else node.inputs["Color"].default_value[:3]
    return tuple(strength * value for value in color)


def _camera(depsgraph, notes: set[str]) -> CameraView | None:
    scene = depsgraph.scene_eval
    if not scene.camera:
        return None
    thing = scene.camera.evaluated_get(depsgraph)
    camera, render = thing.data, scene.render
    if camera.type not in ("PERSP", "ORTHO"):
        raise ValueError(f"the camera '{thing.name}' is a panorama, which the add-on does not export; "
                         "expected perspective or orthographic")
    if render.pixel_aspect_x != render.pixel_aspect_y:
        notes.add("pixels that are not square are rendered as square ones")
    matrix = thing.calc_matrix_camera(
        depsgraph, x=render.resolution_x, y=render.resolution_y,
        scale_x=render.pixel_aspect_x, scale_y=render.pixel_aspect_y)
    is_orthographic = camera.type == "ORTHO"
    f_number = camera.dof.aperture_fstop if camera.dof.use_dof else None
    if f_number and is_orthographic:
        notes.add("an orthographic camera sees everything sharp: its depth of field is left out")
        f_number = None
    if f_number and (camera.dof.aperture_blades > 0 or camera.dof.aperture_ratio != 1):
        notes.add("the opening of the lens is round: its blades and ratio are left out")
    return CameraView(thing.name, [list(row) for row in thing.matrix_world.normalized()],
                      Projection.of_matrix(matrix, is_orthographic), camera.lens, f_number,
                      _focus(thing, depsgraph))


def _focus(thing, depsgraph) -> float:
    """Distance along the camera's axis to what is sharp."""
    dof = thing.data.dof
    if not dof.focus_object:
        return dof.focus_distance
    target = dof.focus_object.evaluated_get(depsgraph).matrix_world.translation
    axis = thing.matrix_world.to_3x3().col[2].normalized()
    return abs(axis.dot(target - thing.matrix_world.translation))
