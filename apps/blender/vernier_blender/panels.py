# SPDX-License-Identifier: Apache-2.0
"""The panels of the render and view layer properties, and Blender's own that serve Vernier too."""
from __future__ import annotations

import bpy

from .engine import VernierRenderEngine

_ENGINE = VernierRenderEngine.bl_idname

# Eevee's own panels of what is exported. Panels that serve any engine say so by the name of one that is gone.
_BORROWED = {"DATA_PT_EEVEE_light", "EEVEE_MATERIAL_PT_context_material", "EEVEE_MATERIAL_PT_surface",
             "EEVEE_WORLD_PT_surface"}
_FOR_ALL = "BLENDER_RENDER"
# Of these, what Eevee's say too, and what Vernier has not.
_UNUSED = {"DATA_PT_light", "DATA_PT_area", "DATA_PT_falloff_curve", "DATA_PT_preview", "MATERIAL_PT_preview",
           "WORLD_PT_preview", "TEXTURE_PT_preview", "RENDER_PT_gpencil", "RENDER_PT_freestyle",
           "VIEWLAYER_PT_freestyle", "VIEWLAYER_PT_filter", "VIEWLAYER_PT_layer_passes"}


class _Panel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = {_ENGINE}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES


class VERNIER_PT_sampling(_Panel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw(self, context):
        settings, layout = context.scene.vernier, self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(heading="Stop At")
        column.prop(settings, "samples")
        column.prop(settings, "time_limit")
        column.prop(settings, "error")
        layout.prop(settings, "denoiser")
        layout.prop(settings, "use_adaptive")
        layout.prop(settings, "seed")


class VERNIER_PT_light_paths(_Panel, bpy.types.Panel):
    bl_label = "Light Paths"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.vernier, "integrator")
        self.layout.prop(context.scene.vernier, "max_depth")


class VERNIER_PT_film(_Panel, bpy.types.Panel):
    bl_label = "Film"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.scene.vernier, "pixel_filter")
        self.layout.prop(context.scene.render, "film_transparent", text="Transparent")


class VERNIER_PT_motion_blur(_Panel, bpy.types.Panel):
    bl_label = "Motion Blur"
    bl_options = {"DEFAULT_CLOSED"}

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render, layout = context.scene.render, self.layout
        layout.use_property_split = True
        layout.active = render.use_motion_blur
        owner = render if hasattr(render, "motion_blur_position") else getattr(context.scene, "cycles", None)
        if owner:
            layout.prop(owner, "motion_blur_position", text="Position")
        layout.prop(render, "motion_blur_shutter")


class VERNIER_PT_performance(_Panel, bpy.types.Panel):
    bl_label = "Performance and Files"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        render, settings, layout = context.scene.render, context.scene.vernier, self.layout
        layout.use_property_split = True
        layout.prop(render, "threads_mode")
        if render.threads_mode == "FIXED":
            layout.prop(render, "threads")
        layout.prop(settings, "kept_folder")
        layout.prop(settings, "further_flags")


class VERNIER_PT_passes(_Panel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        layer, layout = context.view_layer, self.layout
        layout.use_property_split = True
        column = layout.column(heading="Include")
        for name in ("use_pass_z", "use_pass_position", "use_pass_normal", "use_pass_vector",
                     "use_pass_object_index"):
            column.prop(layer, name)
        for name in ("use_pass_error", "use_pass_albedo", "use_pass_samples"):
            column.prop(layer.vernier, name)
        column = layout.column(heading="Cryptomatte", align=True)
        for name, text in (("object", "Object"), ("material", "Material"), ("asset", "Asset")):
            column.prop(layer, f"use_pass_cryptomatte_{name}", text=text)
        layout.prop(layer, "pass_cryptomatte_depth", text="Levels")


_CLASSES = (VERNIER_PT_sampling, VERNIER_PT_light_paths, VERNIER_PT_film, VERNIER_PT_motion_blur,
            VERNIER_PT_performance, VERNIER_PT_passes)


def _borrowed_panels():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", set())
        is_for_all = _FOR_ALL in engines and panel.__name__ not in _UNUSED
        if panel.__name__ in _BORROWED or is_for_all:
            yield panel


def register() -> None:
    for entry in _CLASSES:
        bpy.utils.register_class(entry)
    for panel in _borrowed_panels():
        panel.COMPAT_ENGINES.add(_ENGINE)


def unregister() -> None:
    for panel in _borrowed_panels():
        panel.COMPAT_ENGINES.discard(_ENGINE)
    for entry in reversed(_CLASSES):
        bpy.utils.unregister_class(entry)
