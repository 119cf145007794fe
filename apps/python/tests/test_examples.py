# SPDX-License-Identifier: Apache-2.0
"""The examples do what they say, on small pictures."""

import os
import subprocess
import sys

import numpy as np
import pytest

import vernier
from conftest import ROOT, SCENES

EXAMPLES = ROOT / "apps" / "python" / "examples"


def run(example, *arguments, cwd):
    done = subprocess.run([sys.executable, EXAMPLES / example, *map(str, arguments)], check=False, capture_output=True,
                          text=True, cwd=cwd, env={**os.environ, "MPLCONFIGDIR": str(cwd)})
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_random_poses(tmp_path):
    """A hundred poses with what a learner wants of them."""
    run("random_poses.py", SCENES / "sphere_grid.gltf", "poses", "--count", 100, "--size", 24, 16, "--spp", 2, cwd=tmp_path)
    poses = [np.load(path) for path in sorted((tmp_path / "poses").glob("*.npz"))]
    assert len(poses) == 100
    for pose in poses:
        seen = pose["id"] > 0
        assert pose["rgb"].shape == (16, 24, 3) and pose["rgb"].dtype == np.uint8
        assert np.array_equal(seen, np.isfinite(pose["depth"]))
        assert seen.any()
    assert len({pose["camera_to_world"].tobytes() for pose in poses}) == 100
    # Depth and camera say where a point is; of all poses, the points are in the scene's bounds.
    bounds = vernier.load(SCENES / "sphere_grid.gltf").bounds
    for pose in poses[:10]:
        row, column = np.argwhere(np.isfinite(pose["depth"]))[0]
        half = np.tan(pose["yfov"] / 2)
        ray = np.array([(column + 0.5 - 12) / 8 * half, (8 - row - 0.5) / 8 * half, -1, 0]) * pose["depth"][row, column]
        point = (pose["camera_to_world"] @ (ray + [0, 0, 0, 1]))[:3]
        assert (point > bounds[0] - 1e-3).all() and (point < bounds[1] + 1e-3).all()


def test_turntable(tmp_path):
    out = run("turntable.py", SCENES / "sphere_grid.gltf", "frames", "--count", 3, "--size", 40, 30, "--error", 0.2,
              cwd=tmp_path)
    frames = [vernier.read(path) for path in sorted((tmp_path / "frames").iterdir())]
    assert len(frames) == 3 and len(out.splitlines()) == 3
    for frame in frames:
        assert frame.error.rel_rmse <= 0.2
        assert frame.metadata["vernier:stoppedBy"] == "error"
    assert not np.array_equal(frames[0].pixels, frames[1].pixels)


def test_error_over_time(tmp_path):
    pytest.importorskip("matplotlib", reason="matplotlib is not installed")
    out = run("error_over_time.py", SCENES / "cornell_box.gltf", "chart.png", "--size", 24, 18, "--most", 16, cwd=tmp_path)
    assert len(out.splitlines()) == 4
    chart = vernier.read(tmp_path / "chart.png").pixels
    assert chart.shape[0] > 300 and chart.min() < 0.1 < 0.9 < chart.max()
