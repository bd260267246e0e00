"""The command-line cases of the programs, one a line: command, exit code, what stderr must hold, and the edit of a
good recipe that makes the input wrong. Run by cases.py. Depends on nothing.
"""
from dataclasses import dataclass, field

GOOD_RECIPE = """\
up_axis: z
assets:
  ball:
    voxel_size: 0.1
    density:
      sphere: { radius: 1.0, falloff: 0.5 }
"""


PARTICLES = """\
assets:
  puff:
    voxel_size: 0.1
    frames: 1-3
    particles:
      emitters: [{ bursts: [[0, 40]], particle_radius: 0.2, velocity: [0, 0, 1] }]
"""


BALL_BESIDE = """\
  ball:
    voxel_size: 0.1
    density: { sphere: { radius: 1 } }
"""


@dataclass
class Case:
    command: str
    exits: tuple
    stderr: tuple = ()
    stdout: tuple = ()
    recipe: str = None      # written to pipeline.yaml first
    file_bytes: int = None  # the largest file that the program may write
    files: dict = field(default_factory=dict)  # name -> text, written first
    note: str = ""


def says(command, exit_code, *stderr, **more):
    return Case(command, (exit_code,), stderr, **more)


def prints(command, *stdout, **more):
    return Case(command, (0,), (), stdout, **more)


def wrong(old, new, *stderr):
    """Baking the good recipe with `old` replaced by `new` ends with 2 and says each of `stderr`."""
    assert old in GOOD_RECIPE, old
    return Case("bake pipeline.yaml", (2,), stderr, recipe=GOOD_RECIPE.replace(old, new), note=repr(new))


def wrong_particles(old, new, *stderr, files=None):
    """The same for the good recipe of particles; `files` are written beside it."""
    assert old in PARTICLES, old
    return Case("bake pipeline.yaml", (2,), stderr, recipe=PARTICLES.replace(old, new), files=files or {}, note=repr(new))


def with_density(text, fields=""):
    """The good recipe of another density, with named fields before it."""
    return fields + GOOD_RECIPE.replace(SPHERE, text)


SPHERE = "sphere: { radius: 1.0, falloff: 0.5 }"
DEEP = "add: [{ " * 10000 + "sphere" + " }]" * 10000
# Eight of the one before, 14 times: 10^12 fields in two kilobytes.
BOMB = "fields:\n  f0: sphere\n" + "".join(f"  f{n}: {{ add: [{', '.join([f'f{n - 1}'] * 8)}] }}\n" for n in range(1, 15))
ALIAS_BOMB = "fields:\n  f0: &f0 { sphere: {} }\n" + "".join(
    f"  f{n}: &f{n} {{ add: [{', '.join([f'*f{n - 1}'] * 8)}] }}\n" for n in range(1, 15))

TWO_DOMAINS = """\
up_axis: z
assets:
  a:
    voxel_size: 0.0001
    density: sphere
  b:
    voxel_size: 0.1
    density: fbm
"""

BURST = "bursts: [[0, 40]]"
POINTS = "shape: points, file: points.csv"

