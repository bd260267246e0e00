#!/usr/bin/env python3
"""Shows that arrows.py fails: each case plants one wrong arrow in a small tree and expects the sentence that names it.

Depends on arrows.py and Python's standard library alone.
"""
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
import arrows

# A tree in which every arrow is right.
RIGHT = {
    "base/error.h": "#include <string>\n",
    "base/yaml.h": "#include <vector>\n",
    "base/yaml.cpp": "#include <yaml-cpp/yaml.h>\n",
    "base/CMakeLists.txt": "add_library(nephele_base STATIC yaml.cpp)\n"
                           "target_link_libraries(nephele_base PRIVATE yaml-cpp)\n",
    "scene/scene.h": '#include "base/error.h"\n',
    "volume/bricks.h": "#include <vector>\n",
    "volume/vdb_file.h": '#include <openvdb/openvdb.h>\n#include "base/error.h"\n',
    "volume/make_grid.cpp": '#include "volume/vdb_file.h"\nauto g = openvdb::FloatGrid::create();\n',
    "volume/CMakeLists.txt": "add_library(nephele_volume STATIC bricks.cpp make_grid.cpp)\n"
                             "target_link_libraries(nephele_volume PUBLIC nephele_base PRIVATE OpenVDB::openvdb)\n",
    "bake/main.cpp": '#include "bake/run.h"\nint main(int, char** argv) { return run(argv); }\n',
    "bake/run.h": '#include "bake/voxelize.h"\n',
    "bake/voxelize.h": '#include "bake/fields/field.h"\n',
    "bake/voxelize.cpp": '#include "bake/voxelize.h"\n#include "volume/vdb_file.h"\n',
    "bake/fields/field.h": "// argv is read in main alone\n#include <vector>\n",
    "bake/CMakeLists.txt": "add_executable(nephele-bake main.cpp voxelize.cpp)\n"
                           "target_link_libraries(nephele-bake PRIVATE nephele_volume)\n",
    "preview/gpu/pass.h": '#include <glad/gl.h>\n#include "volume/bricks.h"\n#include "shaders/shared/phase.glsl"\n',
    "preview/twin/march.cpp": '#include "shared/phase.glsl"\n#include "volume/bricks.h"\n',
    "preview/CMakeLists.txt": "add_library(nephele_gpu STATIC gpu/pass.cpp)\n"
                              "target_link_libraries(nephele_gpu PRIVATE OpenGL::EGL nephele_volume)\n",
    "shaders/shared/phase.glsl": "float phase();\n",
    "shaders/shared/dialect.h": "#include <glm/glm.hpp>\n",
    "tests/base/error_test.cpp": '#include "base/error.h"\n#include "preview/gpu/pass.h"\n',
}

# (file, line to add, what the fault's sentence must hold)
WRONG = [
    ("base/error.h", '#include "scene/scene.h"', "base/error.h:2: base -> scene"),
    ("scene/scene.h", '#include "volume/bricks.h"', "scene/scene.h:2: scene -> bricks"),
    ("scene/scene.h", "#include <yaml-cpp/yaml.h>", "scene -> yaml-cpp"),
    ("volume/bricks.h", "#include <openvdb/openvdb.h>", "bricks -> OpenVDB"),
    ("volume/make_grid.cpp", '#include "scene/scene.h"', "volume -> scene"),
    ("bake/fields/field.h", '#include "volume/bricks.h"', "bake/fields -> bricks"),
    ("bake/fields/field.h", "#include <chrono>", "knows no YAML, clock"),
    ("bake/fields/field.h", '#include "base/yaml.h"', "knows no YAML"),
    ("bake/run.h", '#include "volume/vdb_file.h"', "bake/run.h:2: bake -> OpenVDB"),
    ("bake/run.h", '#include "preview/gpu/pass.h"', "bake -> preview/gpu"),
    ("bake/run.h", "#include <GLFW/glfw3.h>", "bake -> GL"),
    ("bake/run.h", 'const char* home = std::getenv("HOME");', "only main.cpp reads"),
    ("bake/run.h", "if (failed) exit(1);", "no file ends the program"),
    ("bake/voxelize.cpp", "auto grid = openvdb::FloatGrid::create();", "volume/make_grid.cpp alone"),
    ("preview/gpu/pass.h", '#include "bake/fields/field.h"', "preview/gpu -> bake/fields"),
    ("preview/gpu/pass.h", '#include "volume/vdb_file.h"', "preview/gpu -> OpenVDB"),
    ("preview/twin/march.cpp", '#include "preview/gpu/pass.h"', "preview/twin -> GL"),
    ("shaders/shared/phase.glsl", '#include "dialect.h"', "shared texts include nothing"),
    ("shaders/shared/dialect.h", '#include "base/error.h"', "shared -> base"),
    ("shaders/shared/dialect.h", "#include <openvdb/openvdb.h>", "shared -> OpenVDB"),
    ("shaders/shared/dialect.h", "#include <yaml-cpp/yaml.h>", "GLM and std alone"),
    ("bake/run.h", '#include "tests/base/error_test.cpp"', "bake -> tests"),
    ("bake/CMakeLists.txt", "target_link_libraries(nephele-bake PRIVATE nephele_gpu)", "the bake program links no GL"),
    ("bake/CMakeLists.txt", "target_link_libraries(nephele-bake PRIVATE glfw)", "bake -> GL"),
    ("preview/CMakeLists.txt", "target_link_libraries(nephele_gpu PRIVATE nephele-bake)", "links no recipe code"),
    ("base/CMakeLists.txt", "target_link_libraries(nephele_base PUBLIC nephele_volume)", "base -> bricks+volume"),
    ("base/CMakeLists.txt", "target_link_libraries(nephele_base PUBLIC OpenVDB::openvdb)", "base -> OpenVDB"),
]


def faults_of(tree):
    with tempfile.TemporaryDirectory() as folder:
        for name, text in tree.items():
            file = Path(folder) / name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return arrows.faults(Path(folder))


class ArrowsTest(unittest.TestCase):
    def test_a_right_tree_has_no_fault(self):
        self.assertEqual(faults_of(RIGHT), [])

    def test_every_wrong_arrow_is_named(self):
        for file, line, sentence in WRONG:
            with self.subTest(file=file, line=line):
                found = faults_of({**RIGHT, file: RIGHT[file] + line + "\n"})
                self.assertTrue(any(sentence in fault for fault in found), f"expected {sentence!r} in {found}")


if __name__ == "__main__":
    unittest.main()
