# SPDX-License-Identifier: Apache-2.0
"""What rivals can render with: for each how it is called, and what it took."""
import dataclasses
import json
import os
import pathlib
import re
import shlex
import shutil
import subprocess
import time

import numpy
import OpenImageIO

HERE = pathlib.Path(__file__).resolve().parent


class Failed(Exception):
    """A renderer ended without a picture."""


@dataclasses.dataclass
class Job:
    scene: str
    environment: str  # file; empty: none
    width: int
    height: int
    spp: int
    seed: int
    threads: int
    depth: int


@dataclasses.dataclass
class Run:
    picture: numpy.ndarray
    seconds: float  # by the clock on the wall, of the whole process
    processor_seconds: float  # of all its threads
    memory: int  # bytes, largest resident size
    version: str
    command: str


class Renderer:
    """One way to render. `converts`: takes scenes through comparable.py, and so only such as that can tell."""

    def __init__(self, name, program, script=None, converts=False, **choices):
        self.name, self.converts = name, converts
        self._program, self._script, self._choices = program, script, choices

    def render(self, job, folder):
        picture = pathlib.Path(folder) / ("picture.npy" if self._script else "picture.exr")
        picture.unlink(missing_ok=True)
        command = self._command(job, folder, picture)
        text, seconds, usage, code = _timed(command, pathlib.Path(folder) / "output.txt")
        if code or not picture.exists():
            raise Failed(f"{shlex.join(command)}\nended with {code}:\n{text[-2000:]}")
        values = numpy.load(picture) if self._script else read_rgb(picture)
        told = re.search(r"^RIVAL (.*)$", text, re.M)
        version = told.group(1) if told else _version_of(self._program)
        return Run(values, seconds, usage.ru_utime + usage.ru_stime, usage.ru_maxrss * 1024, version,
                   shlex.join(command))

    def _command(self, job, folder, picture):
        if not self._script:
            command = [*self._program, "render", job.scene, "-o", str(picture),
                       "--resolution", f"{job.width}x{job.height}", "--spp", str(job.spp), "--seed", str(job.seed),
                       "--threads", str(job.threads), "--max-depth", str(job.depth), "--filter", "box", "--quiet"]
            return [*command, "--env", job.environment or "none"]
        description = {**dataclasses.asdict(job), "picture": str(picture), **self._choices}
        file = pathlib.Path(folder) / "job.json"
        file.write_text(json.dumps(description, indent=1), encoding="utf-8")
        return [*self._program, str(HERE / self._script), *(["--"] if "-P" in self._program else []), str(file)]


def read_rgb(path):
    """The first three channels of a picture, as an array of height x width x 3."""
    return OpenImageIO.ImageBuf(str(path)).get_pixels(OpenImageIO.FLOAT)[:, :, :3]


def _timed(command, output):
    """Runs it; its output, seconds, resources and exit code. To a file: a pipe would have to be read meanwhile."""
    start = time.monotonic()
    with open(output, "w", encoding="utf-8") as file:
        process = subprocess.Popen(command, stdout=file, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL)
        _, status, usage = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    text = pathlib.Path(output).read_text(encoding="utf-8", errors="replace")
    return text, time.monotonic() - start, usage, process.returncode


def _version_of(program):
    done = subprocess.run([*program, "--version"], capture_output=True, text=True, check=False)
    return " ".join(done.stdout.split()[:2])


def _works(python, code):
    if not python or not shutil.which(python):
        return False
    return subprocess.run([python, "-c", code], capture_output=True, check=False).returncode == 0


def _has(python, module):
    return _works(python, f"import importlib.util, sys; sys.exit(not importlib.util.find_spec('{module}'))")


def _mitsuba_variant(python):
    """The vectorized one, where its compiler knows the processor: some LLVMs end the process."""
    test = ("import mitsuba; mitsuba.set_variant('llvm_ad_rgb'); "
            "print(mitsuba.render(mitsuba.load_dict(mitsuba.cornell_box()), spp=1)[0, 0, 0])")
    return "llvm_ad_rgb" if _works(python, test) else "scalar_rgb"


def installed(programs):
    """Those that are there, of programs by name: vernier, blender, and Pythons for bpy, mitsuba, pyluxcore."""
    found = [Renderer("Vernier", [programs["vernier"]])]
    if programs["blender"] and shutil.which(programs["blender"]):
        blender = [programs["blender"], "-b", "--factory-startup", "-P"]
        found.append(Renderer("Cycles (blender)", blender, "in_cycles.py", guiding=False))
    if _has(programs["bpy"], "bpy"):
        for guiding, name in ((False, "Cycles (bpy)"), (True, "Cycles (bpy), guided")):
            found.append(Renderer(name, [programs["bpy"]], "in_cycles.py", guiding=guiding))
    if _has(programs["mitsuba"], "mitsuba"):
        found.append(Renderer("Mitsuba", [programs["mitsuba"]], "in_mitsuba.py", converts=True,
                              variant=_mitsuba_variant(programs["mitsuba"])))
    if _has(programs["pyluxcore"], "pyluxcore"):
        found.append(Renderer("LuxCore", [programs["pyluxcore"]], "in_luxcore.py", converts=True))
    return found
