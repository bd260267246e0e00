#!/usr/bin/env python3
"""A bake that is killed or fails leaves no file that looks finished, and the next one clears away what a kill left.

Depends on programs.py.
"""
import os
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import programs

# Solid and noisy enough for writing to take a while: half a million voxels that hardly compress.
RECIPE = """\
assets:
  ball:
    voxel_size: 0.018
    density:
      multiply:
        - sphere: { radius: 1.0, falloff: 0.2 }
        - add: [ 1.0, { perlin: { cell_size: 0.05 } } ]
"""
TRIES = 20


class KillTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.out = Path(self.folder.name) / "out"
        (Path(self.folder.name) / "pipeline.yaml").write_text(RECIPE)
        self.command = [programs.BAKE, "pipeline.yaml", "--force"]

    def partial_files(self):
        return list(self.out.glob(".*.partial")) if self.out.exists() else []

    def finished_files(self):
        return list(self.out.glob("*.vdb")) if self.out.exists() else []

    def kill_while_writing(self):
        """Starts a bake and kills it as soon as its partial file shows; returns whether one was left behind."""
        bake = programs.start(self.command, self.folder.name)
        deadline = time.monotonic() + programs.LIMIT_SECONDS
        while bake.poll() is None and not self.partial_files() and time.monotonic() < deadline:
            time.sleep(0.0005)
        bake.kill()
        bake.wait()
        return bool(self.partial_files())

    def test_kill_while_writing(self):
        for _ in range(TRIES):
            if self.kill_while_writing():
                break
            for file in self.finished_files():
                file.unlink()
        else:
            self.fail(f"no bake out of {TRIES} was caught while writing")
        self.assertEqual(self.finished_files(), [])
        programs.run_well(self.command, self.folder.name)
        self.assertEqual(self.partial_files(), [])
        programs.info("out/ball.vdb", self.folder.name)  # whole, or this fails

    def test_an_earlier_file_outlives_a_failed_bake(self):
        programs.run_well(self.command, self.folder.name)
        before = programs.info("out/ball.vdb", self.folder.name)
        failed = programs.run(self.command, self.folder.name, file_bytes=4096)
        self.assertEqual(failed.returncode, 1, failed.stderr)
        self.assertEqual(programs.info("out/ball.vdb", self.folder.name), before)
        self.assertEqual(self.partial_files(), [])

    def test_only_the_files_of_the_dead_are_removed(self):
        gone = subprocess.Popen(["true"])
        gone.wait()
        self.out.mkdir()
        of_the_dead = self.out / f".ball.vdb.{gone.pid}.partial"
        of_the_living = self.out / f".ball.vdb.{os.getpid()}.partial"
        stranger = self.out / ".notes"
        for file in (of_the_dead, of_the_living, stranger):
            file.write_text("half a file")
        programs.run_well(self.command, self.folder.name)
        self.assertFalse(of_the_dead.exists())
        self.assertTrue(of_the_living.exists())
        self.assertTrue(stranger.exists())


if __name__ == "__main__":
    sys.exit(unittest.main())
