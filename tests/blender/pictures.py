# SPDX-License-Identifier: Apache-2.0
"""Scenes of tests, and their renders as arrays. Runs inside Blender."""
import math
import os
import pathlib
import tempfile

import bpy
import numpy
from vernier_blender.exr import read_channels

SIZE = (48, 32)


def new_scene(size=SIZE) -> bpy.types.Scene:
    """Nothing but a black world and a camera ten metres above the ground that looks down at 4 metres of it."""
    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    scene = bpy.context.scene
    scene.world = bpy.data.worlds.new("World")
    scene.world.color = (0, 0, 0)
    camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    camera.location = (0, 0, 10)
    camera.data.angle = 2 * math.atan(0.2)
    scene.collection.objects.link(camera)
    scene.camera = camera
    render = scene.render
    render.engine = "VERNIER"
    render.resolution_x, render.resolution_y, render.resolution_percentage = *size, 100
    render.image_settings.file_format = "OPEN_EXR"
    render.image_settings.color_depth = "32"
    render.image_settings.color_mode = "RGBA"
    render.use_compositing = False
    scene.vernier.samples = 16
    return scene


def paint(name="Grey", color=(0.5, 0.5, 0.5)) -> bpy.types.Material:
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    diffuse = nodes.new("ShaderNodeBsdfDiffuse")
    diffuse.inputs["Color"].default_value = (*color, 1)
    links.new(diffuse.outputs[0], nodes["Material Output"].inputs["Surface"])
    return material


def add(name: str, data, location=(0, 0, 0), rotation=(0, 0, 0), scale=(1, 1, 1)) -> bpy.types.Object:
    thing = bpy.data.objects.new(name, data)
    thing.location, thing.rotation_euler, thing.scale = location, rotation, scale
    bpy.context.scene.collection.objects.link(thing)
    return thing


def add_square(side=20.0, location=(0, 0, 0), rotation=(0, 0, 0), material=None) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("Square")
    h = side / 2
    mesh.from_pydata([(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [], [(0, 1, 2, 3)])
    mesh.materials.append(material or paint())
    return add("Square", mesh, location, rotation)


def add_cube(side=1.0, location=(0, 0, 0), rotation=(0, 0, 0)) -> bpy.types.Object:
    mesh = bpy.data.meshes.new("Cube")
    h = side / 2
    points = [(x, y, z) for x in (-h, h) for y in (-h, h) for z in (-h, h)]
    faces = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    mesh.from_pydata(points, [], faces)
    mesh.materials.append(paint())
    return add("Cube", mesh, location, rotation)


def add_lamp(kind: str, location=(0, 0, 4), rotation=(0, 0, 0), **properties) -> bpy.types.Object:
    light = bpy.data.lights.new("Lamp", kind)
    for name, value in properties.items():
        setattr(light, name, value)
    return add("Lamp", light, location, rotation)


def rendered(scene: bpy.types.Scene, multilayer=False) -> dict[str, numpy.ndarray]:
    """Channels of the picture that Blender saves of the current frame."""
    with tempfile.TemporaryDirectory() as folder:
        scene.render.filepath = os.path.join(folder, "picture.exr")
        scene.render.image_settings.file_format = "OPEN_EXR_MULTILAYER" if multilayer else "OPEN_EXR"
        scene.render.image_settings.color_depth = "32"
        scene.render.image_settings.exr_codec = "ZIP"
        bpy.ops.render.render(write_still=True)
        return read_channels(scene.render.filepath)


def colors(channels: dict[str, numpy.ndarray]) -> numpy.ndarray:
    return numpy.stack([channels[name] for name in "RGB"], axis=-1)


def kept_scene(folder: str) -> str:
    """The file that the last render exported."""
    return str(next(pathlib.Path(folder).glob("*.gltf")))
