"""Makes the damaged and odd files that the command cases open, in one folder. Depends on programs.py; files that need
OpenVDB's Python module are left out where that is missing.
"""
import random
from pathlib import Path

import programs

try:
    import pyopenvdb
except ImportError:
    pyopenvdb = None

FLIPPED_BYTES = 40


def make_files(folder):
    """Writes good.vdb (baked) and its damaged kin into `folder`; returns the names of files that could not be made."""
    folder = Path(folder)
    (folder / "small.yaml").write_text(programs.SMALL_RECIPE)
    programs.run_well([programs.BAKE, "small.yaml", "--out", "baked"], folder)
    good = (folder / "baked" / "ball.vdb").read_bytes()
    (folder / "good.vdb").write_bytes(good)
    (folder / "good_0001.vdb").write_bytes(good)
    (folder / "cut_in_data.vdb").write_bytes(good[: len(good) * 2 // 3])
    (folder / "cut_by_one.vdb").write_bytes(good[:-1])
    (folder / "cut_in_header.vdb").write_bytes(good[:40])
    (folder / "flipped.vdb").write_bytes(flipped(good))
    (folder / "empty.vdb").write_bytes(b"")
    (folder / "text.vdb").write_text("These are not the voxels you are looking for.\n" * 20)
    (folder / "folder.vdb").mkdir()
    (folder / "a_file").write_text("")
    return make_foreign_files(folder)


def flipped(data):
    """The same file with bytes of its second half changed: its header still holds."""
    changed, chance = bytearray(data), random.Random(7)
    for _ in range(FLIPPED_BYTES):
        changed[chance.randrange(len(data) // 2, len(data))] ^= 1 << chance.randrange(8)
    return bytes(changed)


def make_foreign_files(folder):
    if pyopenvdb is None:
        return ["vel_only.vdb", "level_set.vdb", "not_finite.vdb"]
    velocity = pyopenvdb.Vec3SGrid()
    velocity.name = "vel"
    velocity.fill((0, 0, 0), (7, 7, 7), (1.0, 0.0, 0.0))
    pyopenvdb.write(str(folder / "vel_only.vdb"), [velocity])
    ball = pyopenvdb.createLevelSetSphere(radius=5.0)
    ball.name = "surface"
    pyopenvdb.write(str(folder / "level_set.vdb"), [ball])
    poisoned = pyopenvdb.FloatGrid()
    poisoned.name = "density"
    poisoned.gridClass = "fog volume"
    poisoned.fill((0, 0, 0), (7, 7, 7), float("nan"))
    pyopenvdb.write(str(folder / "not_finite.vdb"), [poisoned])
    return []
