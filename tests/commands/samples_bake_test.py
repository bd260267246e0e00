#!/usr/bin/env python3
"""Every recipe in samples/ bakes, with voxels six times as large: one frame of it, which holds something.

usage: samples_bake_test.py SAMPLES_FOLDER
Depends on programs.py.
"""
import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

import programs

COARSER = 6.0
COARSE_TOLERANCE = "30%"


def coarse(text):
    """The recipe with larger voxels; one of a tolerance with a larger one."""
    text = re.sub(r"(voxel_size: )([0-9.e-]+)", lambda m: f"{m[1]}{COARSER * float(m[2]):.6g}", text)
    return re.sub(r"tolerance: [0-9.]+%", f"tolerance: {COARSE_TOLERANCE}", text)


def fault_of(recipe):
    """What is wrong with a recipe as a sentence, or None."""
    text = recipe.read_text()
    recipe.write_text(coarse(text))
    frames = re.search(r"frames: (\d+)-(\d+)", text)
    middle = (int(frames[1]) + int(frames[2])) // 2 if frames else None
    chosen = ["--frames", f"{middle}-{middle}"] if frames else []
    done = programs.run([programs.BAKE, recipe.name, "--report", "-", *chosen], recipe.parent)
    if done.returncode != 0:
        return f"exit {done.returncode}: {done.stderr.strip()}"
    record = json.loads(done.stdout)["assets"][0]
    return None if record["voxels_active"] > 0 and record["mass"]["stored"] > 0 else "holds nothing"


def main():
    with tempfile.TemporaryDirectory() as folder:
        samples = Path(shutil.copytree(sys.argv[1], Path(folder) / "samples"))
        recipes = sorted(samples.glob("*.yaml"))
        faults = [f"{recipe.name}: {fault}" for recipe in recipes if (fault := fault_of(recipe))]
    print(f"{len(recipes)} samples, {len(faults)} faults", *faults, sep="\n")
    return 1 if faults or not recipes else 0


if __name__ == "__main__":
    sys.exit(main())
