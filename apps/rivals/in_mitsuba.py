# SPDX-License-Identifier: Apache-2.0
"""Renders a job of rivals in Mitsuba 3: in_mitsuba.py JOB.json, by the Python that has its wheel."""
import json
import sys

import drjit
import mitsuba
import numpy

from comparable import Scene


def bsdf(material):
    if material["is_metal"]:
        inner = {"type": "principled", "base_color": rgb(material["color"]), "metallic": 1.0,
                 "roughness": max(material["roughness"], 1e-3), "specular": 0.5}
    else:
        inner = {"type": "diffuse", "reflectance": rgb(material["color"])}
    return {"type": "twosided", "inner": inner} if material["two_sided"] else inner


def rgb(color):
    return {"type": "rgb", "value": list(map(float, color))}


def mesh(part):
    """A mesh by its arrays; normals are those of the faces."""
    emission = part["material"]["emission"]
    properties = mitsuba.Properties()
    properties["bsdf"] = mitsuba.load_dict(bsdf(part["material"]))
    if max(emission) > 0:
        properties["emitter"] = mitsuba.load_dict({"type": "area", "radiance": rgb(emission)})
    properties["face_normals"] = True
    made = mitsuba.Mesh("mesh", len(part["positions"]), len(part["triangles"]), props=properties)
    values = mitsuba.traverse(made)
    values["vertex_positions"] = part["positions"].ravel()
    values["faces"] = part["triangles"].ravel()
    values.update()
    return made


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        job = json.load(file)
    mitsuba.set_variant(job["variant"])
    drjit.set_thread_count(job["threads"])
    scene = Scene(job["scene"])
    # glTF's camera looks along -z, Mitsuba's along +z with x to the left: half a turn about y.
    to_world = numpy.array(scene.camera["to_world"]) @ numpy.diag([-1.0, 1, -1, 1])
    parts = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": job["depth"] + 1},
        "sensor": {"type": "perspective", "fov": scene.camera["yfov"], "fov_axis": "y",
                   "to_world": mitsuba.ScalarTransform4f(to_world),
                   "sampler": {"type": "multijitter", "sample_count": job["spp"], "seed": job["seed"]},
                   "film": {"type": "hdrfilm", "width": job["width"], "height": job["height"],
                            "pixel_format": "rgb", "component_format": "float32", "rfilter": {"type": "box"}}},
    }
    if job["environment"]:
        # Its picture begins half a turn away from glTF viewers'.
        parts["environment"] = {"type": "envmap", "filename": job["environment"],
                                "to_world": mitsuba.ScalarTransform4f().rotate([0, 1, 0], 180)}
    for i, part in enumerate(scene.meshes):
        parts[f"mesh{i}"] = mesh(part)
    for i, lamp in enumerate(scene.lamps):
        parts[f"lamp{i}"] = {"type": "point", "position": lamp["position"], "intensity": rgb(lamp["intensity"])}
    picture = mitsuba.render(mitsuba.load_dict(parts), spp=job["spp"], seed=job["seed"])
    numpy.save(job["picture"], numpy.array(picture)[..., :3].astype(numpy.float32))
    print(f"RIVAL Mitsuba {mitsuba.__version__}, {mitsuba.variant()}, path, multijitter")


main()
