# SPDX-License-Identifier: Apache-2.0
"""What Blender shows and saves is what Vernier renders."""
import json
import math
import os
import pathlib
import subprocess
import tempfile
import unittest
import unittest.mock

import bpy
import numpy
import pictures
from vernier_blender import export_session
from vernier_blender.exr import read_channels


def cube_scene():
    scene = pictures.new_scene()
    pictures.add_cube(2, rotation=(0.3, 0.4, 0.5))
    pictures.add_lamp("POINT", (3, -2, 8), energy=2000, shadow_soft_size=0.5)
    scene.vernier.use_adaptive = False
    return scene


class Pictures(unittest.TestCase):
    def test_are_the_commands_to_the_bit(self):
        scene = cube_scene()
        with tempfile.TemporaryDirectory() as folder:
            scene.vernier.kept_folder = folder
            shown = pictures.rendered(scene)
            out = folder + "/again.exr"
            subprocess.run(["vernier", "render", pictures.kept_scene(folder), "-o", out, "--size", "48x32",
                            "--env", "none", "--spp", "16", "--adaptive", "off"], check=True, capture_output=True)
            again = read_channels(out)
        for name in "RGB":
            numpy.testing.assert_array_equal(shown[name], again[name])
        self.assertGreater(shown["R"].max(), 0)
        self.assertTrue((shown["A"] == 1).all())

    def test_border_is_a_part_of_the_whole(self):
        scene = cube_scene()
        whole = pictures.colors(pictures.rendered(scene))
        render = scene.render
        render.use_border = True
        render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.25, 0.75, 0.5, 0.875
        part = pictures.colors(pictures.rendered(scene))
        inside = numpy.zeros(part.shape, bool)
        inside[4:16, 12:36] = True
        numpy.testing.assert_array_equal(part, numpy.where(inside, whole, 0))
        render.use_crop_to_border = True
        numpy.testing.assert_array_equal(pictures.colors(pictures.rendered(scene)), whole[4:16, 12:36])

    def test_shifted_lens_sees_beside(self):
        scene = cube_scene()
        whole = pictures.colors(pictures.rendered(scene))
        scene.camera.data.shift_x, scene.camera.data.shift_y = 6 / 48, -4 / 48
        shifted = pictures.colors(pictures.rendered(scene))
        # Samples have other numbers there, so what is compared is where there is a cube at all, but for its edges.
        shown, expected = shifted[:-4, :-6].any(axis=-1), whole[4:, 6:].any(axis=-1)
        self.assertLess((shown != expected).mean(), 0.02)
        self.assertGreater((shifted.any(axis=-1) != whole.any(axis=-1)).mean(), 0.06)

    def test_transparent_film(self):
        scene = cube_scene()
        scene.render.film_transparent = True
        alpha = pictures.rendered(scene)["A"]
        self.assertEqual((alpha[0, 0], alpha[16, 24]), (0, 1))
        self.assertTrue(((alpha > 0) & (alpha < 1)).any(), "edges are soft")

    def test_percentage_of_the_resolution(self):
        scene = cube_scene()
        scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 100, 50, 29
        self.assertEqual(pictures.rendered(scene)["R"].shape, (14, 29))

    def test_error_is_in_the_files_metadata(self):
        scene = cube_scene()
        scene.render.use_stamp = False
        with tempfile.TemporaryDirectory() as folder:
            scene.render.image_settings.file_format = "PNG"
            scene.render.filepath = folder + "/picture.png"
            bpy.ops.render.render(write_still=True)
            self.assertIn(b"Error ", pathlib.Path(scene.render.filepath).read_bytes())

    def test_render_settings_of_modifiers_count(self):
        scene = cube_scene()
        modifier = bpy.data.objects["Cube"].modifiers.new("Subdivision", "SUBSURF")
        modifier.levels, modifier.render_levels = 0, 2
        with tempfile.TemporaryDirectory() as folder:
            scene.vernier.kept_folder = folder
            pictures.rendered(scene)
            counted = subprocess.run(["vernier", "info", "--json", pictures.kept_scene(folder)], check=True,
                                     capture_output=True, text=True).stdout
        self.assertIn('"instanced_triangles": %d' % (6 * 4 ** 2 * 2 + 128), counted)

    def test_hidden_objects_and_instances(self):
        scene = cube_scene()
        cube = bpy.data.objects["Cube"]
        small = pictures.add_cube(0.2)
        small.hide_render = True
        source = bpy.data.collections.new("Source")
        source.objects.link(cube)
        scene.collection.objects.unlink(cube)
        for x in (-1.5, 1.5):
            empty = pictures.add("Empty", None, (x, 0, 0))
            empty.instance_type, empty.instance_collection = "COLLECTION", source
        picture = pictures.colors(pictures.rendered(scene)).max(axis=-1)
        self.assertEqual(picture[16, 24], 0)
        self.assertGreater(picture[16, 9], 0)
        self.assertGreater(picture[16, 39], 0)

    def test_lamps_are_not_seen(self):
        scene = pictures.new_scene()
        pictures.add_lamp("AREA", (0, 0, 4), (math.pi, 0, 0), energy=100, size=1)
        pictures.add_lamp("POINT", (1, 0, 4), energy=100, shadow_soft_size=0.3)
        self.assertEqual(pictures.colors(pictures.rendered(scene)).max(), 0)

    def test_glass_is_solid(self):
        scene = cube_scene()
        material = bpy.data.objects["Cube"].data.materials[0]
        nodes, links = material.node_tree.nodes, material.node_tree.links
        glass = nodes.new("ShaderNodeBsdfGlass")
        glass.inputs["IOR"].default_value = 1.25
        links.new(glass.outputs[0], nodes["Material Output"].inputs["Surface"])
        with tempfile.TemporaryDirectory() as folder:
            scene.vernier.kept_folder = folder
            pictures.rendered(scene)
            document = json.loads(pathlib.Path(pictures.kept_scene(folder)).read_text())
        extensions = next(entry["extensions"] for entry in document["materials"] if entry["name"] == "Grey")
        self.assertEqual(extensions["KHR_materials_ior"]["ior"], 1.25)
        self.assertEqual(extensions["KHR_materials_transmission"]["transmissionFactor"], 1)
        self.assertGreater(extensions["KHR_materials_volume"]["thicknessFactor"], 0)

    def test_sheared_objects_are_where_they_should_be(self):
        scene = pictures.new_scene()
        pictures.add_lamp("SUN", energy=3, angle=0)
        outer = pictures.add("Outer", None, scale=(2, 0.5, 1))
        outer.rotation_euler = (0, 0, 0)
        square = pictures.add_square(1, rotation=(0, 0, math.pi / 4))
        square.parent = outer
        seen = pictures.colors(pictures.rendered(scene)).any(axis=-1)
        # A square on its corner, twice as wide and half as high: a rhombus.
        columns, rows = numpy.nonzero(seen.any(axis=0))[0], numpy.nonzero(seen.any(axis=1))[0]
        pixel = 4 / 48
        self.assertAlmostEqual((columns[-1] - columns[0] + 1) * pixel, 2 * math.sqrt(2), delta=2.1 * pixel)
        self.assertAlmostEqual((rows[-1] - rows[0] + 1) * pixel, 0.5 * math.sqrt(2), delta=2.1 * pixel)

    def test_depth_of_field_blurs_what_is_not_in_focus(self):
        scene = pictures.new_scene()
        scene.vernier.samples = 64
        pictures.add_lamp("SUN", energy=3, angle=0)
        pictures.add_square(2)
        lens = scene.camera.data
        lens.dof.use_dof, lens.dof.aperture_fstop, lens.dof.focus_distance = True, 0.1, 10
        sharp = pictures.colors(pictures.rendered(scene))[16, :, 0]
        lens.dof.focus_object = pictures.add("Focus", None, (3, 1, 5))
        blurred = pictures.colors(pictures.rendered(scene))[16, :, 0]
        partly = [int(((line > 0.02 * line.max()) & (line < 0.98 * line.max())).sum()) for line in (sharp, blurred)]
        # Of a point at 10 m with the focus at 5 m: a disk of f/N |1/5 - 1/10| 10 m across at the point.
        width = lens.lens / 1000 / 0.1 * (1 / 5 - 1 / 10) * 10 / (4 / 48)
        self.assertLessEqual(partly[0], 2)
        self.assertAlmostEqual(partly[1] / 2, width, delta=0.25 * width)


