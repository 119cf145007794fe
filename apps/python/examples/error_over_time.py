#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Error against time: the error that a render tells of itself beside the one that a reference shows, as a chart.

    python error_over_time.py scene.glb chart.png
"""

import argparse

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

import vernier


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scene")
    parser.add_argument("chart", help=".png, .pdf or .svg")
    parser.add_argument("--size", type=int, nargs=2, default=(160, 120), metavar=("W", "H"))
    parser.add_argument("--most", type=int, default=256, help="samples a pixel at the end")
    arguments = parser.parse_args()
    size = tuple(arguments.size)
    scene = vernier.load(arguments.scene)
    # Of another seed, so that the two share no noise; its own error is a quarter of the smallest that is measured.
    reference = vernier.render(scene, size=size, spp=16 * arguments.most, seed=1)

    session = vernier.Session(scene, size=size)
    seconds, told, low, high, actual = [], [], [], [], []
    spp = 2
    while spp <= arguments.most:
        session.run(spp=spp)
        image = session.image(aov=["coverage"])
        seconds.append(image.stats["seconds"])
        told.append(image.error.rel_rmse)
        low.append(image.error.low)
        high.append(image.error.high)
        actual.append(vernier.compare(image, reference)["relmse"]**0.5)
        print(f"{spp:4} spp, {seconds[-1]:.3g} s: error {image.error}, by the reference {100 * actual[-1]:.3g} %")
        spp *= 2

    figure, axes = plt.subplots(figsize=(6, 4), layout="constrained")
    axes.fill_between(seconds, low, high, alpha=0.25, label="its 95 % interval")
    axes.loglog(seconds, told, "o-", label="error that the render tells")
    axes.loglog(seconds, actual, "x--", label="error by a reference")
    axes.set(xlabel="seconds of rendering", ylabel="relative RMSE", title=arguments.scene.rpartition("/")[2])
    axes.legend()
    axes.grid(True, which="both", alpha=0.3)
    figure.savefig(arguments.chart, dpi=120)


if __name__ == "__main__":
    main()
