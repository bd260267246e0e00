#!/usr/bin/env python3
"""Cost grows with what is seen: the default cumulus under its own scene, where voxels cover less than a pixel, baked at its voxel
size and at half of it. Densities read a pixel (those of the light cache counted) grow by less than 1.4.

usage: cost_of_resolution.py BAKE PREVIEW RECIPE [SAMPLES...]     1 and 4 samples a pixel; exit 1 where it costs 1.4 times or more
What is compared is counted, not timed. GlLevels.CostGrowsWithWhatIsSeen is the same under a sun alone. Depends on Python's
standard library.
"""
import json
import math
import re
import subprocess
import sys
import tempfile
from pathlib import Path

LIMIT = 1.4
SIZE = (224, 126)
VOXEL_SIZE = re.compile(r"(voxel_size:\s*)([0-9.]+)")
CAMERA = re.compile(r"camera:\s*\{\s*position:\s*\[(.*?)\],\s*target:\s*\[(.*?)\],\s*fov:\s*([0-9.]+)")


def output(command):
    return subprocess.run([str(word) for word in command], check=True, capture_output=True, text=True).stdout


def pixels_a_voxel(recipe, voxel):
    """At the distance of the camera's target."""
    position, target, fov = CAMERA.search(recipe).groups()
    distance = math.dist(*([float(number) for number in place.split(",")] for place in (position, target)))
    return voxel * 0.5 * SIZE[1] / (distance * math.tan(0.5 * math.radians(float(fov))))


def baked(bake, recipe, folder, divisor):
    """The recipe's only asset at a part of its voxel size; returns file and voxel size."""
    found = VOXEL_SIZE.findall(recipe)
    assert len(found) == 1, "the recipe has not one asset"
    voxel = float(found[0][1]) / divisor
    folder.mkdir()
    (folder / "recipe.yaml").write_text(VOXEL_SIZE.sub(rf"\g<1>{voxel:g}", recipe))
    output([bake, folder / "recipe.yaml", "--out", folder, "--quiet"])
    return next(folder.glob("*.vdb")), voxel


def densities(preview, file, scene, samples, folder):
    """Read a pixel and sample, on the mean."""
    stats = folder / "stats.json"
    output([preview, file, "--scene", scene, "--size", f"{SIZE[0]}x{SIZE[1]}", "--spp", samples, "--render", folder / "a.exr",
            "--stats", stats])
    return json.loads(stats.read_text())["samples_per_pixel"]


def main():
    bake, preview, scene = (Path(path).resolve() for path in sys.argv[1:4])
    recipe, worst = scene.read_text(), 0.0
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        files = [baked(bake, recipe, folder / f"by_{divisor}", divisor) for divisor in (1, 2)]
        places = [pixels_a_voxel(recipe, voxel) for _, voxel in files]
        assert places[0] <= 1.0, f"voxels cover {places[0]:.3g} pixels: no less than one"
        for samples in sys.argv[4:] or ["1", "4"]:
            base, doubled = (densities(preview, file, scene, samples, folder) for file, _ in files)
            worst = max(worst, doubled / base)
            print(f"{samples} samples a pixel: {base:.1f} densities where a voxel covers {places[0]:.2f} pixels, {doubled:.1f} where "
                  f"it covers {places[1]:.2f}: {doubled / base:.3f} times", flush=True)
    if worst >= LIMIT:
        sys.exit(f"{LIMIT} times or more")


main()
