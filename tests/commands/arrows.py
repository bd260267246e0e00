#!/usr/bin/env python3
"""Holds #include lines and CMake link lines against the arrows between the folders (docs/architecture.md).

usage: arrows.py ROOT     prints file:line and the broken arrow for each fault; exit 1 where there is one
Depends on Python's standard library alone.
"""
import re
import sys
from pathlib import Path

# A room is a set of files that share their arrows. The first pattern that matches a path names its room.
ROOMS = [
    ("bake/main", r"bake/main\.cpp"),
    ("bake/fields", r"bake/fields/"),
    ("bake/pipeline", r"bake/(pipeline|field_specs)"),
    ("bake/voxelize", r"bake/(voxelize|splat)"),
    ("bake", r"bake/"),
    ("preview/main", r"preview/main\.cpp"),
    ("preview/gpu", r"preview/gpu/"),
    ("preview/twin", r"preview/twin/"),
    ("preview/truth", r"preview/truth/"),
    ("preview/measure", r"preview/measure/"),
    ("method", r"preview/(method|filter|stage_places|viewed_scene)\.h"),
    ("preview", r"preview/"),
    ("shared", r"shaders/shared/"),
    ("shaders", r"shaders/"),
    ("bricks", r"volume/(bricks\.(h|cpp)|brick_(bounds|builder|cut|layout|levels|packing|texel)\.(h|cpp))"),
    ("volume", r"volume/"),
    ("scene", r"scene/"),
    ("particles", r"particles/"),
    ("base", r"base/"),
    ("bench", r"bench/"),
    ("tests", r"tests/"),
]

# Where each room's arrows may end, apart from itself.
ARROWS = {
    "base": set(),
    "shared": set(),
    "shaders": {"shared"},
    "scene": {"base"},
    "bricks": {"base"},
    "volume": {"bricks", "base"},
    "particles": {"base", "shared"},
    "bake/fields": {"base", "shared"},
    "bake/pipeline": {"bake/fields", "particles", "scene", "base"},
    "bake/voxelize": {"bake/fields", "particles", "volume", "bricks", "base"},
    "bake": {"bake/fields", "bake/pipeline", "bake/voxelize", "particles", "scene", "volume", "bricks", "base"},
    "bake/main": {"bake", "bake/fields", "bake/pipeline", "bake/voxelize", "volume", "base"},
    "method": {"scene", "bricks", "base"},
    "preview/gpu": {"method", "shared", "scene", "particles", "bricks", "base"},
    "preview/twin": {"shared", "bricks", "base"},
    "preview/truth": {"method", "scene", "bricks", "base"},
    "preview/measure": {"method", "scene", "bricks", "base"},
    "preview": {"method", "preview/gpu", "preview/twin", "preview/truth", "preview/measure", "shared", "scene", "particles",
                "volume", "bricks", "base"},
    "preview/main": {"preview", "method", "preview/measure", "scene", "base"},
}
EVERYTHING = {"tests", "bench"}  # rooms that may reach all rooms but tests

# Libraries of others that only some rooms may see, even through a header of another room.
LIBRARIES = {
    "OpenVDB": (r"openvdb/", {"volume", "bake/voxelize"}),
    "GL": (r"(glad|GL|GLES\d?|EGL|GLFW|imgui)[/.]|imgui_", {"preview/gpu", "preview", "preview/main"}),
    "yaml-cpp": (r"yaml-cpp/", {"base"}),
}
LINKED_LIBRARIES = {
    "OpenVDB": r"OpenVDB::",
    "GL": r"OpenGL::|glfw|(nephele_)?glad|imgui|EGL",
    "yaml-cpp": r"yaml-cpp",
}
FIELDS_NEVER = r"base/yaml\.h|<(chrono|ctime|thread|time\.h|iostream|fstream|filesystem)>|tbb/"

# Words that some files may not hold: (regular expression, files held to it, files that may, sentence).
WORDS = [
    (r"\bargv\b|\bgetenv\b|\bcurrent_path\b|\bgetcwd\b|\benviron\b", r"(?!tests/|bench/)",
     r"(bake|preview)/main\.cpp", "only main.cpp reads arguments, environment and working directory"),
    (r"\bFloatGrid::create\s*\(", "", r"volume/make_grid\.cpp",
     "FloatGrid::create is called in volume/make_grid.cpp alone (each such file costs 8 s of compilation)"),
    (r"(?<![.\w>])exit\s*\(", r"(?!tests/|bench/)", r"$^",
     "no file ends the program: throw, and main turns it into an exit code"),
]

SOURCES = {".cpp", ".h", ".glsl", ".vert", ".frag", ".comp"}
INCLUDE = re.compile(r'^\s*#\s*include\s*([<"])([^>"]+)[>"]')


def room_of(path):
    """The room of a path relative to the root, or None outside all rooms."""
    return next((room for room, pattern in ROOMS if re.match(pattern, path)), None)


def source_files(root):
    """Relative paths of all sources in the rooms, sorted."""
    folders = sorted({re.match(r"\w+", pattern).group() for _, pattern in ROOMS})
    files = (file for folder in folders for file in (root / folder).rglob("*"))
    return sorted(str(file.relative_to(root)) for file in files if file.suffix in SOURCES)


def without_comments_and_text(line):
    return re.sub(r'//.*|"(\\.|[^"\\])*"', "", line)