BAKE = [
    prints("bake pipeline.yaml --dry-run", "out/ball.vdb", recipe=GOOD_RECIPE),
    prints("bake --help", "--threads", "--force", "--report"),
    prints("bake nodes", "perlin", "sphere", "height_profile"),
    prints("bake nodes sphere", "radius", "world units"),
    prints("bake info good.vdb", "density", "fog volume"),
    # recipes
    says("bake nowhere.yaml", 2, "nowhere.yaml: error: no such file"),
    wrong("sphere:", "sphere: [", "pipeline.yaml:", "error: not valid YAML"),
    wrong("sphere:", "sphre:", "pipeline.yaml:6:7: error: unknown field 'sphre'; did you mean 'sphere'?"),
    wrong("voxel_size", "voxel_sise", "pipeline.yaml:4:5: error: unknown key 'voxel_sise'", "mean 'voxel_size'?"),
    wrong("radius: 1.0", "radis: 1.0", "pipeline.yaml:6:17: error: unknown key 'radis'", "did you mean 'radius'?"),
    wrong("up_axis: z", "up_axis: z\nup_axis: y", "pipeline.yaml:2:1: error: key 'up_axis' is given twice"),
    wrong("voxel_size: 0.1", "voxel_size: small", "pipeline.yaml:4:17: error: 'voxel_size'", "must be a number"),
    wrong("voxel_size: 0.1", "voxel_size: -0.1", "pipeline.yaml:4:17: error: 'voxel_size'", "must be greater than 0"),
    wrong("voxel_size: 0.1", "voxel_size: 0", "pipeline.yaml:4:17: error: 'voxel_size'", "must be greater than 0"),
    wrong("voxel_size: 0.1", "voxel_size: .nan", "pipeline.yaml:4:17: error: 'voxel_size'"),
    wrong("    voxel_size: 0.1\n", "", "error:", "voxel_size"),
    wrong("voxel_size: 0.1", "voxel_size: 0.1\n    tolerance: 1%", "pipeline.yaml:5:5: error:", "both 'voxel_size' and"),
    wrong("voxel_size: 0.1", "voxel_size: 0.1\n    density_step: 0.1", "pipeline.yaml:5:5: error: 'density_step' must be 0 or a power",
          "for example 0.0625"),
    wrong("radius: 1.0", "radius: -1.0", "pipeline.yaml:6:25: error: 'radius'", "must be greater than 0"),
    wrong("up_axis: z", "up_axis: x", "pipeline.yaml:1:10: error: 'up_axis' must be one of"),
    wrong("radius: 1.0, falloff: 0.5", "radius: wide, fallof: 0.5", "pipeline.yaml:6:25: error: 'radius'",
          "pipeline.yaml:6:31: error: unknown key 'fallof'"),
    wrong("assets:", "assets: {}\nrest:", "error:"),
    # motion
    wrong("    density:", "    loop: true\n    density:", "pipeline.yaml:5:5: error: 'loop' needs 'frames'"),
    wrong("    density:", "    frames: 1-4\n    loop: maybe\n    density:", "pipeline.yaml:6:11: error: 'loop'"),
    wrong("sphere: { radius: 1.0, falloff: 0.5 }", "perlin: { evolve: .inf }", "pipeline.yaml:6:25: error: 'evolve'"),
    wrong("sphere: { radius: 1.0, falloff: 0.5 }", "transform: { input: sphere, scale: [1, 0, 1] }",
          "pipeline.yaml:6:46: error: 'scale' of 'transform'"),
    wrong("sphere: { radius: 1.0, falloff: 0.5 }", "warp: { input: sphere, iterations: 9 }",
          "'iterations' of 'warp' must be 1 to 8, found 9"),
    wrong("    density:", "    velocity: sphere\n    density:", "pipeline.yaml:5:15: error: 'velocity' needs three"),
    # densities that no grid can hold
    wrong("voxel_size: 0.1", "voxel_size: 0.0000001", "pipeline.yaml:", "error:", "voxels"),
    wrong("sphere: { radius: 1.0, falloff: 0.5 }", "constant: { value: 1 }", "pipeline.yaml:", "error:"),
    wrong("sphere: { radius: 1.0, falloff: 0.5 }", "multiply: [ sphere, 1e6 ]", "pipeline.yaml:", "error:", "65504"),
    wrong(SPHERE, "sphere: { radius: .inf }", "pipeline.yaml:6:25: error: 'radius' of 'sphere' must be a finite number"),
    wrong(SPHERE, "sphere: { radius: 0 }", "pipeline.yaml:6:25: error: 'radius' of 'sphere' must be greater than 0, found 0"),
    wrong(SPHERE, "box: { size: [1, 0, 1] }", "pipeline.yaml:6:24: error: 'size' of 'box' must be greater than 0, found 0"),
    wrong(SPHERE, "sphere: { radius: 1 m }", "pipeline.yaml:6:25: error: 'radius' of 'sphere' must be a number, found '1 m'"),
    wrong(SPHERE, "remap: { from: [1, 1], input: sphere }", "pipeline.yaml:6:16: error: both ends of 'from' are equal"),
    wrong("voxel_size: 0.1", "voxel_size: 0.0001", "pipeline.yaml:", "holds 8e+12 voxels (3.2e+04 GB if dense)"),
    says("bake pipeline.yaml --dry-run", 2, "pipeline.yaml:3:3: error: asset 'a': the density's box holds 8e+12 voxels",
         "pipeline.yaml:6:3: error: asset 'b': the density fills all of space", recipe=TWO_DOMAINS, note="both assets at once"),
    says("bake pipeline.yaml", 2, "pipeline.yaml:3:3: error: asset 'a'", "pipeline.yaml:6:3: error: asset 'b'",
         recipe=TWO_DOMAINS, note="both assets at once"),
    says("bake pipeline.yaml --dry-run", 2, "pipeline.yaml:3:3: error: asset 'ball': the density fills all of space",
         recipe=GOOD_RECIPE.replace("voxel_size: 0.1", "tolerance: 3%").replace(SPHERE, "fbm: {}"), note="voxels yet to be chosen"),
    says("bake pipeline.yaml --dry-run", 2, "pipeline.yaml:3:3: error: asset 'ball': the density fills about ",
         "GB of memory, and ", "GB are available; use larger voxels",
         recipe=GOOD_RECIPE.replace("0.1", "0.000205").replace("falloff: 0.5", "falloff: 1.0"), note="9.3e11 voxels"),
    prints("bake pipeline.yaml --dry-run", "out/ball.vdb", note="two grains in 5e11 voxels", recipe=GOOD_RECIPE.replace(
        SPHERE, "union: [{ sphere: { radius: 0.2, center: [399, 399, 399] } }, { sphere: { radius: 0.2, center: [-399, -399, -399] } }]")),
    wrong("    density:", "    fps: 1e-300\n    density:", "pipeline.yaml:5:10: error: 'fps' must be 0.01 to 100000, found 1e-300"),
    wrong("    density:", "    fps: .inf\n    density:", "pipeline.yaml:5:10: error: 'fps' must be a finite number"),
    wrong("    density:", "    frames: 1-2147483647\n    density:",
          "pipeline.yaml:5:13: error: 'frames' must read A-B, with 0 <= A <= B <= 999999"),
    wrong("    density:", "    frames: 2147483648-2147483649\n    density:", "pipeline.yaml:5:13: error: 'frames' must read A-B"),
    wrong(SPHERE, "remap: { from: [1, 1], input: { sphere: { radius: 0 } } }", "pipeline.yaml:6:16: error: both ends of 'from'",
          "pipeline.yaml:6:57: error: 'radius' of 'sphere' must be greater than 0"),
    wrong(SPHERE, "remap: { from: [1, 1], to: wide, input: sphre }", "pipeline.yaml:6:16: error: both ends of 'from'",
          "pipeline.yaml:6:34: error: 'to' of 'remap'", "pipeline.yaml:6:47: error: unknown field 'sphre'"),
    wrong(SPHERE, "height_profile: { curve: [[0, a], [1, b]] }", "pipeline.yaml:6:37: error:", "pipeline.yaml:6:45: error:"),
    says("bake pipeline.yaml", 2, "pipeline.yaml:3:14: error: a field cannot be made of itself: a -> b -> a",
         recipe=with_density("a", "fields:\n  a: { add: [b, 1] }\n  b: { max: [a] }\n"), note="a cycle"),
    says("bake pipeline.yaml", 2, "pipeline.yaml:", "error: nested deeper than 200 levels", recipe=with_density(DEEP),
         note="10,000 levels"),
    says("bake pipeline.yaml", 2, "fields, counting each use of a name", recipe=with_density("f14", BOMB), note="a bomb"),
    says("bake pipeline.yaml", 2, "fields, counting each use of a name", recipe=with_density("f14", ALIAS_BOMB),
         note="a bomb of aliases"),
    says("bake pipeline.yaml", 2, "pipeline.yaml:4:17: error:", "pipeline.yaml:6:15: error: unknown field 'sphre'",
         "pipeline.yaml:6:30: error: unknown field 'perlim'", recipe=GOOD_RECIPE.replace("0.1", "-1").replace(
             SPHERE, "union: [sphre, { max: [perlim] }]"), note="all errors at once"),
    says("bake pipeline.yaml", 0, "box: 0.3 voxels thick: voxels may miss it, or hold more than there is",
         recipe=with_density("box: { size: [1, 1, 0.03], rounding: 0 }"), note="a thin box"),
    says("bake pipeline.yaml", 0, "warp: makes its input 12 times finer, which voxels may not hold",
         recipe=with_density("multiply: [sphere, { warp: { input: fbm, warp_scale: 10, octaves: 1 } }]"), note="a wide warp"),
    says("bake pipeline.yaml", 0, "times finer: rounding decides what is read", recipe=with_density(
        "multiply: [sphere, { warp: { input: fbm, warp_scale: 100, iterations: 3 } }]"), note="a wide warp of a warp"),
    # particles
    prints("bake pipeline.yaml --dry-run --frames 2-3", "out/puff_0002.vdb\nout/puff_0003.vdb", recipe=PARTICLES),
    says("bake pipeline.yaml --frames 1-2 --shard 2/2", 0, "puff_0002.vdb", "40 particles", recipe=PARTICLES),
    says("bake pipeline.yaml --frames 1-1 --out empty", 0, "no voxel exceeds the cutoff; the file is valid and empty",
         recipe=PARTICLES.replace(BURST, "bursts: [[1, 40]]")),
    wrong_particles("emitters:", "emiters:", "pipeline.yaml:6:7: error: unknown key 'emiters'", "did you mean 'emitters'?"),
    wrong_particles("particle_radius: 0.2", "particle_radius: 0", "pipeline.yaml:6:56: error: 'particle_radius' must be greater"),
    wrong_particles("particle_radius: 0.2", "particle_radius: -1", "'particle_radius' must be greater than 0"),
    wrong_particles(BURST, BURST + ", life: 0", "'life' must be greater than 0"),
    wrong_particles(BURST, BURST + ", center: [0, .nan, 0]", "pipeline.yaml:6:", "'center'"),
    wrong_particles(BURST, BURST + ", center: [0, 1e30, 0]", "pipeline.yaml:6:", "'center'"),
    wrong_particles(BURST, "rate: 1e9, life: 1", "1e+09 particles at a time, which take 96 GB"),
    wrong_particles(BURST, "life: 1", "needs 'rate' or 'bursts'"),
    wrong_particles("particles:", "mass_tolerance: 1\n    particles:", "unknown key 'mass_tolerance'"),
    wrong_particles("    particles:\n", "    cutoff: 1\n    particles:\n      mass_tolerance: 0.01\n",
                    "asset 'puff', frame 1: the grid loses", "more than mass_tolerance, 1%"),
    wrong_particles("    particles:\n", "    density: sphere\n    particles:\n", "gives both 'density' and 'particles'"),
    wrong_particles(BURST, BURST + ", center: [1e9, 0, 0]", "frame 1: particle 0 at (1e+09", "is beyond voxel 2^30"),
    wrong_particles(BURST, POINTS, "points.csv: error: no such file"),
    wrong_particles(BURST, POINTS, "points.csv:1: error: has no column 'z'", files={"points.csv": "x,y\n1,2\n"}),
    wrong_particles(BURST, POINTS, "points.csv:2: error: point 0 has the radius 0", files={"points.csv": "x,y,z,radius\n1,2,3,0\n"}),
    wrong_particles(BURST, POINTS, "points.csv:2: error: point 0 has the life 0", files={"points.csv": "x,y,z,life\n1,2,3,0\n"}),
    wrong_particles(BURST, POINTS, "points.csv:3: error: has 2 columns", files={"points.csv": "x,y,z\n1,2,3\n1,2\n"}),
    wrong_particles(BURST, POINTS, "points.csv:2: error: point 0 has the y nan", files={"points.csv": "x,y,z\n1,nan,3\n"}),
    wrong_particles(BURST, POINTS, "holds no points to emit from", files={"points.csv": "x,y,z\n"}),
    # command lines
    says("bake --no-such-option", 2, "error: ", "--no-such-option"),
    says("bake pipeline.yaml --report nowhere/r.json", 1, "there is no folder"),
    says("bake pipeline.yaml --dry-run --frames 3-9", 2, "pipeline.yaml: error: --frames asks for 3 to 9, and no asset has frame 5",
         recipe=GOOD_RECIPE.replace("    density:", "    frames: 1-4\n    density:")),
    # An asset without frames beside the sequence is no frame.
    says("bake pipeline.yaml --dry-run --frames 60-60", 2, "pipeline.yaml: error: no asset has a frame from 60 to 60",
         recipe=PARTICLES + BALL_BESIDE),
    says("bake pipeline.yaml --dry-run --frames 2-4", 2, "--frames asks for 2 to 4, and no asset has frame 4", recipe=PARTICLES + BALL_BESIDE),
    prints("bake pipeline.yaml --dry-run --frames 2-3", "out/puff_0002.vdb\nout/puff_0003.vdb\nout/ball.vdb", recipe=PARTICLES + BALL_BESIDE),
    says("bake pipeline.yaml --threads many", 2, "--threads", recipe=GOOD_RECIPE),
    says("bake pipeline.yaml --threads -1", 2, "--threads"),
    says("bake pipeline.yaml --only bell", 2, "bell", "did you mean 'ball'?"),
    says("bake pipeline.yaml --frames 3-1", 2, "--frames must read A-B"),
    says("bake pipeline.yaml --shard 3/2", 2, "--shard must read I/N"),
    says("bake check good.vdb --for maya", 2, "no rules are known for 'maya'"),
    says("bake check good.vdb --for bender", 2, "did you mean 'blender'?"),
    says("bake diff good.vdb nowhere.vdb", 2, "nowhere.vdb: error: no such file"),
    says("bake diff good.vdb good.vdb --tolerance some", 2, "'some' is no tolerance"),
    prints("bake diff good.vdb good.vdb --tolerance 0", "largest difference 0 "),
    says("bake nodes sphre", 2, "sphre", "did you mean 'sphere'?"),
    # files that cannot be written
    says("bake pipeline.yaml --out a_file", 1, "a_file"),
    says("bake pipeline.yaml --out a_file/below", 1, "a_file"),
    says("bake pipeline.yaml", 1, "ball.vdb", file_bytes=4096, note="on a full disk"),
    # files that cannot be read
    says("bake info nowhere.vdb", 2, "nowhere.vdb: error: no such file"),
    says("bake info text.vdb", 2, "text.vdb: error:"),
    says("bake info empty.vdb", 2, "empty.vdb: error:"),
    says("bake info folder.vdb", 2, "folder.vdb: error:"),
    says("bake info cut_in_header.vdb", 2, "cut_in_header.vdb: error:"),
    says("bake info cut_in_data.vdb", 2, "cut_in_data.vdb: error:"),
    says("bake info cut_by_one.vdb", 2, "cut_by_one.vdb: error:"),
    Case("bake info flipped.vdb", (0, 1, 2), note="no crash, no hang"),
    prints("bake info vel_only.vdb", "vel"),
    # files held to the rules
    prints("bake check good.vdb", "good: 13 yes"),
    prints("bake check good.vdb --for houdini --json", '"good": true', '"holds": "not asked"'),
    says("bake check nowhere.vdb", 2, "nowhere.vdb: error: no such file"),
    says("bake check cut_in_data.vdb", 2, "cut_in_data.vdb: error:"),
    Case("bake check flipped.vdb", (0, 1, 2, 3), note="no crash, no hang"),
    says("bake check text.vdb good.vdb empty.vdb", 2, "text.vdb: error:", "empty.vdb: error:", stdout=("good.vdb",),
         note="the others are checked"),
    says("bake check vel_only.vdb", 3, stdout=("there is no grid 'density'",)),
    says("bake check level_set.vdb", 3, stdout=("there is no grid 'density'",)),
    says("bake check not_finite.vdb", 3, stdout=("are not finite",)),
]


