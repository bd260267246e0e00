#!/usr/bin/env python3
"""The default cumulus lies inside the stability map, in its own scene and in the one without; long steps do not.

usage: trust_warnings.py BAKE PREVIEW PIPELINE     exit 1 where a warning is missing or wrong
Depends on Python's standard library alone.
"""
import subprocess
import sys
import tempfile
from pathlib import Path

WARNING = "; error up to "


def main():
    bake, preview, pipeline = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([bake, pipeline, "--out", folder, "--quiet"], check=True)

        def talk(*options):
            return subprocess.run([preview, str(Path(folder) / "cumulus.vdb"), "--render", str(Path(folder) / "a.exr"), "--size",
                                   "32x18", "--spp", "1", *options], check=True, capture_output=True, text=True).stderr

        for options in ([], ["--scene", pipeline]):
            if WARNING in (said := talk(*options)):
                sys.exit(f"the default cumulus is warned of:\n{said}")
        if "march: steps are too long" + WARNING not in (said := talk("--step", "16")):
            sys.exit(f"steps of 16 voxels are not warned of:\n{said}")


main()
