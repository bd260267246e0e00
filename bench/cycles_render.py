"""Runs inside Blender: renders a .vdb with Cycles on the CPU under the light of a scene, as the previewer would see it.

usage: blender -b --factory-startup --python-exit-code 1 --python cycles_render.py -- JOB.json
The job: file, out (.exr), size, samples, seed, bounces, threads, camera {position, target, up, fov}, medium {sigma_s, sigma_a, g},
suns [{to_light, irradiance}], environment. Prints one line "seconds S": the render alone, without Blender's start.
"""
import json
import math
import sys
import time

import bpy
from mathutils import Matrix, Vector


def material(medium):
    """Scattering and absorption by the grid's density; the two nodes take coefficients per world unit."""
    made = bpy.data.materials.new("medium")
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    nodes.clear()
    density = nodes.new("ShaderNodeAttribute")
    density.attribute_name = "density"

    def coefficient(shader, value):
        times = nodes.new("ShaderNodeMath")
        times.operation = "MULTIPLY"
        times.inputs[1].default_value = value
        links.new(density.outputs["Fac"], times.inputs[0])
        links.new(times.outputs[0], shader.inputs["Density"])

    scatter = nodes.new("ShaderNodeVolumeScatter")
    scatter.inputs["Color"].default_value = (1, 1, 1, 1)
    scatter.inputs["Anisotropy"].default_value = medium["g"]
    coefficient(scatter, medium["sigma_s"])
    absorb = nodes.new("ShaderNodeVolumeAbsorption")
    absorb.inputs["Color"].default_value = (0, 0, 0, 1)
    coefficient(absorb, medium["sigma_a"])
    both, out = nodes.new("ShaderNodeAddShader"), nodes.new("ShaderNodeOutputMaterial")
    links.new(scatter.outputs[0], both.inputs[0])
    links.new(absorb.outputs[0], both.inputs[1])
    links.new(both.outputs[0], out.inputs["Volume"])
    return made


def look_at(position, target, up):
    """The matrix of an object at `position` whose −Z axis looks at `target`."""
    back = (Vector(position) - Vector(target)).normalized()
    right = Vector(up).cross(back).normalized()
    above = back.cross(right)
    turned = Matrix((right, above, back)).transposed().to_4x4()
    return Matrix.Translation(position) @ turned


def add(name, data, matrix):
    made = bpy.data.objects.new(name, data)
    made.matrix_world = matrix
    bpy.context.collection.objects.link(made)
    return made


def build(job):
    for old in list(bpy.data.objects):
        bpy.data.objects.remove(old)
    bpy.ops.object.volume_import(filepath=job["file"])
    volume = bpy.context.object
    volume.name = "volume"  # Cycles' sampling seed hangs on the name
    volume.data.materials.append(material(job["medium"]))
    camera = bpy.data.cameras.new("camera")
    camera.sensor_fit = "VERTICAL"
    camera.angle = math.radians(job["camera"]["fov"])
    camera.clip_end = 1e5
    bpy.context.scene.camera = add("camera", camera, look_at(*(job["camera"][k] for k in ("position", "target", "up"))))
    for number, sun in enumerate(job["suns"]):
        light = bpy.data.lights.new(f"sun{number}", "SUN")
        light.angle = 0.0
        light.energy = 1.0
        light.color = sun["irradiance"]
        to = Vector(sun["to_light"])
        helper = (0, 0, 1) if abs(to.normalized().z) < 0.9 else (1, 0, 0)
        add(f"sun{number}", light, look_at(to, (0, 0, 0), helper))


def settings(job):
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.render.resolution_x, scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.film_transparent = True
    scene.render.threads_mode = "FIXED"
    scene.render.threads = job["threads"]
    world = bpy.data.worlds.new("world")
    world.use_nodes = True
    world.node_tree.nodes["Background"].inputs["Color"].default_value = (*job["environment"], 1)
    scene.world = world
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples = job["samples"]
    cycles.seed = job["seed"]
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.volume_bounces = job["bounces"]
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.volume_step_rate = job.get("step_rate", 1.0)
    image = scene.render.image_settings
    image.file_format, image.color_mode, image.color_depth = "OPEN_EXR", "RGBA", "32"
    scene.render.filepath = job["out"]


def main():
    with open(sys.argv[sys.argv.index("--") + 1]) as file:
        job = json.load(file)
    build(job)
    settings(job)
    start = time.monotonic()
    bpy.ops.render.render(write_still=True)
    print(f"seconds {time.monotonic() - start:.3f}")


main()
