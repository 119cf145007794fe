#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""A data set: pictures of a scene from random cameras, with depth, object ids, normals and the cameras themselves.

Each pose is a file OUT/NNNN.npz with the arrays rgb (height, width, 3, uint8), depth (metres along the axis, infinite
where there is nothing), id (0 where there is nothing), normal (world space), camera_to_world (4, 4) and yfov (full vertical
angle, radians), and one PNG to look at. The same seed gives the same files.

    python random_poses.py scene.glb poses --count 100
"""

import argparse
import dataclasses
import pathlib

import numpy as np

import vernier


def random_camera(scene: vernier.Scene, size: tuple[int, int], numbers: np.random.Generator) -> vernier.Camera:
    """From anywhere above the scene, which it sees whole or the middle of."""
    whole = scene.fitted_camera(size, azimuth=numbers.uniform(0, 2 * np.pi), elevation=numbers.uniform(0.1, 1.2))
    return dataclasses.replace(whole, yfov=whole.yfov * numbers.uniform(0.4, 1))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--count", type=int, default=100)
    parser.add_argument("--size", type=int, nargs=2, default=(320, 240), metavar=("W", "H"))
    parser.add_argument("--spp", type=int, default=16)
    parser.add_argument("--seed", type=int, default=0)
    arguments = parser.parse_args()
    scene = vernier.load(arguments.scene)
    if scene.bounds is None:
        parser.error(f"{arguments.scene} has nothing to see")
    arguments.out.mkdir(parents=True, exist_ok=True)
    size = tuple(arguments.size)
    numbers = np.random.default_rng(arguments.seed)
    for pose in range(arguments.count):
        camera = random_camera(scene, size, numbers)
        image = vernier.render(scene, camera=camera, size=size, spp=arguments.spp, seed=pose, env="studio",
                               aov=["depth", "id", "normal"], denoise="nlm")
        rgb = image.to_display()
        name = arguments.out / f"{pose:04}"
        np.savez_compressed(name, rgb=rgb, depth=image.layers["depth"], id=image.layers["id"].astype(np.uint32),
                            normal=image.layers["normal"], camera_to_world=camera.matrix, yfov=camera.yfov)
        image.save(f"{name}.png")
        print(f"{name}: error {image.error}")


if __name__ == "__main__":
    main()
