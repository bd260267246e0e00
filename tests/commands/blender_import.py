"""Runs inside Blender: imports a .vdb and compares grid name, type, class, voxel size and box with `info --json`.

usage: blender -b --factory-startup --python-exit-code 1 --python blender_import.py -- FILE.vdb EXPECTED.json
Depends on Blender 3.4 or later and, for the class (which Blender keeps to itself), on python3-openvdb.
"""
import json
import sys

import bpy
from mathutils import Vector

LEAF_EDGE = 8
RELATIVE_TOLERANCE = 1e-5  # Blender keeps transforms and boxes in single precision


def import_volume(path):
    """Blender's own import operator; returns the new object."""
    before = set(bpy.data.objects)
    assert bpy.ops.object.volume_import(filepath=path) == {"FINISHED"}
    (volume,) = set(bpy.data.objects) - before
    assert volume.type == "VOLUME", volume.type
    assert volume.data.grids.load(), volume.data.grids.error_message
    return volume


def check_near(what, found, expected, scale):
    assert all(abs(f - e) <= RELATIVE_TOLERANCE * scale for f, e in zip(found, expected)), (
        f"{what}: Blender has {list(found)}, info says {list(expected)}")
    print(f"ok: {what} {[round(value, 6) for value in found]}")


def check_equal(what, found, expected):
    assert found == expected, f"{what}: found {found!r}, expected {expected!r}"
    print(f"ok: {what} {found!r}")


def extent(points):
    return [min(p[i] for p in points) for i in range(3)] + [max(p[i] for p in points) for i in range(3)]


def blender_box(world_from_index, low, high):
    """Blender's box of active voxels [low, high): from the first sample to the last of all leaves that hold any."""
    first = [c // LEAF_EDGE * LEAF_EDGE for c in low]
    last = [(c - 1) // LEAF_EDGE * LEAF_EDGE + LEAF_EDGE - 1 for c in high]
    return extent([world_from_index @ Vector((x, y, z)) for x in (first[0], last[0]) for y in (first[1], last[1])
                   for z in (first[2], last[2])])


def check_class(path, expected):
    try:
        import pyopenvdb
    except ImportError:
        print("left out: the grid's class, since python3-openvdb is missing")
        return
    grid = pyopenvdb.readGridMetadata(path, expected["name"])
    check_equal("class", grid.gridClass, expected["class"])


def main():
    path, expected_path = sys.argv[sys.argv.index("--") + 1:]
    with open(expected_path) as file:
        expected = json.load(file)["grids"][0]
    volume = import_volume(path)
    grids = volume.data.grids
    check_equal("number of grids", len(grids), 1)
    grid = grids[0]
    check_equal("grid name", grid.name, "density")
    check_equal("grid name in info", expected["name"], grid.name)
    check_equal("grid type", grid.data_type.lower(), expected["type"])
    check_class(path, expected)
    found = [grid.matrix_object[row][column] for row in range(4) for column in range(4)]
    check_near("transform", found, info_matrix(expected), 1.0)
    check_near("rotation of the object", volume.rotation_euler, (0.0, 0.0, 0.0), 1.0)
    box = blender_box(grid.matrix_object, expected["box_min"], expected["box_max"])
    check_near("box of leaves", extent(volume.bound_box), box, max(map(abs, box)))


def info_matrix(expected):
    """The transform of info as 16 numbers, row by row."""
    return [float(value) for row in expected["transform"] for value in row]


main()
