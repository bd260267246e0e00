"""A box of 256³ voxels of 5 octaves of noise: Blender's Volume Cube against nephele-bake, by turns in one run.

usage: blender --background --factory-startup --python bench/blender_volume_cube.py -- NEPHELE_BAKE OUT.json
Times the evaluation of a geometry-nodes Volume Cube (no file written) and our filling (as the bake reports it).
Runs inside Blender; depends on bpy and Python's standard library.
"""
import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bpy

EDGE = 256  # voxels
FEATURE = 50.0  # voxels
OCTAVES = 5
REPEATS = 3
TARGET = 40.0

RECIPE = f"""
assets:
  box:
    voxel_size: 1
    cutoff: 0
    precision: float
    density:
      multiply:
        - box: {{center: [127.5, 127.5, 127.5], size: [{EDGE}, {EDGE}, {EDGE}], rounding: 0, falloff: 0}}
        - remap: {{from: [-1.5, 1], input: {{fbm: {{cell_size: {FEATURE}, octaves: {OCTAVES}}}}}}}
"""


def volume_cube():
    """An object whose modifier makes the cube; returns it and the node whose seed-like input forces a new evaluation."""
    tree = bpy.data.node_groups.new("cube", "GeometryNodeTree")
    tree.outputs.new("NodeSocketGeometry", "Geometry")
    noise = tree.nodes.new("ShaderNodeTexNoise")
    noise.noise_dimensions = "3D"
    noise.inputs["Detail"].default_value = OCTAVES - 1  # Blender counts the octaves beyond the first
    noise.inputs["Scale"].default_value = 2.0 * EDGE / 2.0 / FEATURE  # the cube is 2 units wide
    cube = tree.nodes.new("GeometryNodeVolumeCube")
    for axis in "XYZ":
        cube.inputs[f"Resolution {axis}"].default_value = EDGE
    output = tree.nodes.new("NodeGroupOutput")
    tree.links.new(noise.outputs["Fac"], cube.inputs["Density"])
    tree.links.new(cube.outputs["Volume"], output.inputs[0])
    holder = bpy.data.objects.new("holder", bpy.data.meshes.new("empty"))
    bpy.context.collection.objects.link(holder)
    modifier = holder.modifiers.new("nodes", "NODES")
    modifier.node_group = tree
    return holder, cube


def blender_seconds(holder, cube, turn):
    cube.inputs["Background"].default_value = 1e-6 * turn  # a change, so that it is evaluated again
    start = time.perf_counter()
    bpy.context.view_layer.update()
    evaluated = holder.evaluated_get(bpy.context.evaluated_depsgraph_get())
    seconds = time.perf_counter() - start
    if evaluated.type != "MESH":
        raise RuntimeError("the holder became something else")
    return seconds


def our_seconds(bake, folder):
    report = Path(folder) / "report.json"
    subprocess.run([bake, str(Path(folder) / "box.yaml"), "--out", str(Path(folder) / "out"), "--force", "--quiet",
                    "--report", str(report)], check=True)
    asset = json.loads(report.read_text())["assets"][0]
    if asset["voxels_active"] != EDGE ** 3:
        raise RuntimeError(f"our box holds {asset['voxels_active']} voxels")
    return asset["seconds"]["fill"], asset["content_hash"]


def main():
    bake, out = sys.argv[sys.argv.index("--") + 1:]
    holder, cube = volume_cube()
    ours, theirs, content = [], [], ""
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "box.yaml").write_text(RECIPE)
        for turn in range(REPEATS + 1):  # the first turn of each side does not count
            theirs.append(blender_seconds(holder, cube, turn + 1))
            seconds, content = our_seconds(bake, folder)
            ours.append(seconds)
    best, peer = min(ours[1:]), min(theirs[1:])
    line = {"name": "blender/volume_cube_256", "figure": peer / best, "unit": "x", "at_least": TARGET,
            "reached": peer / best >= TARGET, "seconds_ours": best, "seconds_theirs": peer, "hash": content}
    print(f"{line['name']:44} {line['figure']:7.2f} x  >= {TARGET:g} {'reached' if line['reached'] else 'MISSED'} "
          f"{1000 * best:.2f} ms, theirs {1000 * peer:.2f} ms  {content}", flush=True)
    Path(out).write_text(json.dumps({"ratios": [line]}, indent=2))


main()
