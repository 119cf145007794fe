# SPDX-License-Identifier: Apache-2.0
"""Vernier as a render engine of Blender: docs/blender.md."""

bl_info = {
    "name": "Vernier",
    "author": "The Vernier authors",
    "version": (0, 2, 0),
    "blender": (3, 4, 0),
    "category": "Render",
    "description": "Renders by Vernier, which says how wrong each picture is",
}


def _modules():
    from . import engine, export_session, panels, settings

    return settings, engine, export_session, panels


def register() -> None:
    for module in _modules():
        module.register()


def unregister() -> None:
    for module in reversed(_modules()):
        module.unregister()
