# SPDX-License-Identifier: Apache-2.0
"""What the glTF exporter makes nothing of in a material."""
from __future__ import annotations

# Surfaces that the exporter reads, by their type of node.
_UNDERSTOOD = {"BSDF_PRINCIPLED", "EMISSION", "BACKGROUND"}


def notes_on_materials(materials) -> set[str]:
    return {f"material '{material.name}' ends in no Principled BSDF, which is all that glTF's exporter reads: "
            "it comes out plain" for material in materials if not _is_understood(material)}


def _is_understood(material) -> bool:
    if not material.use_nodes or not material.node_tree:
        return True
    output = material.node_tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    return not links or links[0].from_node.type in _UNDERSTOOD
