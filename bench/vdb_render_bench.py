#!/usr/bin/env python3
"""Times the march against OpenVDB's vdb_render on bench/cycles_ball.yaml, in turns within one run, each with its own error.

usage: bench/vdb_render_bench.py [SIZE [SAMPLES [PAIRS]]]      512 pixels, 1 sample a pixel as vdb_render takes, 2 pairs
Same optics: one sun, isotropic, albedo 1, single scattering. vdb_render has no 1/(4π) and takes extinction a voxel: here the
sun's irradiance is 4π, and extinction is divided by the ball's 128 voxels a unit. It marches steps of 1 voxel, 3 towards the
light. Errors are relative RMSE: vdb_render's to steps of 1 and 1, ours to short steps without light cache and coarser levels,
through the same places of the pixels. Times are the shortest of all turns. The whole process is everything; the time from the
first byte read to the last pixel leaves out driver start and shaders, which are told apart. Takes 3 minutes. Needs
build/nephele-bake, build/nephele-preview and vdb_render; 77 where there is none.
"""
import json
import math
import re
import shutil
import sys
import tempfile
from pathlib import Path

from programs import BAKE, PREVIEW, RECIPE, said, timed

NO_VDB_RENDER = 77
MORE_OF_OURS = 3
VOXEL = 1 / 128  # as RECIPE says
SIGMA, TO_LIGHT = 6.4, (0.6, -0.4, 0.7)
CAMERA = {"position": [0, -5, 0], "target": [0, 0, 0], "up": [0, 0, 1], "fov": 26}
IRRADIANCE = 4 * math.pi  # so that irradiance × phase is vdb_render's light of 1
WAYS = {"ours": {}}  # by what the scene's march says
# Each step lit, so that no draw is in it; finer ones are loops that drivers end.
FINE = {"step": 0.5, "shadow_step": 0.5, "shadow_growth": 1.1, "adaptive": False, "light_cache": False, "level_pixels": 0, "step_pixels": 0}


def listed(values):
    return ",".join(f"{value:.9g}" for value in values)


def theirs(folder, size, shadow_step):
    out = folder / f"theirs_{shadow_step}.exr"
    extinction = [SIGMA * VOXEL] * 3
    seconds, *words = timed(["vdb_render", "-v", folder / "ball.vdb", out, "-res", f"{size}x{size}",
                             "-translate", listed(CAMERA["position"]), "-lookat", listed(CAMERA["target"]),
                             "-up", listed(CAMERA["up"]), "-fov", CAMERA["fov"],
                             "-absorb", "0,0,0", "-scatter", listed(extinction), "-light", listed([*TO_LIGHT, 1, 1, 1]),
                             "-gain", 0, "-cutoff", 1e-4, "-step", 1, "-shadowstep", shadow_step])
    read, traced, _ = (float(part) for part in re.findall(r"completed in ([\d.e+-]+) sec", "".join(words)))
    return out, seconds, read + traced


def ours(folder, size, samples, name, march):
    scene, stats, out = folder / "scene.yaml", folder / "stats.json", folder / f"{name}.exr"
    # YAML holds JSON.
    scene.write_text(json.dumps({"camera": CAMERA, "medium": {"sigma_s": SIGMA, "g": 0}, "look": "physical", "march": march,
                                 "lights": [{"sun": {"to_light": TO_LIGHT, "irradiance": [IRRADIANCE] * 3}}]}))
    seconds, *_ = timed([PREVIEW, folder / "ball.vdb", "--scene", scene, "--size", f"{size}x{size}", "--spp", samples,
                         "--render", out, "--stats", stats])
    return out, seconds, json.loads(stats.read_text())


def apart(picture, reference):
    return json.loads(said([PREVIEW, "compare", picture, reference, "--json"]))


def told(who, whole, pixels, error, peer=None):
    less = f"; {peer[0] / whole:.1f} and {peer[1] / pixels:.1f} times less" if peer else ""
    print(f"{who}: whole process {whole:.3f} s, first byte to last pixel {pixels:.3f} s, {100 * error['relative_rmse']:.2f}% "
          f"from its own finest{less}", flush=True)


def main():
    size, samples, pairs = (int(sys.argv[i]) if len(sys.argv) > i else usual for i, usual in ((1, 512), (2, 1), (3, 2)))
    if shutil.which("vdb_render") is None:
        print("left out: there is no vdb_render on this machine")
        return NO_VDB_RENDER
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        said([BAKE, RECIPE, "--out", folder, "--quiet"])
        turns = [[theirs(folder, size, 3)] + [ours(folder, size, samples, *way) for way in WAYS.items()] for _ in range(pairs)]
        # So short that one of them alone says little.
        more = [[ours(folder, size, samples, *way) for way in WAYS.items()] for _ in range(MORE_OF_OURS)]
        finest, fine = theirs(folder, size, 1)[0], ours(folder, size, samples, "fine", FINE)[0]
        peer = [min(turn[0][i] for turn in turns) for i in (1, 2)]
        told("vdb_render 1 / 3", *peer, apart(turns[0][0][0], finest))
        for i, way in enumerate(WAYS, 1):
            runs = [turn[i] for turn in turns] + [turn[i - 1] for turn in more]
            stats = min((run[2] for run in runs), key=lambda of: of["seconds_to_last_pixel"])
            told(way, min(run[1] for run in runs), stats["seconds_to_last_pixel"], apart(turns[0][i][0], fine), peer)
            print(f"  load {stats['seconds_load']:.3f}, upload {stats['ms_upload'] / 1000:.3f}, light cache "
                  f"{stats['ms_light_cache'] / 1000:.3f}, march {stats['ms_march'] / 1000:.3f}; apart from these: driver "
                  f"{stats['seconds_driver']:.3f}, shaders {stats['seconds_shaders']:.3f}")
        between = apart(finest, fine)
        print(f"both finest differ by {100 * between['relative_rmse']:.2f}%, on the mean by {100 * between['bias']:+.2f}%")
    return 0


if __name__ == "__main__":
    sys.exit(main())
