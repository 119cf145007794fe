# SPDX-License-Identifier: Apache-2.0
"""Renders a job of rivals in Cycles: blender -b --factory-startup -P in_cycles.py -- JOB.json, or by a Python that has bpy.

Set so that it is unbiased: nothing clamped, no light left out, caustics, no denoising, one number of samples for all pixels."""
import json
import pathlib
import struct
import sys
import tempfile

import bpy
import numpy

# Blender 3.4's importer uses names that newer numpy has not.
for name, kind in (("bool", bool), ("int", int), ("float", float), ("object", object)):
    if name not in numpy.__dict__:
        setattr(numpy, name, kind)


def parts_of(path):
    """JSON and what follows it in a .glb."""
    data = pathlib.Path(path).read_bytes()
    if data[:4] != b"glTF":
        return json.loads(data), None
    length = struct.unpack_from("<I", data, 12)[0]
    return json.loads(data[20 : 20 + length]), data[20 + length :]


def without_specular(path, folder):
    """The scene without KHR_materials_specular, at whose factor 0 some versions of the importer divide by zero."""
    scene, rest = parts_of(path)
    if rest is None or "KHR_materials_specular" not in scene.get("extensionsUsed", []):
        return path
    for material in scene.get("materials", []):
        material.get("extensions", {}).pop("KHR_materials_specular", None)
    text = json.dumps(scene).encode()
    text += b" " * (-len(text) % 4)
    copy = pathlib.Path(folder) / "scene.glb"
    copy.write_bytes(struct.pack("<4sII", b"glTF", 2, 20 + len(text) + len(rest)) +
                     struct.pack("<I4s", len(text), b"JSON") + text + rest)
    return str(copy)


def make_diffuse(material):
    """Lambert in place of the principled surface, which is Disney's diffuse in old versions."""
    nodes, links = material.node_tree.nodes, material.node_tree.links
    for node in [node for node in nodes if node.type == "BSDF_PRINCIPLED"]:
        diffuse, color = nodes.new("ShaderNodeBsdfDiffuse"), node.inputs["Base Color"]
        if color.is_linked:
            links.new(color.links[0].from_socket, diffuse.inputs["Color"])
        else:
            diffuse.inputs["Color"].default_value = color.default_value
        for link in list(node.outputs["BSDF"].links):
            links.new(diffuse.outputs["BSDF"], link.to_socket)


def emit_only(material):
    for node in material.node_tree.nodes:
        if node.type == "BSDF_PRINCIPLED":
            inputs = node.inputs
            inputs["Specular" if "Specular" in inputs else "Specular IOR Level"].default_value = 0


def load(job, folder):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    bpy.ops.import_scene.gltf(filepath=without_specular(job["scene"], folder))
    for described in parts_of(job["scene"])[0].get("materials", []):
        material = bpy.data.materials.get(described.get("name", ""))
        specular = described.get("extensions", {}).get("KHR_materials_specular", {})
        if material and specular.get("specularFactor", 1) == 0:
            (emit_only if max(described.get("emissiveFactor", [0])) > 0 else make_diffuse)(material)
    scene = bpy.context.scene
    scene.camera = next(thing for thing in scene.objects if thing.type == "CAMERA")
    scene.world = bpy.data.worlds.new("world")
    scene.world.use_nodes = True
    nodes = scene.world.node_tree.nodes
    background = nodes["Background"]
    background.inputs["Color"].default_value = (0, 0, 0, 1)
    if job["environment"]:
        texture = nodes.new("ShaderNodeTexEnvironment")
        texture.image = bpy.data.images.load(job["environment"])
        scene.world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    return scene


def set_up(scene, job, picture):
    scene.render.engine = "CYCLES"
    cycles = scene.cycles
    cycles.device, cycles.samples, cycles.seed = "CPU", job["spp"], job["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max"):
        setattr(cycles, f"{kind}_bounces", job["depth"])
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.light_sampling_threshold = 0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.pixel_filter_type = "BOX"
    if hasattr(cycles, "use_guiding"):
        cycles.use_guiding = job["guiding"]
    render = scene.render
    render.threads_mode, render.threads = "FIXED", job["threads"]
    render.resolution_x, render.resolution_y, render.resolution_percentage = job["width"], job["height"], 100
    scene.view_settings.view_transform = "Raw"
    render.image_settings.file_format, render.image_settings.color_depth = "OPEN_EXR", "32"
    render.filepath = picture


def main():
    with open(sys.argv[-1], encoding="utf-8") as file:
        job = json.load(file)
    with tempfile.TemporaryDirectory() as folder:
        exr = str(pathlib.Path(folder) / "picture.exr")
        set_up(load(job, folder), job, exr)
        bpy.ops.render.render(write_still=True)
        image = bpy.data.images.load(exr)
        image.colorspace_settings.is_data = True
        values = numpy.empty(job["width"] * job["height"] * 4, numpy.float32)
        image.pixels.foreach_get(values)
    # Blender's rows begin at the bottom.
    numpy.save(job["picture"], values.reshape(job["height"], job["width"], 4)[::-1, :, :3])
    guiding = ", guided" if job["guiding"] else ""
    print(f"RIVAL Cycles {bpy.app.version_string}{guiding}")


main()
