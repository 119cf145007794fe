# SPDX-License-Identifier: Apache-2.0
"""What a user sets: in the render, view layer and add-on properties."""
from __future__ import annotations

import shutil

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

_DENOISERS = [
    ("none", "None", "Keep the noise"),
    ("auto", "Automatic", "Open Image Denoise where it is found, else Non-Local Means"),
    ("nlm", "Non-Local Means", "Patches of the picture that are alike are averaged"),
    ("bilateral", "Bilateral", "Nearby pixels of like colour are averaged"),
    ("gaussian", "Gaussian", "A plain blur that puts back what noise cannot explain"),
    ("median", "Median", "Of 5 x 5 pixels; puts back what noise cannot explain"),
    ("oidn", "Open Image Denoise", "A trained network, of libOpenImageDenoise.so.2: the Python package pyoidn has it")]
_FILTERS = [
    ("box", "Box", "The plain mean over a pixel"),
    ("gaussian", "Gaussian", "Two pixels wide"),
    ("blackman-harris:1.5", "Blackman-Harris", "Of 1.5 pixels, as Blender's other engines have it")]
_INTEGRATORS = [
    ("path", "Path Tracing", "All light, unbiased"),
    ("gradient", "Gradient-Domain Path Tracing", "The same with less noise in single pixels of rooms; without fog"),
    ("whitted", "Whitted", "Direct light, mirrors and refraction alone")]


class VernierSceneSettings(bpy.types.PropertyGroup):
    samples: IntProperty(
        name="Samples", default=64, min=0, soft_max=16384,
        description="Samples a pixel, on average; 0: no limit but the others")
    time_limit: FloatProperty(
        name="Time Limit", default=0, min=0, subtype="TIME_ABSOLUTE", unit="TIME_ABSOLUTE",
        description="Stop rendering after this long; 0: no limit")
    error: FloatProperty(
        name="Error", default=0, min=0, max=100, precision=2, subtype="PERCENTAGE",
        description="Stop when the picture is this wrong at most: its relative error as Vernier estimates it; "
                    "0: no limit. Set Samples to 0 for as many as that takes")
    use_adaptive: BoolProperty(
        name="Adaptive", default=True, description="Spend samples where they lower the picture's error")
    seed: IntProperty(name="Seed", default=0, min=0, description="Of the random numbers")
    denoiser: EnumProperty(name="Denoise", items=_DENOISERS, description="Filter the noise out")
    integrator: EnumProperty(name="Integrator", items=_INTEGRATORS, description="How light is computed")
    max_depth: IntProperty(
        name="Max Depth", default=16, min=1, max=65536,
        description="Surfaces along a path, the one that gives light included")
    pixel_filter: EnumProperty(
        name="Pixel Filter", items=_FILTERS, description="What a pixel shows of its surroundings")
    kept_folder: StringProperty(
        name="Keep Files In", subtype="DIR_PATH",
        description="Folder for the exported scene and Vernier's own picture, which is else deleted")
    further_flags: StringProperty(
        name="Further Flags", description="Of the command 'vernier render', quoted as for a shell")


class VernierLayerSettings(bpy.types.PropertyGroup):
    use_pass_error: BoolProperty(
        name="Error", description="Standard error of each pixel, and whether it is to be trusted")
    use_pass_albedo: BoolProperty(name="Albedo", description="Fraction of light that surfaces scatter")
    use_pass_samples: BoolProperty(name="Sample Count", description="Samples of each pixel")


class VernierPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH",
        description="The command 'vernier'; empty: the one that is found in PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")
        if not find_program():
            self.layout.label(text="There is no such program; install Vernier, or name its file", icon="ERROR")


def find_program() -> str | None:
    """The command, or none where there is none."""
    addon = bpy.context.preferences.addons.get(__package__)
    named = addon.preferences.program if addon and addon.preferences else ""
    return shutil.which(bpy.path.abspath(named) if named else "vernier")


_CLASSES = (VernierSceneSettings, VernierLayerSettings, VernierPreferences)


def register() -> None:
    for entry in _CLASSES:
        bpy.utils.register_class(entry)
    bpy.types.Scene.vernier = PointerProperty(type=VernierSceneSettings)
    bpy.types.ViewLayer.vernier = PointerProperty(type=VernierLayerSettings)


def unregister() -> None:
    del bpy.types.ViewLayer.vernier, bpy.types.Scene.vernier
    for entry in reversed(_CLASSES):
        bpy.utils.unregister_class(entry)