class Includes:
    """All #include lines of the tree: per file a list of (line number, name, bracket, path in the tree or None)."""

    def __init__(self, root, files):
        self.lines = {}
        known = set(files)
        for file in files:
            found = []
            for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
                match = INCLUDE.match(line)
                if match:
                    bracket, name = match.groups()
                    found.append((number, name, bracket, self.resolve(file, name, known)))
            self.lines[file] = found

    @staticmethod
    def resolve(file, name, known):
        """The file an #include means: from the root, beside the including file, or among the shaders."""
        for candidate in (Path(name), Path(file).parent / name, Path("shaders") / name, Path("shaders/shared") / name):
            if str(candidate) in known:
                return str(candidate)
        return None

    def reaches(self, file, pattern, seen=None):
        """True where a file includes a name that matches, itself or through the tree's headers."""
        seen = seen if seen is not None else set()
        if file in seen:
            return False
        seen.add(file)
        return any(re.match(pattern, name) if inside is None else self.reaches(inside, pattern, seen)
                   for _, name, _, inside in self.lines[file])


def allowed(room, target):
    if target == room:
        return True
    return target != "tests" if room in EVERYTHING else target in ARROWS[room]


def include_faults(includes):
    for file, lines in includes.lines.items():
        room = room_of(file)
        for number, name, bracket, inside in lines:
            where = f"{file}:{number}"
            if inside is not None:
                target = room_of(inside)
                if not allowed(room, target):
                    yield f"{where}: {room} -> {target}: no such arrow (includes {inside})"
            for library, (pattern, rooms) in LIBRARIES.items():
                hit = includes.reaches(inside, pattern) if inside else re.match(pattern, name)
                if hit and room not in rooms | EVERYTHING:
                    yield f"{where}: {room} -> {library}: no such arrow (includes {name})"
            if room == "bake/fields" and re.match(FIELDS_NEVER, f"<{name}>" if bracket == "<" else name):
                yield f"{where}: bake/fields knows no YAML, clock, thread or file (includes {name})"
            if room == "shared" and (file.endswith(".glsl") or not (inside or re.match(r"glm/|\w+$", name))):
                yield f"{where}: shared -> {name}: shared texts include nothing, their headers GLM and std alone"


def word_faults(root, files):
    for file in files:
        rules = [rule for rule in WORDS if re.match(rule[1], file) and not re.match(rule[2], file)]
        for number, line in enumerate((root / file).read_text(errors="replace").splitlines(), 1):
            for pattern, _, _, sentence in rules:
                if re.search(pattern, without_comments_and_text(line)):
                    yield f"{file}:{number}: {sentence}"


class Links:
    """All add_library, add_executable and target_link_libraries of the tree's CMakeLists.txt."""

    COMMAND = re.compile(r"\b(add_library|add_executable|target_link_libraries)\s*\(([^)]*)\)", re.S)
    KEYWORDS = {"PUBLIC", "PRIVATE", "INTERFACE", "STATIC", "OBJECT", "IMPORTED", "ALIAS", "GLOBAL"}

    def __init__(self, root):
        self.rooms = {}  # target -> rooms of its sources
        self.links = []  # (file:line, target, linked names)
        for file in sorted(root.rglob("CMakeLists.txt")):
            folder = file.relative_to(root).parent
            if room_of(f"{folder}/") is None and str(folder) != ".":
                continue  # a build folder, or nothing of ours
            self.read(file.read_text(), str(file.relative_to(root)), folder)

    def read(self, text, file, folder):
        text = re.sub(r"#[^\n]*", "", text)
        for match in self.COMMAND.finditer(text):
            name, *rest = match.group(2).split() or [""]
            names = [word for word in rest if word not in self.KEYWORDS]
            if match.group(1) == "target_link_libraries":
                line = text.count("\n", 0, match.start()) + 1
                self.links.append((f"{file}:{line}", name, names))
            else:
                self.rooms[name] = {room for word in names if "$" not in word and (room := room_of(str(folder / word)))}

    def reached(self, target, seen=None):
        """All names linked to a target, directly or through our own targets."""
        seen = seen if seen is not None else set()
        for _, name, linked in self.links:
            if name == target:
                for other in linked:
                    if other not in seen:
                        seen.add(other)
                        self.reached(other, seen)
        return seen


def link_faults(links):
    for where, target, linked in links.links:
        rooms = links.rooms.get(target, set())
        for other in linked:
            ends = links.rooms.get(other, set())
            if rooms and ends and not any(allowed(room, end) for room in rooms for end in ends):
                yield f"{where}: {'+'.join(sorted(rooms))} -> {'+'.join(sorted(ends))}: no such arrow (links {other})"
            for library, pattern in LINKED_LIBRARIES.items():
                if rooms and re.match(pattern, other) and not rooms & (LIBRARIES[library][1] | EVERYTHING):
                    yield f"{where}: {'+'.join(sorted(rooms))} -> {library}: no such arrow (links {other})"
        top = {room.split("/")[0] for room in rooms}
        reached = links.reached(target)
        if "bake" in top and any(re.match(LINKED_LIBRARIES["GL"], name) for name in reached):
            yield f"{where}: bake -> GL: the bake program links no GL"
        if "preview" in top:
            for name in reached:
                if any(room.startswith("bake") for room in links.rooms.get(name, set())):
                    yield f"{where}: preview -> bake: the previewer links no recipe code (reaches {name})"


def faults(root):
    """Every broken arrow below `root`, as sentences that begin with file:line; each once, sorted."""
    files = source_files(root)
    includes, links = Includes(root, files), Links(root)
    return sorted({*include_faults(includes), *word_faults(root, files), *link_faults(links)})


def main():
    root = Path(sys.argv[1])
    found = faults(root)
    print("\n".join(found) if found else f"no broken arrow in {len(source_files(root))} files")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
