#!/usr/bin/env python3
"""Bakes a recipe, imports the file into Blender, and holds what Blender sees against `info`.

usage: blender_test.py PIPELINE NAME      the asset NAME of a recipe; exit 77 where there is no Blender
Depends on programs.py; the part inside Blender is blender_import.py.
"""
import json
import shutil
import sys
import tempfile
from pathlib import Path

import programs

LIMIT_SECONDS = 180


def main():
    pipeline, name = sys.argv[1:]
    if shutil.which("blender") is None:
        print("left out: there is no blender on this machine (scripts/test installs it)")
        return programs.SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        programs.run_well([programs.BAKE, pipeline, "--only", name, "--out", folder], folder)
        expected = Path(folder) / "expected.json"
        expected.write_text(json.dumps(programs.info(f"{name}.vdb", folder)))
        script = Path(__file__).with_name("blender_import.py")
        return programs.run_in_blender(script, [f"{folder}/{name}.vdb", str(expected)], LIMIT_SECONDS)


if __name__ == "__main__":
    sys.exit(main())
