#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that folders include only leftward (vernier <- core <- materials <- scene <- integrators <- apps) and that third-party
headers stay in the files that wrap them."""

import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
ORDER = ["include", "core", "materials", "scene", "integrators", "apps"]

# Headers whose name matches may only be included by files whose path matches.
WRAPPED = [
    (r"embree[34]/.*", r"scene/accel/embree[^/]*\.(cpp|h)"),
    (r"tiny_gltf\.h", r"scene/import/.*"),
    (r"OpenImageIO/hash\.h", r"core/(base/fingerprint|image/[^/]*)\.cpp"),
    (r"OpenImageIO/(?!hash\.h).*", r"(core/(image|denoise)/[^/]*|tests/core/.*)\.cpp"),
    (r"OpenColorIO/.*", r"(core/display/[^/]*|tests/core/.*)\.cpp"),
    (r"(draco/.*|meshoptimizer\.h)", r"(tests/)?scene/(import/)?[^/]*\.cpp"),
    (r"avif/.*", r"core/image/avif\.cpp"),
    (r"zstd\.h", r"(core/ktx2/level|tests/core/.*)\.cpp"),
    (r"CLI/.*", r"apps/.*"),
    (r"httplib\.h", r"apps/serve/(http_server|routes|workers)\.(cpp|h)"),
    (r"(gtest|gmock)/.*", r"tests/.*"),
]
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]', re.MULTILINE)


def problems_of(path):
    folder = path.split("/")[0]
    for bracket, header in INCLUDE.findall((ROOT / path).read_text(encoding="utf-8")):
        first = "include" if header.startswith("vernier/") else header.split("/")[0]
        if bracket == '"' and "/" in header:
            if folder != "tests" and (first == "tests" or
                                      first in ORDER and ORDER.index(first) > ORDER.index(folder)):
                yield f"{path} includes {header}: {folder} may not see {first}"
            if first in ORDER + ["tests"] and not any((ROOT / root / header).is_file() for root in (".", "include")):
                yield f"{path} includes {header}, which does not exist"
        for wrapped, allowed in WRAPPED:
            if re.fullmatch(wrapped, header) and not re.fullmatch(allowed, path):
                yield f"{path} includes {header}; only {allowed} may"


def main():
    paths = [str(p.relative_to(ROOT)) for folder in ORDER + ["tests"] for pattern in ("*.h", "*.cpp")
             for p in sorted((ROOT / folder).rglob(pattern))]
    problems = [problem for path in paths for problem in problems_of(path)]
    print("\n".join(problems) if problems else f"{len(paths)} files, no include points the wrong way")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main())
