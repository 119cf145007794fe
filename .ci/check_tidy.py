#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Runs clang-tidy with the checks of .clang-tidy over every source file, on all processors.

What passed is remembered by the content that the compiler sees, as ccache does, so that only what changed is looked at
again. Usage: check_tidy.py [--minutes N] [FILE...]
"""

import argparse
import concurrent.futures
import hashlib
import json
import os
import pathlib
import shlex
import subprocess
import sys
import time

ROOT = pathlib.Path(__file__).resolve().parent.parent
BUILDS = [ROOT / "build" / "release", ROOT / "build" / "python"]  # the latter where .ci/test_python has run
DATABASE = BUILDS[0] / "tidy"
CACHE = pathlib.Path(os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache") / "vernier-tidy"


def without_precompiled(command):
    """The command without the use of precompiled headers, which only save time and which no other compiler reads."""
    unwanted = {"-fpch-preprocess", "-Winvalid-pch", "-Xclang", "-include", "-include-pch"}
    return [word for word in shlex.split(command) if word not in unwanted and "cmake_pch" not in word]


def entries_to_check():
    """Those of the compilation databases that are source files; the database for clang-tidy is written on the way."""
    found = {}
    for build in BUILDS:
        if build == BUILDS[0] or (build / "compile_commands.json").exists():
            for entry in json.loads((build / "compile_commands.json").read_text(encoding="utf-8")):
                found.setdefault(entry["file"], entry)
    entries = [{**entry, "command": shlex.join(without_precompiled(entry["command"]))} for entry in found.values()
               if "cmake_pch" not in entry["file"]]
    DATABASE.mkdir(parents=True, exist_ok=True)
    (DATABASE / "compile_commands.json").write_text(json.dumps(entries), encoding="utf-8")
    return entries


def preprocessed(entry):
    """The file with all it includes, comments kept (they can silence checks), without paths."""
    words = shlex.split(entry["command"])
    command = words[:1] + ["-E", "-P", "-C"]
    skip = False
    for word in words[1:]:
        if skip or word in ("-c", "-MD"):
            skip = False
        elif word in ("-o", "-MT", "-MF"):
            skip = True
        else:
            command.append(word)
    return subprocess.run(command, cwd=entry["directory"], check=True, capture_output=True).stdout


def checks_of(path):
    """Every .clang-tidy from the root down to the file's folder."""
    folders = [folder for folder in [path.parent, *path.parent.parents] if folder.is_relative_to(ROOT)]
    return b"".join((folder / ".clang-tidy").read_bytes() for folder in folders if (folder / ".clang-tidy").is_file())


def check(entry, version, deadline):
    """The path, what clang-tidy has to say of it, and what became of it: known, passed, failed or left."""
    path = pathlib.Path(entry["file"])
    if time.monotonic() > deadline:
        return path, "", "left"
    key = hashlib.sha256(version + checks_of(path) + preprocessed(entry)).hexdigest()
    stamp = CACHE / key
    if stamp.exists():
        return path, "", "known"
    run = subprocess.run(["clang-tidy", "--quiet", "-p", str(DATABASE), "--extra-arg=-Wno-unknown-warning-option",
                          str(path)], capture_output=True, text=True, check=False)
    if run.returncode == 0:
        stamp.touch()
        return path, "", "passed"
    return path, run.stdout + run.stderr, "failed"


def by_last_change(entries):
    """The entries, those first whose files were committed last: what time is left for is what may be new."""
    log = subprocess.run(["git", "log", "--format=", "--name-only"], cwd=ROOT, check=True, capture_output=True, text=True)
    age = {}
    for name in log.stdout.splitlines():
        age.setdefault(str(ROOT / name), len(age))
    return sorted(entries, key=lambda entry: age.get(entry["file"], -1))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("files", nargs="*", metavar="FILE")
    parser.add_argument("--minutes", type=float, default=float("inf"),
                        help="begin no file after that; those left are told, and the next run goes on with them")
    arguments = parser.parse_args()
    deadline = time.monotonic() + 60 * arguments.minutes
    CACHE.mkdir(parents=True, exist_ok=True)
    version = subprocess.run(["clang-tidy", "--version"], check=True, capture_output=True).stdout
    wanted = {str(pathlib.Path(name).resolve()) for name in arguments.files}
    entries = by_last_change([entry for entry in entries_to_check() if not wanted or entry["file"] in wanted])
    counts = {"known": 0, "passed": 0, "failed": 0, "left": 0}
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for path, report, outcome in pool.map(lambda entry: check(entry, version, deadline), entries):
            counts[outcome] += 1
            if report:
                print(f"{path.relative_to(ROOT)}:\n{report}", flush=True)
    print(f"clang-tidy: {len(entries)} files, {counts['known']} of them unchanged since they passed, "
          f"{counts['failed']} with problems, {counts['left']} left for want of time")
    return 1 if counts["failed"] or not entries else 0


if __name__ == "__main__":
    sys.exit(main())
