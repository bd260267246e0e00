#!/usr/bin/env python3
"""Every recipe in samples/ loads, and names one asset after its file: one file, or frames without a gap.

usage: samples_test.py SAMPLES_FOLDER
Depends on programs.py.
"""
import re
import sys
from pathlib import Path

import programs


def fault_of(recipe):
    """What is wrong with a recipe as a sentence, or None."""
    done = programs.run([programs.BAKE, str(recipe), "--dry-run", "--out", "out"], recipe.parent)
    if done.returncode != 0:
        return f"exit {done.returncode}: {done.stderr.strip()}"
    baked = done.stdout.split()
    first = re.fullmatch(rf"out/{re.escape(recipe.stem)}_(\d{{4}})\.vdb", baked[0] if baked else "")
    expected = [f"out/{recipe.stem}.vdb"]
    if first:
        start = int(first.group(1))
        expected = [f"out/{recipe.stem}_{frame:04d}.vdb" for frame in range(start, start + len(baked))]
    return None if baked == expected else f"bakes {baked} instead of {expected}"


def main():
    recipes = sorted(Path(sys.argv[1]).glob("*.yaml"))
    faults = [f"{recipe.name}: {fault}" for recipe in recipes if (fault := fault_of(recipe))]
    print(f"{len(recipes)} samples, {len(faults)} faults", *faults, sep="\n")
    return 1 if faults or not recipes else 0


if __name__ == "__main__":
    sys.exit(main())
