# SPDX-License-Identifier: Apache-2.0
"""Renders a job of rivals in LuxCore: in_luxcore.py JOB.json, by the Python that has its wheel."""
import json
import math
import sys
import time

import numpy
import pyluxcore

from comparable import Scene


def add_material(properties, name, material):
    key = f"scene.materials.{name}"
    if material["is_metal"]:
        roughness = max(material["roughness"] ** 2, 1e-6)
        properties.SetFromString(f"""
            scene.textures.{name}.type = "fresnelcolor"
            scene.textures.{name}.kr = {words(material["color"])}
            {key}.type = "metal2"
            {key}.fresnel = "{name}"
            {key}.uroughness = {roughness}
            {key}.vroughness = {roughness}""")
    else:
        properties.SetFromString(f"""
            {key}.type = "matte"
            {key}.kd = {words(material["color"])}""")
    if max(material["emission"]) > 0:
        properties.SetFromString(f"{key}.emission = {words(material['emission'])}")


def words(values):
    return " ".join(repr(float(value)) for value in values)


def add_mesh(scene, properties, number, part):
    name = f"part{number}"
    points, triangles = (list(map(tuple, part[key].tolist())) for key in ("positions", "triangles"))
    scene.DefineMesh(name, points, triangles, None, None, None, None)
    add_material(properties, name, part["material"])
    properties.SetFromString(f"""
        scene.objects.{name}.shape = "{name}"
        scene.objects.{name}.material = "{name}" """)


def add_camera(properties, camera, aspect):
    matrix = numpy.array(camera["to_world"])
    place, back, up = matrix[:3, 3], matrix[:3, 2], matrix[:3, 1]
    # Which side of the picture the angle is meant for without a window depends on LuxCore's version.
    properties.SetFromString(f"""
        scene.camera.lookat.orig = {words(place)}
        scene.camera.lookat.target = {words(place - back)}
        scene.camera.up = {words(up)}
        scene.camera.fieldofview = {camera["yfov"]}
        scene.camera.screenwindow = {words((-aspect, aspect, -1, 1))}""")


def configuration(job):
    properties = pyluxcore.Properties()
    properties.SetFromString(f"""
        renderengine.type = "PATHCPU"
        sampler.type = "SOBOL"
        renderengine.seed = {job["seed"]}
        native.threads.count = {job["threads"]}
        path.pathdepth.total = {job["depth"]}
        path.pathdepth.diffuse = {job["depth"]}
        path.pathdepth.glossy = {job["depth"]}
        path.pathdepth.specular = {job["depth"]}
        path.clamping.variance.maxvalue = 0
        film.width = {job["width"]}
        film.height = {job["height"]}
        film.filter.type = "NONE"
        batch.haltspp = {job["spp"]}
        film.imagepipelines.0.0.type = "NOP"
        film.outputs.0.type = "RGB"
        film.outputs.0.filename = "unused.exr" """)
    return properties


def main():
    with open(sys.argv[1], encoding="utf-8") as file:
        job = json.load(file)
    pyluxcore.Init()
    described, scene, properties = Scene(job["scene"]), pyluxcore.Scene(), pyluxcore.Properties()
    add_camera(properties, described.camera, job["width"] / job["height"])
    for number, part in enumerate(described.meshes):
        add_mesh(scene, properties, number, part)
    for number, lamp in enumerate(described.lamps):
        properties.SetFromString(f"""
            scene.lights.lamp{number}.type = "point"
            scene.lights.lamp{number}.position = {words(lamp["position"])}
            scene.lights.lamp{number}.gain = {words(4 * math.pi * value for value in lamp["intensity"])}""")
    if job["environment"]:
        properties.SetFromString(f"""
            scene.lights.sky.type = "infinite"
            scene.lights.sky.file = "{job["environment"]}" """)
    scene.Parse(properties)
    session = pyluxcore.RenderSession(pyluxcore.RenderConfig(configuration(job), scene))
    session.Start()
    while not session.HasDone():
        time.sleep(0.02)
        session.UpdateStats()
    session.Stop()
    values = numpy.zeros(job["width"] * job["height"] * 3, numpy.float32)
    session.GetFilm().GetOutputFloat(pyluxcore.FilmOutputType.RGB, values, 0, True)
    # Its rows begin at the bottom.
    numpy.save(job["picture"], values.reshape(job["height"], job["width"], 3)[::-1])
    print(f"RIVAL LuxCore {pyluxcore.Version()}, PATHCPU, SOBOL")


main()
