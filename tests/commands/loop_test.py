#!/usr/bin/env python3
"""A loop closes: the frame past it has the content of the first, the step across it is a step like any other, and the
report says so with a measured figure. What cannot close is refused with what would.

Depends on programs.py.
"""
import json
import sys
import tempfile
import unittest
from pathlib import Path

import programs

# One frame more than the loop, so that both ends are there.
RECIPE = """\
assets:
  puff:
    voxel_size: 0.05
    frames: 3-11
    fps: 23.976
    loop: 8
    density:
      multiply:
        - warp: { input: { sphere: { falloff: 1 } }, warp_scale: 0.3, evolve: 3 }
        - add:
            - 0.4
            - fbm: { cell_size: 0.4, octaves: 3, period: 3, scroll: [3.5, 0, -7], fine_scroll: [0, 3.5, 0], evolve: 2.5 }
            - multiply: [0.3, { worley: { cell_size: 0.5, period: 2, scroll: [0, 3, 0], evolve: 3 } }]
"""


class LoopTest(unittest.TestCase):
    def setUp(self):
        self.temporary = tempfile.TemporaryDirectory()
        self.addCleanup(self.temporary.cleanup)
        self.folder = Path(self.temporary.name)
        (self.folder / "pipeline.yaml").write_text(RECIPE)

    def file(self, frame):
        return f"out/puff_{frame:04d}.vdb"

    def largest(self, a, b):
        done = programs.run_well([programs.BAKE, "diff", self.file(a), self.file(b), "--json"], self.folder)
        return json.loads(done.stdout)["density"]["largest"]

    def test_closes(self):
        done = programs.run_well([programs.BAKE, "pipeline.yaml", "--report", "-"], self.folder)
        records = json.loads(done.stdout)["assets"]
        hashes = [record["content_hash"] for record in records]
        self.assertEqual(len(hashes), 9)
        self.assertEqual(hashes[0], hashes[8])
        self.assertEqual(len(set(hashes)), 8, "two frames of the loop are alike")
        seam = records[0]["loop"]["seam"]
        self.assertEqual(seam["frame"], 11)
        self.assertEqual(seam["largest_difference"], 0)
        self.assertEqual(seam["content_hash"], hashes[8])
        self.assertIn("loop of 8 frames: largest difference 0 between frames 3 and 11", done.stderr)
        self.assertIn("fbm: 'scroll' of [3.5, 0, -7]", done.stderr)
        steps = [self.largest(frame, frame + 1) for frame in range(3, 11)]
        self.assertGreater(min(steps), 0)
        self.assertLess(steps[-1], 2 * max(steps[:-1]), "the step that closes the loop is a jump")

    def test_the_report_of_what_is_up_to_date_says_what_the_grid_could_not_hold(self):
        command = [programs.BAKE, "pipeline.yaml", "--frames", "3-3", "--report", "-"]
        baked, skipped = (json.loads(programs.run_well(command, self.folder).stdout)["assets"][0] for _ in range(2))
        self.assertEqual([baked["skipped"], skipped["skipped"]], [False, True])
        self.assertIn({"field": "fbm", "octave": 2, "cell_voxels": 2, "weight": 0}, baked["band_limit"])
        self.assertEqual(baked["band_limit"], skipped["band_limit"])

    def test_is_up_to_date_whichever_turn_a_frame_is_in(self):
        programs.run_well([programs.BAKE, "pipeline.yaml", "--frames", "3-3"], self.folder)
        first = programs.info(self.file(3), self.folder)["metadata"]["recipe_hash"]
        programs.run_well([programs.BAKE, "pipeline.yaml", "--frames", "11-11"], self.folder)
        self.assertEqual(first, programs.info(self.file(11), self.folder)["metadata"]["recipe_hash"])


if __name__ == "__main__":
    sys.exit(unittest.main())
