#!/usr/bin/env python3
"""Bakes a recipe, imports the file into Blender, and holds what Blender sees against `info`.

usage: blender_test.py PIPELINE NAME      the asset NAME of a recipe; exit 77 where there is no Blender
Depends on programs.py; the part inside Blender is blender_import.py.
"""
import json
import shutil
import subprocess
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
        # The system's Python alone: another one's variables would keep Blender from starting.
        blender = ["env", "-u", "PYTHONHOME", "-u", "PYTHONPATH", "blender", "-b", "--factory-startup", "-noaudio",
                   "--python-exit-code", "1", "--python", str(script), "--", f"{folder}/{name}.vdb", str(expected)]
        return subprocess.run(blender, stdin=subprocess.DEVNULL, timeout=LIMIT_SECONDS).returncode


if __name__ == "__main__":
    sys.exit(main())