class Passes(unittest.TestCase):
    def test_have_blenders_names_axes_and_values(self):
        scene = cube_scene()
        layer = scene.view_layers[0]
        layer.use_pass_z = layer.use_pass_normal = layer.use_pass_position = True
        layer.vernier.use_pass_error = layer.vernier.use_pass_albedo = layer.vernier.use_pass_samples = True
        channels = pictures.rendered(scene, multilayer=True)
        name = layer.name

        def pixel(entry, letters):
            return numpy.array([channels[f"{name}.{entry}.{letter}"][16, 24] for letter in letters])

        # The centre of that pixel, half a pixel off the middle.
        x, y = 0.5 * 4 / 48, -0.5 * 4 / 48
        towards = numpy.array((x, y, -10.0)) / math.sqrt(x * x + y * y + 100)
        hit, place, normal, *_ = scene.ray_cast(bpy.context.evaluated_depsgraph_get(), (0, 0, 10), tuple(towards))
        self.assertTrue(hit)
        numpy.testing.assert_allclose(pixel("Position", "XYZ"), place, atol=1e-4)
        numpy.testing.assert_allclose(pixel("Normal", "XYZ"), normal, atol=1e-3)
        numpy.testing.assert_allclose(pixel("Depth", "Z"), 10 - place.z, atol=1e-4)
        numpy.testing.assert_allclose(pixel("Denoising Albedo", "RGB"), 0.5, atol=1e-2)
        self.assertEqual(pixel("Debug Sample Count", "X"), 16)
        self.assertGreater(pixel("Vernier Error", "RGB").min(), 0)
        self.assertIn(f"{name}.Vernier Unreliable.X", channels)
        self.assertEqual(channels[f"{name}.Depth.Z"][0, 0], numpy.float32(1e10))


    def test_cryptomatte_is_read_by_the_compositor(self):
        scene = pictures.new_scene()
        pictures.add_lamp("SUN", energy=3, angle=0)
        for x, name in ((-1, "Left"), (1, "Right")):
            pictures.add_cube(1, (x, 0, 0)).name = name
        layer = scene.view_layers[0]
        layer.use_pass_cryptomatte_object = True
        channels = pictures.rendered(scene, multilayer=True)
        self.assertIn(f"{layer.name}.CryptoObject02.a", {name.replace(".A", ".a") for name in channels})
        scene.use_nodes = scene.render.use_compositing = True
        nodes, links = scene.node_tree.nodes, scene.node_tree.links
        nodes.clear()
        matte, output = nodes.new("CompositorNodeCryptomatteV2"), nodes.new("CompositorNodeComposite")
        matte.scene = scene
        matte.layer_name = f"{layer.name}.CryptoObject"
        matte.matte_id = "Left"
        links.new(nodes.new("CompositorNodeRLayers").outputs["Image"], matte.inputs["Image"])
        links.new(matte.outputs["Matte"], output.inputs["Image"])
        seen = pictures.colors(pictures.rendered(scene))[16, :, 0]
        left, right = 24 - 12, 24 + 12  # a metre is twelve pixels
        self.assertEqual((seen[left], seen[24], seen[right]), (1, 0, 0))
        self.assertAlmostEqual(seen.sum(), 12 * 10 / 9.5, delta=0.7)

    def test_vectors_are_those_of_cycles(self):
        scene = cube_scene()
        cube = bpy.data.objects["Cube"]
        for frame, x, turn in ((1, -0.5, 0.0), (2, 0.0, 0.2), (3, 0.8, 0.5)):
            cube.location.x, cube.rotation_euler.z = x, turn
            cube.keyframe_insert("location", frame=frame)
            cube.keyframe_insert("rotation_euler", frame=frame)
        scene.frame_set(2)
        scene.view_layers[0].use_pass_vector = True
        scene.cycles.samples, scene.cycles.use_denoising = 1, False
        vectors = []
        for engine in ("VERNIER", "CYCLES"):
            scene.render.engine = engine
            channels = pictures.rendered(scene, multilayer=True)
            name = scene.view_layers[0].name
            vectors.append(numpy.stack([channels[f"{name}.Vector.{letter}"] for letter in "XYZW"], axis=-1))
        middle = numpy.s_[14:18, 22:26]  # of the cube's face
        self.assertGreater(abs(vectors[1][middle][..., 0]).min(), 3)
        # Cycles samples anywhere within the pixel, and the cube turns.
        numpy.testing.assert_allclose(vectors[0][middle], vectors[1][middle], atol=0.4)

    def test_object_index(self):
        scene = pictures.new_scene()
        pictures.add_lamp("POINT", (3, -2, 8), energy=2000, shadow_soft_size=0.5)
        for x, index in ((-1, 3), (1, 7)):
            cube = pictures.add_cube(1, (x, 0, 0))
            cube.pass_index = index
            # Two primitives in the file, and two numbers.
            cube.data.materials.append(pictures.paint())
            cube.data.polygons[0].material_index = 1
        layer = scene.view_layers[0]
        layer.use_pass_object_index = True
        index = pictures.rendered(scene, multilayer=True)[f"{layer.name}.IndexOB.X"][16]
        self.assertEqual((index[0], index[12], index[36]), (0, 3, 7))


