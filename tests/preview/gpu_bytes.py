#!/usr/bin/env python3
"""GPU bytes of the default cumulus, everything but the picture counted: at most 2.8 x active voxels x bytes of a texel, of a
picture without a display and of a window, whose moving picture needs columns of light as well.

usage: gpu_bytes.py BAKE PREVIEW PIPELINE [--window]     exit 1 where the limit is passed; 77: left out
Depends on Python's standard library; for a window on window/window.py.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

LIMIT = 2.8
TEXEL_BYTES = {"r8": 1, "r16f": 2, "r32f": 4}
# So large that every voxel covers more than half a pixel: nothing comes from a coarser level.
SIZE = (640, 360)


def without_display(preview, file, pipeline, folder):
    stats_file = folder / "stats.json"
    subprocess.run([preview, file, "--render", folder / "a.exr", "--scene", pipeline, "--size", f"{SIZE[0]}x{SIZE[1]}",
                    "--spp", "1", "--stats", stats_file], check=True, capture_output=True)
    stats = json.loads(stats_file.read_text())
    if len(stats["bricks_of_level"]) != 1:
        sys.exit(f"bricks came from coarser levels: {stats['bricks_of_level']}")
    return stats


def in_a_window(preview, file, pipeline, folder):
    w = window.Window(preview, folder, file, size=SIZE, scene=pipeline)
    try:
        w.drag((0.6, 0.5), (0.5, 0.5))
        w.settled()
        stats = w.stats()
        w.end()
    finally:
        w.kill()
    return stats


def main():
    bake, preview, pipeline = (str(Path(path).absolute()) for path in sys.argv[1:4])
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        subprocess.run([bake, pipeline, "--out", folder, "--quiet"], check=True)
        file = folder / "cumulus.vdb"
        info = json.loads(subprocess.run([bake, "info", file, "--json"], check=True, capture_output=True).stdout)
        info = info[0] if isinstance(info, list) else info
        active = info["grids"][0]["voxels_active"]
        stats = (in_a_window if WINDOW else without_display)(preview, file, pipeline, folder)
    share = stats["gpu_volume_bytes"] / (active * TEXEL_BYTES[stats["gpu_texel"]])
    print(f"{stats['gpu_volume_bytes']} bytes for {active} active voxels as {stats['gpu_texel']}: {share:.4f} x")
    if share > LIMIT:
        sys.exit(f"more than {LIMIT} x active voxels x bytes of a texel")


WINDOW = "--window" in sys.argv[4:]
if WINDOW:
    sys.path.insert(0, str(Path(__file__).parent / "window"))
    import window
    window.under_xvfb()
main()
