#!/usr/bin/env python3
"""GPU bytes of the default cumulus, everything but the picture counted: at most 2.8 x active voxels x bytes of a texel.

usage: gpu_bytes.py BAKE PREVIEW PIPELINE     exit 1 where the limit is passed
Depends on Python's standard library alone.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

LIMIT = 2.8
TEXEL_BYTES = {"r8": 1, "r16f": 2, "r32f": 4}


def main():
    bake, preview, pipeline = sys.argv[1:]
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([bake, pipeline, "--out", folder, "--quiet"], check=True)
        file = str(Path(folder) / "cumulus.vdb")
        info = json.loads(subprocess.run([bake, "info", file, "--json"], check=True, capture_output=True).stdout)
        info = info[0] if isinstance(info, list) else info
        active = info["grids"][0]["voxels_active"]
        stats_file = Path(folder) / "stats.json"
        # So large that every voxel covers more than half a pixel: nothing comes from a coarser level.
        subprocess.run([preview, file, "--render", str(Path(folder) / "a.exr"), "--scene", pipeline, "--size", "640x360",
                        "--spp", "1", "--stats", str(stats_file)], check=True, capture_output=True)
        stats = json.loads(stats_file.read_text())
    if len(stats["bricks_of_level"]) != 1:
        sys.exit(f"bricks came from coarser levels: {stats['bricks_of_level']}")
    share = stats["gpu_volume_bytes"] / (active * TEXEL_BYTES[stats["gpu_texel"]])
    print(f"{stats['gpu_volume_bytes']} bytes for {active} active voxels as {stats['gpu_texel']}: {share:.4f} x")
    if share > LIMIT:
        sys.exit(f"more than {LIMIT} x active voxels x bytes of a texel")


main()
