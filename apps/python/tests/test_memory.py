# SPDX-License-Identifier: Apache-2.0
"""Scenes within a limit of memory."""

import json
import os
import pathlib
import struct
import zlib

import numpy as np
import pytest

import vernier

SIDE = 1024
IMAGES = 24  # of one file, 75 MB when they are decoded


def png(pixels):
    height, width, channels = pixels.shape
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    assert channels == 3
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows, 1)) + chunk(b"IEND", b""))


@pytest.fixture(scope="module")
def textured_walls(tmp_path_factory):
    """Walls in a row, each with an image of its own."""
    folder = tmp_path_factory.mktemp("walls")
    (folder / "noise.png").write_bytes(png(np.random.default_rng(1).integers(0, 16, (SIDE, SIDE, 3), np.uint8)))
    corners, uvs = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0), struct.pack("<6f", 0, 0, 1, 0, 0, 1)
    (folder / "a.bin").write_bytes(corners + uvs)
    walls = range(IMAGES)
    attributes = {"POSITION": 0, "TEXCOORD_0": 1}
    (folder / "walls.gltf").write_text(json.dumps({
        "asset": {"version": "2.0"}, "buffers": [{"uri": "a.bin", "byteLength": 60}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 24}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3},
                      {"bufferView": 1, "componentType": 5126, "type": "VEC2", "count": 3}],
        "images": [{"uri": "noise.png"} for _ in walls], "textures": [{"source": i} for i in walls],
        "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": i}}} for i in walls],
        "meshes": [{"primitives": [{"attributes": attributes, "material": i}]} for i in walls],
        "nodes": [{"mesh": i, "translation": [i % 6, i // 6, 0]} for i in walls], "scenes": [{"nodes": list(walls)}]}))
    return folder / "walls.gltf"


def resident():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_textures_beyond_the_limit_give_the_same_picture(textured_walls):
    limited = vernier.load(textured_walls, max_memory=resident() + 40 * 10**6)
    whole = vernier.load(textured_walls, max_memory=10**12)
    assert any("they are kept in a file in" in notice.text for notice in limited.notices)
    assert not any("in a file" in notice.text for notice in whole.notices)
    for filtering in ("none", "mip"):
        pictures = [vernier.render(scene, size=(96, 64), spp=4, env="studio", texture_filter=filtering)
                    for scene in (limited, whole)]
        assert np.array_equal(pictures[0].pixels, pictures[1].pixels)


def test_meshes_beyond_the_limit_are_refused(make_square):
    with pytest.raises(vernier.OutOfMemoryError, match="to build a scene of 2 triangles .* the limit is 1.00 MB"):
        vernier.load([make_square()], max_memory=10**6)


@pytest.mark.parametrize("wrong", [0, -1, 0.5, 2**64])
def test_limits_are_bytes(make_square, wrong):
    with pytest.raises(vernier.UsageError, match="max_memory: expected bytes"):
        vernier.load([make_square()], max_memory=wrong)
