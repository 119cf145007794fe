# SPDX-License-Identifier: Apache-2.0
"""`blender -b FILE -E VERNIER`, as render farms call it."""
import os
import signal
import subprocess
import tempfile
import time
import unittest

import bpy
import pictures
from vernier_blender.exr import read_channels

PATIENCE = 120  # seconds


def command(blend: str, *arguments: str) -> list[str]:
    return [bpy.app.binary_path, "-b", "--factory-startup", "--addons", "vernier_blender", blend, "-E", "VERNIER",
            *arguments]


def saved_scene(folder: str, samples: int) -> str:
    scene = pictures.new_scene()
    pictures.add_cube(2)
    pictures.add_lamp("SUN", energy=2)
    scene.vernier.samples = samples
    blend = os.path.join(folder, "cube.blend")
    bpy.ops.wm.save_as_mainfile(filepath=blend)
    return blend


@unittest.skipUnless(bpy.app.binary_path, "Blender is a Python module here")
class FromShell(unittest.TestCase):
    def test_a_frame(self):
        with tempfile.TemporaryDirectory() as folder:
            blend = saved_scene(folder, 4)
            done = subprocess.run(command(blend, "-o", folder + "/out_####", "-F", "OPEN_EXR", "-f", "1"), check=True,
                                  capture_output=True, text=True)
            self.assertIn("Vernier: Error ", done.stdout)
            self.assertGreater(read_channels(folder + "/out_0001.exr")["R"].max(), 0)

    def test_an_interrupt_ends_all_processes(self):
        with tempfile.TemporaryDirectory() as folder:
            blend = saved_scene(folder, 1000000000)
            process = subprocess.Popen(command(blend, "-o", folder + "/out_####", "-f", "1"), stdout=subprocess.PIPE,
                                       stderr=subprocess.STDOUT, text=True, start_new_session=True)
            try:
                for line in process.stdout:
                    if "samples a pixel" in line:
                        break
                process.send_signal(signal.SIGINT)
                process.communicate(timeout=PATIENCE)
                self.assert_all_ended(process.pid)
            finally:
                if process.poll() is None:
                    os.killpg(process.pid, signal.SIGKILL)

    def assert_all_ended(self, group: int):
        """Of the processes that Blender has started, too."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            try:
                os.killpg(group, 0)
            except ProcessLookupError:
                return
            time.sleep(0.1)
        self.fail("a process goes on")
