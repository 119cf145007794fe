# SPDX-License-Identifier: Apache-2.0
"""A world as a picture of it: whatever nodes it is made of, Cycles draws it once, seen all around."""
from __future__ import annotations

import math

import bpy

# Pixels across.
_PROCEDURAL = 2048
_UNIFORM = 16
_PICTURE = (1024, 8192)  # small ones are interpolated as Cycles does it


class WorldPainter:
    """Draws the world of a scene when it has changed since the last time."""

    def __init__(self, scene: bpy.types.Scene):
        self._world = scene.world
        self._drawn: str | None = None

    def picture(self, folder: str, frame: int) -> str | None:
        """The file that shows the world at this frame; none where there is nothing but black."""
        if not self._world or self._is_black():
            return None
        if not self._drawn or _changes(self._world):
            self._drawn = f"{folder}/world_{frame:04d}.exr"
            _draw(self._world, self._drawn, frame)
        return self._drawn

    def _is_black(self) -> bool:
        if not _has_nodes(self._world):
            return max(self._world.color) <= 0
        output = self._world.node_tree.get_output_node("CYCLES")
        return not output or not output.inputs["Surface"].is_linked


def _draw(world, path: str, frame: int) -> None:
    scene = bpy.data.scenes.new("Vernier's world")
    try:
        scene.frame_set(frame)
        scene.world = world
        if getattr(world, "cycles_visibility", None):
            world.cycles_visibility.camera = True
        _look_all_around(scene)
        _set_quality(scene, world)
        scene.render.filepath = path
        bpy.ops.render.render(scene=scene.name, write_still=True)
    finally:
        bpy.data.scenes.remove(scene)


def _look_all_around(scene) -> None:
    """As Vernier takes its surroundings, and Blender its environment textures: +x is in the middle."""
    camera = bpy.data.cameras.new("Vernier's world")
    camera.type = "PANO"
    owner = camera if hasattr(camera, "panorama_type") else camera.cycles  # Blender 5 moved it
    owner.panorama_type = "EQUIRECTANGULAR"
    scene.camera = bpy.data.objects.new(camera.name, camera)
    scene.camera.rotation_euler = (math.pi / 2, 0, -math.pi / 2)
    scene.collection.objects.link(scene.camera)


def _set_quality(scene, world) -> None:
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    width, is_exact = _width(world)
    render.resolution_x, render.resolution_y, render.resolution_percentage = width, width // 2, 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGB"
    render.image_settings.exr_codec = "ZIP"
    render.use_file_extension = False
    cycles.device = "CPU"
    cycles.use_denoising = cycles.use_adaptive_sampling = False
    # Pictures are read at the pixels' centres, which are their own texels'; all else is averaged over the pixels.
    cycles.samples = 1 if is_exact else 16
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 0.01 if is_exact else 1


def _width(world) -> tuple[int, bool]:
    """Pixels across, and whether it is a picture, which is read at points."""
    nodes = list(_all_nodes(world.node_tree)) if _has_nodes(world) else []
    widths = [node.image.size[0] for node in nodes if node.type == "TEX_ENVIRONMENT" and node.image]
    if widths and not any(node.type == "TEX_SKY" for node in nodes):
        least, most = _PICTURE
        return min(max(widths + [least]) // 2 * 2, most), True
    is_uniform = all(node.type in ("BACKGROUND", "OUTPUT_WORLD") for node in nodes)
    return (_UNIFORM if is_uniform else _PROCEDURAL), False


def _all_nodes(tree):
    for node in tree.nodes:
        yield node
        if node.type == "GROUP" and node.node_tree:
            yield from _all_nodes(node.node_tree)


def _has_nodes(world) -> bool:
    return bool(world.use_nodes and world.node_tree)


def _changes(world) -> bool:
    """Whether it may differ from frame to frame."""
    if world.animation_data:
        return True
    if not _has_nodes(world):
        return False
    nodes = list(_all_nodes(world.node_tree))
    trees = [world.node_tree] + [node.node_tree for node in nodes if node.type == "GROUP" and node.node_tree]
    images = [node.image for node in nodes if getattr(node, "image", None)]
    return (any(tree.animation_data for tree in trees)
            or any(image.source in ("SEQUENCE", "MOVIE") for image in images))
