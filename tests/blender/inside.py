# SPDX-License-Identifier: Apache-2.0
"""Runs one module of tests within the Python that has been started for it."""
import importlib
import os
import sys
import unittest


def main(module: str) -> None:
    suite = unittest.defaultTestLoader.loadTestsFromModule(importlib.import_module(module))
    result = unittest.TextTestRunner(stream=sys.stderr, verbosity=2).run(suite)
    sys.stdout.flush()
    # At once: Blender would go on to its own end, and take the exit code with it.
    os._exit(0 if result.wasSuccessful() and result.testsRun else 1)
