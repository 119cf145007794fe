#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks that every source file names its licence in its first lines. With --fix the line is added where it is missing."""

import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent
TAG = "SPDX-License-Identifier: Apache-2.0"
# How a comment begins and ends, by what the name of the file ends with.
COMMENTS = {
    (".cpp", ".h", ".hpp", ".js", ".cpp.in", ".h.in"): ("// ", ""),
    (".css",): ("/* ", " */"),
    (".py", ".sh", ".cmake", ".yml", ".yaml", "CMakeLists.txt", "Containerfile", "Doxyfile", ".ci/run", ".ci/check_format",
     ".ci/test_sanitized", "tests/fuzz/run", "tests/farm/slurm", "tests/blender/run", "tests/rivals/run",
     "apps/blender/make_zip", "apps/rivals/rivals", "docs/pictures/make_khronos_models", ".toml"):
        ("# ", ""),
}


def comment_of(path):
    return next((comment for endings, comment in COMMENTS.items() if path.endswith(endings)), None)


def add(file, comment):
    """Writes the line first, or after the line that names the interpreter."""
    lines = file.read_text(encoding="utf-8").splitlines(keepends=True)
    lines.insert(1 if lines and lines[0].startswith("#!") else 0, f"{comment[0]}{TAG}{comment[1]}\n")
    file.write_text("".join(lines), encoding="utf-8")


def main():
    listed = subprocess.run(["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"], cwd=ROOT, check=True,
                            capture_output=True, text=True).stdout
    sources = [(path, comment_of(path)) for path in listed.split("\0")]
    sources = [(path, comment) for path, comment in sources if comment and (ROOT / path).is_file()]
    bare = [(path, comment) for path, comment in sources
            if not any(TAG in line for line in (ROOT / path).read_text(encoding="utf-8").splitlines()[:2])]
    if "--fix" in sys.argv[1:]:
        for path, comment in bare:
            add(ROOT / path, comment)
        return 0
    for path, comment in bare:
        print(f"{path}: no licence in its first two lines; expected: {comment[0]}{TAG}{comment[1]} "
              "(.ci/check_spdx.py --fix adds it)")
    print(f"{len(sources)} source files, {len(bare)} without a licence")
    return 1 if bare or not sources else 0


if __name__ == "__main__":
    sys.exit(main())
