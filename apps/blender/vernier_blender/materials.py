# SPDX-License-Identifier: Apache-2.0
"""Materials that glTF's exporter would not read, put into the form that it reads. The child's copy is changed, not
the user's scene."""
from __future__ import annotations

# What the exporter looks for, by type of node.
_UNDERSTOOD = {"BSDF_PRINCIPLED", "EMISSION", "BACKGROUND", "GROUP"}

# Plain nodes as a Principled one: its settings, and what its inputs are called there. Names have changed in Blender 4.
_PLAIN = {
    "BSDF_DIFFUSE": ({"Specular": 0.0}, {"Color": "Base Color"}),
    "BSDF_GLOSSY": ({"Metallic": 1.0}, {"Color": "Base Color", "Roughness": "Roughness"}),
    "BSDF_GLASS": ({"Transmission": 1.0}, {"Color": "Base Color", "Roughness": "Roughness", "IOR": "IOR"})}
_NEW_NAMES = {"Specular": "Specular IOR Level", "Transmission": "Transmission Weight"}


def make_readable(materials) -> set[str]:
    """Changes the materials; returns notes on those that stay without a meaning in glTF."""
    return {f"material '{material.name}' has no Principled BSDF, which is what glTF's exporter reads: it comes "
            "out plain" for material in materials if not _is_readable(material)}


def _is_readable(material) -> bool:
    if not material.use_nodes or not material.node_tree:
        return True
    tree = material.node_tree
    output = tree.get_output_node("CYCLES")
    links = output.inputs["Surface"].links if output else ()
    if links and links[0].from_node.type in _PLAIN:
        _replace(tree, links[0].from_node, output)
    types = {node.type for node in tree.nodes}
    return bool(types & _UNDERSTOOD) or types <= {"OUTPUT_MATERIAL"}


def _replace(tree, plain, output) -> None:
    """Puts a Principled node in the place of a plain one, and removes others, which the exporter might take."""
    for other in [node for node in tree.nodes if node.type == "BSDF_PRINCIPLED"]:
        tree.nodes.remove(other)
    principled = tree.nodes.new("ShaderNodeBsdfPrincipled")
    settings, inputs = _PLAIN[plain.type]
    for name, value in settings.items():
        _input(principled, name).default_value = value
    for old, new in {**inputs, "Normal": "Normal"}.items():
        source, target = plain.inputs[old], principled.inputs[new]
        if source.is_linked:
            tree.links.new(source.links[0].from_socket, target)
        elif old != "Normal":
            target.default_value = source.default_value
    tree.links.new(principled.outputs[0], output.inputs["Surface"])


def _input(principled, name: str):
    return principled.inputs.get(name) or principled.inputs[_NEW_NAMES[name]]
