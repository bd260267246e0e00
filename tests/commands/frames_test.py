#!/usr/bin/env python3
"""A sequence is rendered past a frame that cannot be read: it is told of, the others are there, and the exit code is 2.

Depends on programs.py.
"""
import sys
import tempfile
from pathlib import Path

import programs


def render(folder, file, frames):
    return programs.run([programs.PREVIEW, file, "--render", "out.png", "--size", "16x9", "--spp", "1", "--frames", frames],
                        folder)


def pictures(folder):
    return sorted(file.name for file in folder.glob("out_*.png"))


def main():
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "small.yaml").write_text(programs.SMALL_RECIPE)
        programs.run_well([programs.BAKE, "small.yaml"], folder)
        good = (folder / "out" / "ball.vdb").read_bytes()
        for frame in (1, 3):
            (folder / f"s_{frame:04}.vdb").write_bytes(good)
        (folder / "s_0002.vdb").write_bytes(good[:200])
        done = render(folder, "s_0001.vdb", "1-4")  # the fourth is missing
        assert done.returncode == 2, done.returncode
        assert "s_0002.vdb: error:" in done.stderr and "s_0004.vdb: error: no such file" in done.stderr, done.stderr
        assert "2 of 4 frames could not be rendered" in done.stderr, done.stderr
        assert pictures(folder) == ["out_0001.png", "out_0003.png"], pictures(folder)
        done = render(folder, "s_0001.vdb", "3")
        assert done.returncode == 0, done.stderr
        done = render(folder, "s_0001.vdb", "2")
        assert done.returncode == 2 and "1 of 1 frames" in done.stderr, done.stderr
        assert len(pictures(folder)) == 2
    print("bad frames are told of and passed over")


if __name__ == "__main__":
    sys.exit(main())
