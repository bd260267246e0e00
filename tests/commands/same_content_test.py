#!/usr/bin/env python3
"""The same recipe bakes the same content on any number of threads; another recipe bakes another.

Depends on programs.py.
"""
import sys
import tempfile
import unittest
from pathlib import Path

import programs

RECIPE = """\
assets:
  puff:
    voxel_size: 0.03
    density:
      multiply:
        - warp: { input: { sphere: { radius: 1.0, falloff: 1.0 } }, warp_scale: 0.3 }
        - add: [ 0.5, { fbm: { cell_size: 0.4, octaves: 4 } } ]
"""


class SameContentTest(unittest.TestCase):
    def hash_of(self, recipe, threads):
        with tempfile.TemporaryDirectory() as folder:
            (Path(folder) / "pipeline.yaml").write_text(recipe)
            programs.run_well([programs.BAKE, "pipeline.yaml", "--threads", str(threads)], folder)
            grids = programs.info("out/puff.vdb", folder)["grids"]
            self.assertGreater(grids[0]["voxels_active"], 10000)
            return grids[0]["content_hash"]

    def test_threads_do_not_matter(self):
        once = self.hash_of(RECIPE, 1)
        self.assertEqual(once, self.hash_of(RECIPE, 2))
        self.assertEqual(once, self.hash_of(RECIPE, 5))

    def test_the_recipe_does(self):
        self.assertNotEqual(self.hash_of(RECIPE, 2), self.hash_of(RECIPE.replace("0.4", "0.41"), 2))


if __name__ == "__main__":
    sys.exit(unittest.main())
