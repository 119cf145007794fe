# SPDX-License-Identifier: Apache-2.0
"""How bright this Blender's flat lamps are: their radiance is a quarter of their watts per area in Blender 3.4 and
1/pi of them in 4.2 and later. Its own Cycles is asked, so that every version gets its own brightness."""
from __future__ import annotations

import functools
import math
import os

import bpy

_KNOWN = (1 / 4, 1 / math.pi)
_SIDE = 0.01  # metres, at a distance of one


@functools.lru_cache(maxsize=None)
def radiance_of_watt(folder: str) -> float:
    """Radiance of a flat lamp of a watt and a square metre. The folder is for a passing picture."""
    scene = bpy.data.scenes.new("Vernier's lamp")
    path = os.path.join(folder, "lamp.exr")
    try:
        _furnish(scene)
        scene.render.filepath = path
        bpy.ops.render.render(scene=scene.name, write_still=True)
        image = bpy.data.images.load(path)
        shown = image.pixels[0]
        bpy.data.images.remove(image)
    finally:
        bpy.data.scenes.remove(scene)
    os.remove(path)
    # A white surface straight below shows 1/pi of its irradiance, which is radiance times area at that distance.
    measured = shown * math.pi
    return min(_KNOWN, key=lambda known: abs(known - measured))


def _furnish(scene) -> None:
    """A white floor in the light of a small lamp of one watt, seen by a camera beside it."""
    light = bpy.data.lights.new("Vernier's lamp", "AREA")
    light.energy, light.size = 1, _SIDE
    floor = bpy.data.meshes.new("Vernier's floor")
    floor.from_pydata([(-9, -9, -1), (9, -9, -1), (9, 9, -1), (-9, 9, -1)], [], [(0, 1, 2, 3)])
    floor.materials.append(_white())
    camera = bpy.data.cameras.new("Vernier's camera")
    camera.type, camera.ortho_scale = "ORTHO", _SIDE
    for data in (light, floor, camera):
        scene.collection.objects.link(bpy.data.objects.new(data.name, data))
    scene.camera = scene.objects[camera.name]
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x = render.resolution_y = 1
    render.resolution_percentage = 100
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.use_file_extension = False
    cycles.device, cycles.samples, cycles.use_denoising = "CPU", 4, False


def _white():
    material = bpy.data.materials.new("Vernier's white")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    diffuse, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
    tree.links.new(diffuse.outputs[0], output.inputs["Surface"])
    return material
