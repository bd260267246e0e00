#!/usr/bin/env python3
"""Bakes a sequence of 48 frames in coarse voxels, and lets Blender play it: each frame is loaded, and holds what `info` says.

usage: blender_sequence_test.py SAMPLE.yaml NAME      a sample of particles; exit 77 where there is no Blender
Depends on programs.py; the part inside Blender is blender_sequence.py.
"""
import json
import re
import shutil
import sys
import tempfile
from pathlib import Path

import programs

LIMIT_SECONDS = 300
VOXEL_SIZE = 0.1  # coarse, so that 48 frames take seconds
FRAMES = 48


def coarse(sample, name):
    """The sample's text with coarse voxels and one box for all frames."""
    text, changed = re.subn(r"voxel_size: \S+", f"voxel_size: {VOXEL_SIZE}", Path(sample).read_text())
    assert changed == 1, f"{name}: {changed} voxel sizes"
    text, changed = re.subn(r"\n( +)substeps:", r"\n\1stable_box: true\n\1substeps:", text)
    assert changed == 1, f"{name}: {changed} lines with substeps"
    return text


def main():
    sample, name = sys.argv[1:]
    if shutil.which("blender") is None:
        print("left out: there is no blender on this machine (scripts/test installs it)")
        return programs.SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "recipe.yaml").write_text(coarse(sample, name))
        programs.run_well([programs.BAKE, "recipe.yaml", "--out", "."], folder)
        files = sorted(path.name for path in Path(folder).glob("*.vdb"))
        assert files == [f"{name}_{frame:04}.vdb" for frame in range(1, FRAMES + 1)], files
        expected = Path(folder) / "expected.json"
        expected.write_text(json.dumps([programs.info(file, folder) for file in files]))
        script = Path(__file__).with_name("blender_sequence.py")
        return programs.run_in_blender(script, [folder, str(expected)], LIMIT_SECONDS)


if __name__ == "__main__":
    sys.exit(main())
