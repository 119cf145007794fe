# SPDX-License-Identifier: Apache-2.0
"""Reads the OpenEXR files that vernier writes with --compression none."""
import struct

import numpy

MAGIC = 20000630
FLOAT = 2


def _attributes(data):
    """The header's attributes by name, and where it ends."""
    at, found = 8, {}
    while data[at]:
        name, kind = (data[at:].split(b"\0", 2)[i] for i in (0, 1))
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<i", data, at)[0]
        found[name.decode()] = data[at + 4 : at + 4 + size]
        at += 4 + size
    return found, at + 1


def _channels(data):
    names, at = [], 0
    while data[at]:
        name = data[at:].split(b"\0", 1)[0]
        at += len(name) + 1
        if struct.unpack_from("<i", data, at)[0] != FLOAT:
            raise ValueError(f"channel {name.decode()} is not 32-bit float")
        names.append(name.decode())
        at += 16
    return names


def read_rgb(path):
    """Channels R, G, B as an array of height x width x 3."""
    with open(path, "rb") as file:
        data = file.read()
    if struct.unpack_from("<i", data)[0] != MAGIC:
        raise ValueError(f"{path}: no OpenEXR file")
    attributes, at = _attributes(data)
    if attributes["compression"] != b"\0":
        raise ValueError(f"{path}: compressed; expected a file written with --compression none")
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height, names = right - left + 1, bottom - top + 1, _channels(attributes["channels"])
    picture = numpy.empty((height, width, 3), numpy.float32)
    for start in struct.unpack_from(f"<{height}Q", data, at):
        line, _ = struct.unpack_from("<2i", data, start)
        values = numpy.frombuffer(data, "<f4", len(names) * width, start + 8).reshape(len(names), width)
        for channel, name in enumerate("RGB"):
            picture[line - top, :, channel] = values[names.index(name)]
    return picture
