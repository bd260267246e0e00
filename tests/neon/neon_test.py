#!/usr/bin/env python3
"""Every field gives the same bits on ARM's NEON as on this machine: cross-compiles the fields and field_hashes.cpp, runs
them under qemu-user and compares the lines with those of the program built here.

usage: neon_test.py SOURCE_FOLDER HOST_PROGRAM
Left out, with a sentence, where g++-aarch64-linux-gnu or qemu-user is missing. Depends on Python's standard library.
"""
import os
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

SKIPPED = 77  # the exit code that ctest counts as "left out"
COMPILER, EMULATOR = "aarch64-linux-gnu-g++", "qemu-aarch64"
# As in CMakeLists.txt; below -O2 g++ would not fuse anyway. Only NEON is left of Highway's targets, so that nothing of
# its library is needed.
FLAGS = ["-std=c++20", "-O2", "-ffp-contract=off", "-Wno-psabi", "-DHWY_COMPILE_ONLY_STATIC"]
LIMIT_SECONDS = 300


def sources(root):
    """The fields, what they need of base, and the program."""
    fields = sorted((root / "bake" / "fields").glob("*.cpp"))
    return fields + [root / "base" / "error.cpp", root / "base" / "files.cpp", root / "tests" / "neon" / "no_exr.cpp",
                     root / "tests" / "neon" / "field_hashes.cpp"]


def run(command):
    """Standard output, or an end with what the command said."""
    done = subprocess.run([str(word) for word in command], text=True, capture_output=True, timeout=LIMIT_SECONDS)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit {done.returncode}\n{done.stderr[-4000:]}")
    return done.stdout


def hashes_on_arm(root, folder):
    launcher = [ccache] if (ccache := shutil.which("ccache")) else []

    def compiled(source):
        result = folder / f"{source.stem}.o"
        run([*launcher, COMPILER, *FLAGS, "-I", root, "-c", source, "-o", result])
        return result

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        objects = list(pool.map(compiled, sources(root)))
    run([COMPILER, "-static", *objects, "-o", folder / "field_hashes"])
    return run([EMULATOR, folder / "field_hashes"])


def main():
    missing = [tool for tool in (COMPILER, EMULATOR) if shutil.which(tool) is None]
    if missing:
        print(f"left out: {' and '.join(missing)} missing (Debian: g++-aarch64-linux-gnu, qemu-user)")
        return SKIPPED
    here = run([sys.argv[2]]).splitlines()
    with tempfile.TemporaryDirectory() as folder:
        there = hashes_on_arm(Path(sys.argv[1]), Path(folder)).splitlines()
    differing = [f"here {a}, on ARM {b}" for a, b in zip(here, there) if a != b]
    print(f"{len(here)} lines here, {len(there)} on ARM, {len(differing)} differ", *differing, sep="\n")
    return 0 if here and len(here) == len(there) and not differing else 1


if __name__ == "__main__":
    sys.exit(main())
