# SPDX-License-Identifier: Apache-2.0
"""Reads the channels of an OpenEXR file as Vernier writes it: one part, scanlines of 32-bit floats, zipped.

Blender's Python interface reads no layer of a file but the colour, and its builds agree on no library that does.
"""
from __future__ import annotations

import struct
import zlib

import numpy

_LINES_IN_BLOCK = {0: 1, 2: 1, 3: 16}  # by compression: none, ZIPS, ZIP
_FLOAT = 2


class ExrError(Exception):
    """A file that is not what Vernier writes."""


def read_channels(path: str) -> dict[str, numpy.ndarray]:
    """The channels by name, each (height, width), the top line first."""
    return read_picture(path)[0]


def read_picture(path: str) -> tuple[dict[str, numpy.ndarray], dict[str, str]]:
    """The channels, and the texts of the header by name."""
    with open(path, "rb") as file:
        data = file.read()
    try:
        reader = _Reader(path, data)
        return reader.channels(), reader.texts()
    except (struct.error, zlib.error, KeyError, ValueError, IndexError) as problem:
        raise ExrError(f"{path}: not an OpenEXR file as Vernier writes it: {problem}") from problem


class _Reader:
    def __init__(self, path: str, data: bytes):
        magic, version = struct.unpack_from("<iI", data)
        # Tiles, deep data and several parts are flags of the version; long names are another.
        if magic != 20000630 or version & ~0x400 != 2:
            raise ExrError(f"{path}: not an OpenEXR file of scanlines in one part")
        self._data = data
        self._attributes: dict[str, bytes] = {}
        self._texts: dict[str, str] = {}
        self._offset = self._read_header()

    def texts(self) -> dict[str, str]:
        return self._texts

    def channels(self) -> dict[str, numpy.ndarray]:
        left, top, right, bottom = struct.unpack("<4i", self._attributes["dataWindow"])
        width, height = right - left + 1, bottom - top + 1
        names = self._channel_names()
        compression = self._attributes["compression"][0]
        lines = _LINES_IN_BLOCK[compression]
        blocks = (height + lines - 1) // lines
        pixels = numpy.empty((height, len(names), width), dtype="<f4")
        for offset in struct.unpack_from(f"<{blocks}Q", self._data, self._offset):
            line, size = struct.unpack_from("<ii", self._data, offset)
            first = line - top
            count = min(lines, height - first)
            packed = self._data[offset + 8:offset + 8 + size]
            wanted = 4 * count * len(names) * width
            raw = packed if size == wanted else _unzip(packed)
            pixels[first:first + count] = numpy.frombuffer(raw, dtype="<f4").reshape(count, len(names), width)
        return {name: pixels[:, index] for index, name in enumerate(names)}

    def _read_header(self) -> int:
        """Where it ends."""
        at = 8
        while self._data[at]:
            name, at = self._text(at)
            kind, at = self._text(at)
            (size,) = struct.unpack_from("<i", self._data, at)
            value = self._data[at + 4:at + 4 + size]
            self._attributes[name] = value
            if kind == "string":
                self._texts[name] = value.decode(errors="replace")
            at += 4 + size
        return at + 1

    def _text(self, at: int) -> tuple[str, int]:
        end = self._data.index(b"\0", at)
        return self._data[at:end].decode(), end + 1

    def _channel_names(self) -> list[str]:
        table, names, at = self._attributes["channels"], [], 0
        while table[at]:
            end = table.index(b"\0", at)
            names.append(table[at:end].decode())
            kind, _, x_step, y_step = struct.unpack_from("<iIii", table, end + 1)
            if (kind, x_step, y_step) != (_FLOAT, 1, 1):
                raise ValueError(f"channel {names[-1]} is not of 32-bit floats, one a pixel")
            at = end + 17
        return names


def _unzip(packed: bytes) -> bytes:
    """Undoes OpenEXR's zip: the bytes are differences, and those at even places come before the others."""
    differences = numpy.frombuffer(zlib.decompress(packed), dtype=numpy.uint8).astype(numpy.int64)
    differences[1:] -= 128
    values = numpy.cumsum(differences).astype(numpy.uint8)
    half = (len(values) + 1) // 2
    raw = numpy.empty_like(values)
    raw[0::2], raw[1::2] = values[:half], values[half:]
    return raw.tobytes()
