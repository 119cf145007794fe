# SPDX-License-Identifier: Apache-2.0
"""Files of `vernier render --aov`, in one part and in several, in the Image node of Blender's compositor."""
import os
import subprocess
import tempfile
import unittest

import bpy
import numpy
import pictures
from vernier_blender.exr import read_channels

SCENE = os.path.join(os.path.dirname(__file__), "..", "scenes", "two_spheres.gltf")
LAYERS = "error,samples,albedo,normal,coverage,depth,position,id,uv,shadow,crypto_object"


def passes(exr: str, folder: str) -> dict:
    """All that the Image node has of a file, by the names of its sockets and channels."""
    scene = pictures.new_scene()
    scene.render.engine, scene.cycles.samples = "CYCLES", 1
    scene.use_nodes = scene.render.use_compositing = True
    nodes, links = scene.node_tree.nodes, scene.node_tree.links
    nodes.clear()
    node, output = nodes.new("CompositorNodeImage"), nodes.new("CompositorNodeOutputFile")
    node.image = bpy.data.images.load(exr)
    output.base_path = os.path.join(folder, "passes_")
    output.format.file_format, output.format.color_depth = "OPEN_EXR_MULTILAYER", "32"
    output.layer_slots.clear()
    for socket in node.outputs:
        output.layer_slots.new(socket.name)
        links.new(socket, output.inputs[socket.name])
    links.new(node.outputs[0], nodes.new("CompositorNodeComposite").inputs["Image"])
    bpy.ops.render.render()
    written = [name for name in os.listdir(folder) if name.startswith("passes_")]
    channels = read_channels(os.path.join(folder, written[0]))
    os.remove(os.path.join(folder, written[0]))
    return channels


class Layers(unittest.TestCase):
    def test_the_image_node_reads_all_layers_in_one_part_and_in_several(self):
        with tempfile.TemporaryDirectory() as folder:
            found = []
            for flags in ([], ["--multipart"]):
                exr = os.path.join(folder, "picture.exr")
                subprocess.run(["vernier", "render", SCENE, "-o", exr, "--size", "48x32", "--spp", "4", "-q", "--aov", LAYERS,
                                *flags], check=True)
                found.append(passes(exr, folder))
            self.assertEqual(found[0].keys(), found[1].keys())
            for name in ("Combined.R", "Depth.V", "N.G", "P.B", "albedo.R", "shadow.G", "CryptoObject00.G", "error.R"):
                self.assertGreater(numpy.abs(found[0][name]).max(), 0, name)
                numpy.testing.assert_array_equal(found[0][name], found[1][name], name)
