#!/usr/bin/env python3
"""Every recipe in samples/ loads, and names one asset after its file.

usage: samples_test.py SAMPLES_FOLDER
Depends on programs.py.
"""
import sys
from pathlib import Path

import programs


def fault_of(recipe):
    """What is wrong with a recipe as a sentence, or None."""
    done = programs.run([programs.BAKE, str(recipe), "--dry-run", "--out", "out"], recipe.parent)
    if done.returncode != 0:
        return f"exit {done.returncode}: {done.stderr.strip()}"
    expected = str(Path("out") / f"{recipe.stem}.vdb")
    return None if done.stdout.split() == [expected] else f"bakes {done.stdout.split()} instead of {expected}"


def main():
    recipes = sorted(Path(sys.argv[1]).glob("*.yaml"))
    faults = [f"{recipe.name}: {fault}" for recipe in recipes if (fault := fault_of(recipe))]
    print(f"{len(recipes)} samples, {len(faults)} faults", *faults, sep="\n")
    return 1 if faults or not recipes else 0


if __name__ == "__main__":
    sys.exit(main())