def render(file, *stderr, exit_code=2, options="--size 16x9", **more):
    return says(f"preview {file} --render picture.exr {options}".strip(), exit_code, *stderr, **more)


PREVIEW = [
    prints("preview --help", "--render", "--size", "--scene"),
    render("good.vdb", exit_code=0),
    render("level_set.vdb", "level_set.vdb: error: holds no float grid that is a fog volume"),
    render("level_set.vdb", "level_set.vdb: error: grid 'surface' is a level set", options="--grid surface"),
    render("vel_only.vdb", "vel_only.vdb: error: holds no float grid"),
    render("not_finite.vdb", "not_finite.vdb: error: grid 'density' holds a value that is not finite"),
    render("nowhere.vdb", "nowhere.vdb: error: no such file"),
    render("text.vdb", "text.vdb: error:"),
    render("empty.vdb", "empty.vdb: error:"),
    render("cut_in_header.vdb", "cut_in_header.vdb: error:"),
    render("cut_in_data.vdb", "cut_in_data.vdb: error:"),
    render("cut_by_one.vdb", "cut_by_one.vdb: error:"),
    Case("preview flipped.vdb --render picture.exr --size 16x9", (0, 1, 2), note="no crash, no hang"),
    render("good.vdb", "good.vdb: error: holds no grid 'temperature'", options="--grid temperature"),
    render("good.vdb", "--no-such-option", options="--no-such-option"),
    render("good.vdb", "unknown method 'mrach'; did you mean 'march'?", options="--method mrach"),
    render("good.vdb", "the method 'impostor' is not built yet", options="--method impostor"),
    render("good.vdb", "", exit_code=0, options="--size 16x9 --method dda --spp 1"),
    render("good.vdb", "", exit_code=0, options="--size 16x9 --method cube --spp 1"),
    render("good.vdb", "noise:", exit_code=0, options="--size 16x9 --method reference --spp 8 --bounces 1"),
    render("good.vdb", "noise:", exit_code=0, options="--size 16x9 --method reference --error 20%"),
    render("good.vdb", "--bounces needs --method reference", options="--size 16x9 --bounces 1"),
    render("good.vdb", "the report look has none", options="--size 16x9 --error 1%"),
    render("good.vdb", "leave out --step and --spp", options="--size 16x9 --error 1% --spp 4"),
    render("good.vdb", "'some' is no tolerance", options="--size 16x9 --method reference --error some"),
    render("good.vdb", "nowhere.yaml: error: no such file", options="--scene nowhere.yaml"),
    render("good.vdb", "unknown preset 'sunst'; did you mean 'sunset'?", options="--scene sunst"),
    render("good.vdb", "look: report", exit_code=0, options="--size 16x9 --scene moonlight"),
    render("good.vdb", "--size", options="--size 0x9"),
    says("preview good.vdb --render picture.gif", 2, "'picture.gif' should end in .exr or .png"),
    says("preview good.vdb --frames 1-2", 2, "--frames needs --render"),
    says("preview good.vdb --render picture.exr --frames 3-1", 2, "should be FIRST-LAST or one frame"),
    says("preview good.vdb --render picture.exr --frames 1", 2, "a file name with a frame number"),
    says("preview good_0001.vdb --render picture.exr --size 16x9 --frames 1", 0),
    says("preview chart good.vdb", 2, "--out is required"),
    says("preview chart good.vdb --out charts --methods mrach", 2, "did you mean 'march'?"),
    says("preview chart good.vdb --out a_file/below", 1, "a_file"),
    prints("preview chart good.vdb --out charts --methods reference --minutes 0.02 --size 16x9", "reference, 256 spp"),
    says("preview chart good.vdb --out charts --methods reference --minutes 0.02 --size 16x9 --scene lit.yaml --bounces 0", 0,
         "single scattering is charted without octaves", files={"lit.yaml": "octaves: { count: 2 }\n"}),
    says("preview compare nowhere.exr nowhere.exr", 2, "nowhere.exr: error: no such file"),
    says("preview compare text.vdb text.vdb", 2, "text.vdb: error:"),
    says("preview good.vdb --render a_file/picture.exr --size 16x9", 1, "a_file"),
    says("preview", 2),
]

TOLERANCES = [
    says("tolerances . --only no_such_sample", 2, "no recipe 'no_such_sample' in .", recipe=GOOD_RECIPE),
]

TABLES = {"bake": BAKE, "preview": PREVIEW, "tolerances": TOLERANCES}