class Animations(unittest.TestCase):
    def test_frames_are_those_of_single_renders_from_one_child(self):
        scene = cube_scene()
        cube = bpy.data.objects["Cube"]
        for frame, x in ((1, -1.0), (3, 1.0)):
            cube.location.x = x
            cube.keyframe_insert("location", frame=frame)
        scene.frame_start, scene.frame_end = 1, 3
        begun = []
        original = export_session.ExportSession.__init__

        def counted(session, *arguments):
            begun.append(session)
            original(session, *arguments)

        with tempfile.TemporaryDirectory() as folder, unittest.mock.patch.object(
                export_session.ExportSession, "__init__", counted):
            scene.render.filepath = folder + "/"
            bpy.ops.render.render(animation=True)
            frames = [pictures.colors(read_channels(f"{folder}/{frame:04d}.exr")) for frame in (1, 2, 3)]
        self.assertEqual(len(begun), 1)
        scene.frame_set(2)
        numpy.testing.assert_array_equal(frames[1], pictures.colors(pictures.rendered(scene)))
        self.assertTrue((frames[0] != frames[2]).any())


class Motion(unittest.TestCase):
    def test_what_stands_still_is_told(self):
        scene = cube_scene()
        array = bpy.data.objects["Cube"].modifiers.new("Array", "ARRAY")
        lamp = next(thing for thing in scene.objects if thing.type == "LIGHT")
        for frame in (1, 3):
            array.count, lamp.location.x = frame, frame
            array.keyframe_insert("count", frame=frame)
            lamp.keyframe_insert("location", frame=frame)
        scene.frame_set(2)
        scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 2.0
        answers = []
        original = export_session.ExportSession.export

        def kept(*arguments):
            answers.append(original(*arguments))
            return answers[-1]

        with unittest.mock.patch.object(export_session.ExportSession, "export", kept):
            pictures.rendered(scene)
        notes = "; ".join(answers[0]["notes"])
        self.assertIn("lamps stand still", notes)
        self.assertIn("keeps its shape while the shutter is open: 'Cube'", notes)


class Misuse(unittest.TestCase):
    def expect(self, scene, words):
        """The render fails in these words, and leaves nothing behind."""
        before = set(os.listdir(bpy.app.tempdir))
        with self.assertRaisesRegex(RuntimeError, words):
            pictures.rendered(scene)
        self.assertEqual(set(os.listdir(bpy.app.tempdir)), before)

    def test_no_camera(self):
        scene = cube_scene()
        scene.camera = None
        self.expect(scene, "[Cc]amera")

    def test_panorama(self):
        scene = cube_scene()
        scene.camera.data.type = "PANO"
        self.expect(scene, "is a panorama")

    def test_unknown_flags(self):
        scene = cube_scene()
        scene.vernier.further_flags = "--sppp 3"
        self.expect(scene, "unknown flag '--sppp'")

    def test_broken_quotes(self):
        scene = cube_scene()
        scene.vernier.further_flags = "'"
        self.expect(scene, "Further Flags")

    def test_program_that_is_not_there(self):
        scene = cube_scene()
        with unittest.mock.patch.dict(os.environ, PATH="/no/such/folder"):
            self.expect(scene, "no program")
