"""Runs inside Blender: imports a folder of frames as one sequence and plays it.

usage: blender -b --factory-startup --python-exit-code 1 --python blender_sequence.py -- FOLDER EXPECTED.json
EXPECTED.json holds what `info --json` says of each file, in order. Depends on Blender 3.4 or later.
"""
import json
import sys
from pathlib import Path

import bpy

THRESHOLD = 0.05
ROUNDING = 1e-4  # Blender keeps boxes in single precision


def import_sequence(folder, names):
    """Blender's own import of many files, which joins those whose names end in contiguous digits."""
    done = bpy.ops.object.volume_import(filepath=str(Path(folder) / names[0]), directory=folder,
                                        files=[{"name": name} for name in names], use_sequence_detection=True)
    assert done == {"FINISHED"}, done
    volumes = [o for o in bpy.data.objects if o.type == "VOLUME"]
    assert len(volumes) == 1, f"{len(names)} files became {len(volumes)} objects"
    return volumes[0]


def mesh_of(volume):
    """An object that Blender builds from the voxels that it has read."""
    mesh = bpy.data.objects.new("surface", bpy.data.meshes.new("surface"))
    bpy.context.scene.collection.objects.link(mesh)
    modifier = mesh.modifiers.new("surface", "VOLUME_TO_MESH")
    modifier.object, modifier.grid_name, modifier.threshold = volume, "density", THRESHOLD
    return mesh


def main():
    folder, expected_path = sys.argv[sys.argv.index("--") + 1:]
    with open(expected_path) as file:
        expected = json.load(file)
    names = [Path(frame["path"]).name for frame in expected]
    volume = import_sequence(folder, names)
    data = volume.data
    assert data.is_sequence and data.frame_duration == len(names), (data.is_sequence, data.frame_duration)
    assert data.frame_start == 1 and data.frame_offset == 0, (data.frame_start, data.frame_offset)
    print(f"ok: a sequence of {data.frame_duration} frames from frame {data.frame_start}")
    surface = mesh_of(volume)
    boxes, surfaces = set(), []
    for number, frame in enumerate(expected, start=1):
        bpy.context.scene.frame_set(number)
        graph = bpy.context.evaluated_depsgraph_get()
        seen = volume.evaluated_get(graph)
        grids = seen.data.grids
        assert grids.load(), f"frame {number}: {grids.error_message}"
        assert grids.frame == number, (grids.frame, number)
        assert Path(grids.frame_filepath).name == names[number - 1], grids.frame_filepath
        found = sorted((grid.name, grid.data_type.lower()) for grid in grids)
        told = sorted((grid["name"], grid["type"]) for grid in frame["grids"])
        assert [name for name, _ in found] == [name for name, _ in told], (found, told)
        boxes.add(tuple(round(c / ROUNDING) for corner in seen.bound_box for c in corner))
        corners = [tuple(vertex.co) for vertex in surface.evaluated_get(graph).data.vertices]
        assert corners, f"frame {number}: nothing above {THRESHOLD}"
        surfaces.append(hash(tuple(corners)))
    # One stable box, though the frames differ.
    assert len(boxes) == 1, f"{len(boxes)} boxes"
    print("ok: every frame is loaded from its own file, in one box")
    assert len(set(surfaces)) == len(names), f"{len(set(surfaces))} different surfaces in {len(names)} frames"
    print("ok: Blender reads other voxels in each frame")


main()
