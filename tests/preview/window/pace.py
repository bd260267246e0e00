#!/usr/bin/env python3
"""Measures the previewer's real window of 640x360: frames a second during a drag of some seconds, and how near the picture is,
3 s after the last input, to an accumulation of 1024 samples of the same view.

usage: pace.py PREVIEW FILE.vdb [SAMPLES [FOLDER]]     a measurement, not a test: figures are the machine's at that moment; 77: left out
The reference is `--render` of the scene that the window saved: the same march and samples; it takes minutes, and 0 SAMPLES
leaves it out. A FOLDER keeps the window's picture, its scene and the reference. Depends on window.py.
"""
import json
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import x11
from window import Window, under_xvfb

WIDTH, HEIGHT = 640, 360
DEFAULT_SAMPLES = 1024
DRAGS = 5          # of about a second each
STEPS = 100        # of the mouse in one drag
STEP_SECONDS = 0.01
REST_SECONDS = 3.0


def sweep(start, end):
    """A drag by one xdotool alone, that its own starts take no time from the window."""
    words = ["mousemove", int(start * WIDTH), HEIGHT // 2, "mousedown", 1]
    for i in range(1, STEPS + 1):
        words += ["mousemove", int((start + (end - start) * i / STEPS) * WIDTH), HEIGHT // 2, "sleep", STEP_SECONDS]
    x11.xdotool(*words, "mouseup", 1)


def main():
    under_xvfb()
    preview, file = (os.path.abspath(path) for path in sys.argv[1:3])
    samples = int(sys.argv[3]) if len(sys.argv) > 3 else DEFAULT_SAMPLES
    with tempfile.TemporaryDirectory() as name:
        folder = Path(sys.argv[4] if len(sys.argv) > 4 else name).absolute()
        folder.mkdir(exist_ok=True)
        w = Window(preview, folder, file, size=(WIDTH, HEIGHT), scene=None)
        w.key("h")
        for i in range(DRAGS):
            sweep(*((0.3, 0.7) if i % 2 else (0.7, 0.3)))
            w.settled()
            s = w.stats()
            print(f"drag {i + 1}: {s['moving_frames']} frames, {s['moving_per_second']:.1f} a second, median "
                  f"{s['moving_median_ms']:.1f} ms, at {s['moving_width']}x{s['moving_height']}", flush=True)
        sweep(0.6, 0.4)
        time.sleep(REST_SECONDS)
        w.key("shift+F12")
        w.until_said("wrote nephele_0001.exr")
        w.key("ctrl+s")
        w.until_said(".scene.yaml")
        scene = next(folder.glob("*.scene.yaml"))
        code = w.end()
        if samples == 0:
            return code
        subprocess.run([preview, file, "--render", folder / "reference.exr", "--scene", scene, "--size", f"{WIDTH}x{HEIGHT}",
                        "--spp", str(samples)], check=True, stderr=subprocess.DEVNULL)
        told = subprocess.run([preview, "compare", folder / "nephele_0001.exr", folder / "reference.exr", "--json"], check=True,
                              capture_output=True, text=True).stdout
        print(f"at rest for {REST_SECONDS:.0f} s against {samples} samples: {json.loads(told)}")
    return code


if __name__ == "__main__":
    sys.exit(main())
