#!/usr/bin/env python3
"""Live particles in the previewer's window: a baked file's particles move, pause, begin anew and undo; what 'bake this' writes
bakes, to the same content where nothing was changed.

usage: live_cases.py PREVIEW BAKE MAKE_BALL     exit 77: left out
Depends on window.py.
"""
import json
import subprocess
import sys
import tempfile
from pathlib import Path

from window import Window, under_xvfb

PREVIEW, BAKE, MAKE_BALL = sys.argv[1:4]
FAR = 20  # frames
RECIPE = """\
up_axis: z
seed: 4
assets:
  puff:
    voxel_size: 0.05
    frames: 30-31
    fps: 24
    cutoff: 0.002
    particles:
      emitters:
        - { shape: sphere, radius: 0.3, bursts: [[0, 600]], rate: 300, velocity: [0, 0, 0.8], outward: 0.2,
            particle_radius: 0.12, life: 1.5, temperature: 1 }
      forces: { drag: 1, buoyancy: 1, curl_noise: { speed: 0.2, cell_size: 0.4 } }
      substeps: 2
"""


def bake(folder, recipe, *words):
    subprocess.run([BAKE, recipe, "--out", ".", "--quiet", *words], cwd=folder, check=True)


def content(folder, name):
    told = subprocess.run([BAKE, "info", name, "--json"], cwd=folder, check=True, capture_output=True, text=True).stdout
    return [grid["content_hash"] for grid in json.loads(told)["grids"]]


def particles_live(folder):
    (folder / "puff.yaml").write_text(RECIPE)
    bake(folder, "puff.yaml")
    w = Window(PREVIEW, folder, "puff_0030.vdb")
    try:
        w.key("h")  # pictures without panel, warnings and notices
        baked = w.settled()
        w.key("p")
        w.until_said("particles are moved live")
        w.until_unlike(baked, "the particles of time 0 look like those of frame 30")
        # At time 0 a ball stands where a plume rises later: playing changes the picture, and goes on to.
        early = w.picture()
        w.until_unlike(early, "the particles do not move")
        # Far enough on that a system begun anew, played and paused does not look alike.
        w.until(lambda: w.stat("live_frame") > FAR, "the particles do not move on")
        w.key("space")
        w.until_said("live particles pause")
        paused = w.settled()
        w.key("shift+p", "space", "space")
        w.until_said("live particles pause", times=2)
        w.until_unlike(paused, "reset does not begin anew")
        begun = w.settled()
        w.key("Right", "Right", "Right", "Right", "Right", "Right")
        w.until_unlike(begun, "stepping on does not move them")
        w.key("b")
        w.until_said("wrote puff_live.yaml")
        w.key("p")
        w.until_said("back to the file")
        w.until_like(baked, "the file does not come back")
        assert w.end() == 0
    finally:
        w.kill()
    bake(folder, "puff_live.yaml", "--frames", "30-30")
    assert content(folder, "puff_live_0030.vdb") == content(folder, "puff_0030.vdb"), "the recipe bakes something else"


def files_without_particles(folder):
    subprocess.run([MAKE_BALL, "ball.vdb"], cwd=folder, check=True)
    w = Window(PREVIEW, folder, "ball.vdb")
    try:
        w.key("p")
        w.until_said("carries no particle block")
        w.key("b")
        w.until_said("no particles are moved live")
        assert w.end() == 0
    finally:
        w.kill()


def main():
    under_xvfb()
    failed = 0
    for case in (particles_live, files_without_particles):
        with tempfile.TemporaryDirectory() as name:
            try:
                case(Path(name))
                print(f"passed  {case.__name__}")
            except AssertionError as error:
                failed += 1
                print(f"FAILED  {case.__name__}: {error}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
