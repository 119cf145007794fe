# SPDX-License-Identifier: Apache-2.0
"""Following other programs, and what Vernier tells."""
import itertools
import os
import pathlib
import sys
import tempfile
import types
import unittest

from vernier_blender import command
from vernier_blender.line_process import LineProcess, Stopped

SCENE = str(pathlib.Path(__file__).resolve().parents[1] / "scenes" / "cornell_box.gltf")
SMALL = ["--size", "32x32", "--spp", "4"]


def never() -> bool:
    return False


class Lines(unittest.TestCase):
    def test_are_read_until_the_end(self):
        process = LineProcess([sys.executable, "-c", "print(1); print(2)"])
        self.assertEqual(list(process.lines(never)), ["1", "2"])
        self.assertEqual(process.exit_code(), 0)

    def test_answers_follow_requests(self):
        process = LineProcess([sys.executable, "-uc", "import sys\nfor line in sys.stdin: print(int(line) + 1)"])
        for number in (3, 7):
            process.write(str(number))
            self.assertEqual(next(process.lines(never)), str(number + 1))
        process.end()
        self.assertNotEqual(process.exit_code(), None)

    def test_a_silent_process_can_be_stopped(self):
        process = LineProcess([sys.executable, "-c", "import time; time.sleep(600)"])
        looks = itertools.count()
        with self.assertRaises(Stopped):
            list(process.lines(lambda: next(looks) > 2))
        process.finish()
        self.assertLess(process.exit_code(), 0)


class Commands(unittest.TestCase):
    def run_vernier(self, flags, should_stop=never, on_preview=None, scene=SCENE):
        """Returns the outcome, the states that were told, and the files that were written."""
        states = []
        with tempfile.TemporaryDirectory() as folder:
            watcher = command.Watcher(should_stop, lambda fraction, text: states.append((fraction, text)), on_preview)
            outcome = command.run("vernier", scene, folder + "/out.exr", flags, watcher)
            return outcome, states, os.listdir(folder)

    def test_error_of_the_picture_is_told(self):
        outcome, _, files = self.run_vernier(SMALL)
        self.assertTrue(0 < outcome.error["low"] <= outcome.error["rel_rmse"] <= outcome.error["high"])
        self.assertEqual(round(outcome.samples_per_pixel), 4)
        self.assertEqual(files, ["out.exr"])

    def test_stopping_keeps_the_picture_so_far(self):
        seen = []
        outcome, states, files = self.run_vernier(
            ["--size", "32x32", "--spp", "1000000000", "--time", "5m"], lambda: len(seen) > 0, lambda: seen.append(1))
        self.assertTrue(outcome.was_stopped)
        self.assertTrue(states)
        self.assertTrue(seen)  # one more may be written while the program ends
        self.assertEqual(files, ["out.exr"])

    def test_failures_are_the_commands_own_words(self):
        with self.assertRaisesRegex(command.RenderError, "unknown flag '--sppp'"):
            self.run_vernier(["--sppp", "4"])
        with self.assertRaisesRegex(command.RenderError, "no_such.gltf"):
            self.run_vernier(SMALL, scene="/no_such.gltf")


class Flags(unittest.TestCase):
    def flags(self, **changes) -> list[str]:
        settings = {"integrator": "path", "max_depth": 16, "pixel_filter": "box", "seed": 0, "use_adaptive": True,
                    "samples": 64, "time_limit": 0, "error": 0, "denoiser": "none", "further_flags": "", **changes}
        render = types.SimpleNamespace(threads_mode="AUTO", threads=1, film_transparent=False)
        return command.render_flags(types.SimpleNamespace(**settings), render, [])

    def test_limits(self):
        self.assertEqual(self.flags()[-2:], ["--spp", "64"])
        flags = self.flags(samples=0, time_limit=90, error=1.5)
        self.assertEqual(flags[-4:], ["--time", "90s", "--error", "1.5%"])

    def test_further_flags_are_quoted_as_for_a_shell(self):
        self.assertEqual(self.flags(further_flags="--report 'my page.html'")[-2:], ["--report", "my page.html"])

    def test_states(self):
        event = {"samples_per_pixel": 7, "rel_rmse": 0.0123, "low": 0.012, "high": 0.0126}
        self.assertEqual(command.describe_state(event), "Error 1.23 % (1.2 to 1.26 %), 7 samples a pixel")
        self.assertEqual(command.describe_state({"samples_per_pixel": 7}), "7 samples a pixel")
