#!/usr/bin/env python3
"""Times the path tracer against Blender Cycles to the same noise, on bench/cycles_ball.yaml, in turns within one run.

usage: bench/cycles_bench.py [SIZE [SAMPLES [BOUNCES...]]]     256 pixels, 64 of Cycles' samples, 0 and 4 bounces unless given
Both render with two seeds: a picture's noise is the relative RMSE of the two over the root of 2 (their bias cancels, and the
means are printed beside it). Time is the render alone. The speed-up is at equal noise: time × noise². Needs build/nephele-bake,
build/nephele-preview and blender; 77 where there is none.
"""
import json
import math
import re
import shutil
import sys
import tempfile
from pathlib import Path

from programs import BAKE, PREVIEW, RECIPE, ROOT, said

NO_BLENDER = 77
# As RECIPE's scene says; Cycles is told by a job of its own.
JOB = {"camera": {"position": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 26},
       "medium": {"sigma_s": 6.4, "sigma_a": 0.0, "g": 0.3}, "environment": [0, 0, 0], "threads": 2,
       "suns": [{"to_light": [0.6, -0.4, 0.7], "irradiance": [3.1416] * 3}]}


def cycles(folder, size, samples, bounces, seed):
    """Renders; returns the picture and the seconds of the render."""
    out = folder / f"cycles_{bounces}_{seed}.exr"
    job = folder / "job.json"
    job.write_text(json.dumps({**JOB, "file": str(folder / "ball.vdb"), "out": str(out), "size": [size, size],
                               "samples": samples, "bounces": bounces, "seed": seed}))
    script = ROOT / "bench/cycles_render.py"
    text = said(["env", "-u", "PYTHONHOME", "-u", "PYTHONPATH", "blender", "-b", "--factory-startup", "-noaudio",
                 "--python-exit-code", "1", "--python", script, "--", job])
    return out, float(re.search(r"^seconds ([\d.]+)", text, re.M).group(1))


def ours(folder, size, samples, bounces, seed):
    out, stats = folder / f"ours_{bounces}_{seed}.exr", folder / "stats.json"
    said([PREVIEW, folder / "ball.vdb", "--scene", RECIPE, "--method", "reference", "--size", f"{size}x{size}", "--spp", samples,
          "--bounces", bounces, "--seed", seed, "--render", out, "--stats", stats])
    return out, json.loads(stats.read_text())["ms_per_frame"] / 1000


def compared(a, b):
    return json.loads(said([PREVIEW, "compare", a, b, "--json"]))


def main():
    size = int(sys.argv[1]) if len(sys.argv) > 1 else 256
    samples = int(sys.argv[2]) if len(sys.argv) > 2 else 64
    if shutil.which("blender") is None:
        print("left out: there is no blender on this machine")
        return NO_BLENDER
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        said([BAKE, RECIPE, "--out", folder, "--quiet"])
        for bounces in [int(word) for word in sys.argv[3:]] or [0, 4]:
            turns = [(who, render(folder, size, samples, bounces, seed)) for seed in (1, 2)
                     for who, render in (("Cycles", cycles), ("ours", ours))]
            work = {}
            for who in ("Cycles", "ours"):
                (a, first), (b, second) = (result for by, result in turns if by == who)
                noise, seconds = compared(a, b)["relative_rmse"] / math.sqrt(2), min(first, second)
                work[who] = seconds * noise ** 2
                print(f"bounces {bounces}  {who:7} {seconds:7.2f} s  noise {100 * noise:6.2f}%")
            apart = compared(turns[1][1][0], turns[0][1][0])["bias"]
            print(f"bounces {bounces}  {work['Cycles'] / work['ours']:.1f} times faster to equal noise; "
                  f"mean radiance {100 * apart:+.2f}% from Cycles'", flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
