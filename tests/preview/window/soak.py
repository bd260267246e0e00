#!/usr/bin/env python3
"""Soaks the previewer's window: reloads, resizes, moves, views and splits for a while, then holds GL objects and memory flat.

usage: soak.py PREVIEW MAKE_BALL [MINUTES]     default 10; exit 1 where something grows, 77: left out
Depends on window.py.
"""
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from window import Window, under_xvfb

DEFAULT_MINUTES = 10.0
SECONDS_A_MINUTE = 60.0
SIZES = ((480, 320), (320, 240), (1, 1), (640, 360))
RADII = (20, 14, 18)
ALLOWED_GROWTH = 1.05  # of the memory between the first quarter's highest and the last quarter's highest
VIEWS = 6  # as many as preview/app/views.h has
ALLOWED_MEBIBYTES = 16.0  # or so much: allocators keep some


def mebibytes(process, what):
    """`what` is a row of Linux' status of a process: VmRSS is what is resident, VmData what was asked for and not given
    back, holes that freed blocks leave in the heap among it."""
    for line in Path(f"/proc/{process.pid}/status").read_text().splitlines():
        if line.startswith(what + ":"):
            return int(line.split()[1]) / 1024
    return 0.0


def make_ball(program, path, radius):
    partial = path.with_suffix(".partial")
    subprocess.run([program, str(partial), "ball", str(radius)], check=True)
    partial.rename(path)


class Soak:
    def __init__(self, preview, make, folder):
        self.make, self.folder = make, folder
        self.file = folder / "ball.vdb"
        make_ball(make, self.file, RADII[0])
        self.window = Window(preview, folder, "ball.vdb", size=SIZES[0])
        self.rounds = 0
        self.memory, self.asked, self.objects = [], [], []

    def see_everything(self):
        """Every look inside, both looks and a split, each until it rests: shaders are built when first asked for."""
        w = self.window
        for key in (*["v"] * VIEWS, "l", "l", "c"):
            w.key(key)
            w.settled()
        w.key("c")

    def round(self):
        """One of everything, back to where it began; then a reading of what is held."""
        w = self.window
        w.drag((0.7, 0.4), (0.5, 0.5))
        w.drag((0.7, 0.4), (0.6, 0.3), modifier="ctrl")
        w.key("v", "c", "x", "c", "shift+v", "l", "ctrl+z")
        for size in SIZES:
            w.resize(*size)
            time.sleep(0.1)
        w.resize(*w.size)
        self.rounds += 1
        make_ball(self.make, self.file, RADII[self.rounds % len(RADII)])
        w.until_said("read ball.vdb again", times=self.rounds)
        w.settled()  # while a file comes, the volume before and what it was read into are held too
        self.memory.append(mebibytes(w.process, "VmRSS"))
        self.asked.append(mebibytes(w.process, "VmData"))
        self.objects.append(w.stats()["gl_objects_alive"])

    def verdict(self):
        quarter = max(1, len(self.memory) // 4)

        def ends(readings):
            return max(readings[:quarter]), max(readings[-quarter:])
        made = self.window.stats()["gl_objects_made"]
        print(f"{self.rounds} rounds, {made} GL objects made; first quarter and last:")
        failed = False
        for name, readings, unit, ratio, slack in (("resident", self.memory, "MiB", ALLOWED_GROWTH, ALLOWED_MEBIBYTES),
                                                   ("asked for", self.asked, "MiB", ALLOWED_GROWTH, ALLOWED_MEBIBYTES),
                                                   ("GL objects alive", self.objects, "", 1.0, 0)):
            first, last = ends(readings)
            grows = last > first * ratio and last > first + slack
            print(f"  {name}: {first:.1f} then {last:.1f} {unit}{'  FAILED: grows' if grows else ''}")
            failed = failed or grows
        return failed


def main():
    under_xvfb()
    preview, make = sys.argv[1:3]
    minutes = float(sys.argv[3]) if len(sys.argv) > 3 else DEFAULT_MINUTES
    with tempfile.TemporaryDirectory() as name:
        soak = Soak(preview, make, Path(name))
        end = time.monotonic() + minutes * SECONDS_A_MINUTE
        soak.see_everything()
        soak.round()
        for readings in (soak.memory, soak.asked, soak.objects):
            readings.clear()  # what comes once has come
        soak.round()
        while time.monotonic() < end:
            soak.round()
        failed = soak.verdict()
        code = soak.window.end()
        if code != 0:
            print(f"FAILED: the window ended with {code}: {soak.window.said()[-2000:]}")
    return 1 if failed or code != 0 else 0


if __name__ == "__main__":
    sys.exit(main())
