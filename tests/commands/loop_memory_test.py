#!/usr/bin/env python3
"""A loop's first frame, its seam with it, takes at most 1.5 times its grid and 200 MB. Depends on programs.py."""
import json
import sys
import tempfile
from pathlib import Path

import programs

# About 600 MB of voxels: a second grid would be over.
RECIPE = """\
assets:
  ball:
    voxel_size: 0.0032
    precision: float
    frames: 1-8
    loop: true
    density:
      multiply: [{ sphere: { falloff: 1 } }, { add: [1, { fbm: { cell_size: 0.5, octaves: 1, period: 4, scroll: [6, 0, 0] } }] }]
"""
MB = 1e6


def main():
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "pipeline.yaml").write_text(RECIPE)
        done = programs.run_well([programs.BAKE, "pipeline.yaml", "--frames", "1-1", "--report", "-"], folder)
        record = json.loads(done.stdout)["assets"][0]
    grid, peak = record["grid_bytes"], record["peak_bytes"]
    print(f"grid {grid / MB:.1f} MB, peak {peak / MB:.1f} MB of {1.5 * grid / MB + 200:.1f}, seam {record['loop']['seam']}")
    assert grid > 450 * MB, "too small to tell one grid from two"
    assert record["loop"]["seam"]["largest_difference"] == 0
    return 0 if peak <= 1.5 * grid + 200 * MB else 1


if __name__ == "__main__":
    sys.exit(main())
