#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A turntable: the camera goes once around the scene, and each frame is rendered to the same error.

    python turntable.py scene.glb frames --count 36 --error 0.05
    ffmpeg -i frames/%03d.png turntable.mp4
"""

import argparse
import math
import pathlib

import vernier


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=36)
    parser.add_argument("--size", type=int, nargs=2, default=(480, 360), metavar=("W", "H"))
    parser.add_argument("--error", type=float, default=0.05, help="relative RMSE")
    arguments = parser.parse_args()
    size = tuple(arguments.size)
    scene = vernier.load(arguments.scene)
    sides = [scene.fitted_camera(size, azimuth=2 * math.pi * i / arguments.count, elevation=0.35, margin=0.15)
             for i in range(arguments.count)]
    # One distance for all, so that the scene does not breathe: the farthest that any side needs.
    center = scene.bounds.mean(0)
    distance = max(math.dist(side.matrix[:3, 3], center) for side in sides)
    arguments.out.mkdir(parents=True, exist_ok=True)
    for i, side in enumerate(sides):
        camera = vernier.Camera.look_at(center + distance * side.matrix[:3, 2], center, yfov=side.yfov)
        image = vernier.render(scene, camera=camera, size=size, error=arguments.error, env="studio", ground="matte")
        path = arguments.out / f"{i + 1:03}.png"
        image.save(path)
        print(f"{path}: {image.stats['samples_per_pixel']:.4g} spp, error {image.error}")


if __name__ == "__main__":
    main()
