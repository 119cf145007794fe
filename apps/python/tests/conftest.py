# SPDX-License-Identifier: Apache-2.0
"""What the tests share. VERNIER_BINARY is the command that pictures are compared with."""

import os
import pathlib
import subprocess

import numpy as np
import pytest

import vernier

ROOT = pathlib.Path(__file__).resolve().parents[3]
SCENES = ROOT / "tests" / "scenes"
PROGRAM = pathlib.Path(os.environ.get("VERNIER_BINARY", ROOT / "build" / "release" / "vernier"))


@pytest.fixture(scope="session")
def cornell() -> vernier.Scene:
    return vernier.load(SCENES / "cornell_box.gltf")


@pytest.fixture(scope="session")
def spheres() -> vernier.Scene:
    return vernier.load(SCENES / "two_spheres.gltf")


@pytest.fixture
def command(tmp_path):
    """Runs the command line and returns the finished process."""
    if not PROGRAM.exists():
        pytest.skip(f"there is no {PROGRAM} to compare with; build it, or name one by VERNIER_BINARY")

    def run(*arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, check=False, cwd=tmp_path)

    return run


@pytest.fixture
def make_square():
    """Makes a mesh of 2 x 2 m around the origin that faces +z."""

    def make(**rest) -> vernier.Mesh:
        positions = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]])
        return vernier.Mesh(positions, [[0, 1, 2], [0, 2, 3]], **rest)

    return make
