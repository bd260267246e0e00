// Closed meshes as envelopes: against closed forms, and the files that are refused.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "bake/fields/mesh_file.h"
#include "bake/fields/shared_text.h"
#include "bake/fields/solid.h"
#include "tests/bake/field_samples.h"
#include "tests/scratch_folder.h"

namespace nephele::test {
namespace {

using Vector = std::array<double, 3>;

/// A ball of flat faces: an octahedron whose triangles are cut in four, `cuts` times.
std::string ballAsObj(int cuts, double radius) {
  std::vector<std::array<glm::dvec3, 3>> faces;
  for (int octant = 0; octant < 8; ++octant) {
    const glm::dvec3 x((octant & 1) != 0 ? -1 : 1, 0, 0), y(0, (octant & 2) != 0 ? -1 : 1, 0),
        z(0, 0, (octant & 4) != 0 ? -1 : 1);
    const bool odd = ((octant ^ octant >> 1 ^ octant >> 2) & 1) != 0;
    faces.push_back(odd ? std::array{x, z, y} : std::array{x, y, z});
  }
  for (int cut = 0; cut < cuts; ++cut) {
    std::vector<std::array<glm::dvec3, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const auto middle = [](const glm::dvec3& p, const glm::dvec3& q) { return glm::normalize(p + q); };
      const glm::dvec3 ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = std::move(finer);
  }
  std::string text;
  char line[128];
  for (const auto& face : faces) {
    for (const glm::dvec3& v : face) {
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", radius * v.x, radius * v.y, radius * v.z);
      text += line;
    }
    text += "f -3 -2 -1\n";
  }
  return text;
}

FieldPtr meshOf(const std::string& path, double falloff) {
  return makeField("mesh", {{"file", InputFile{path, {}}}, {"falloff", falloff}});
}

TEST(Mesh, ACubeIsTheBox) {
  const ScratchFolder folder;
  const FieldPtr mesh = meshOf(folder.write("cube.obj", examples::cubeAsObj(0.5)), 0.3);
  const FieldPtr box = makeField("box", {{"size", Vector{1, 1, 1}}, {"rounding", 0.0}, {"falloff", 0.3}});
  std::mt19937_64 random(1);
  int inside = 0;
  for (int n = 0; n < 20000; ++n) {
    const glm::dvec3 p = randomPoint(random, 0.7);
    const float expected = valueAt(*box, p);
    ASSERT_NEAR(valueAt(*mesh, p), expected, 2e-6) << p.x << ' ' << p.y << ' ' << p.z;
    inside += expected > 0.0f;
  }
  EXPECT_GT(inside, 3000);
}

TEST(Mesh, ABallOfManyFacesOnBlocksIsTheSphereUpToItsFacets) {
  const ScratchFolder folder;
  const FieldPtr mesh = meshOf(folder.write("ball.obj", ballAsObj(4, 1.0)), 0.5);
  const FieldPtr sphere = makeField("sphere", {{"falloff", 0.5}});
  // Edges span at most (π/2)/16 · 1.3 of the ball: they lie 2e-3 below the surface, faces' middles 3e-3.
  std::mt19937_64 random(2);
  for (const double spacing : {0.004, 0.03, 0.2})
    for (int n = 0; n < 40; ++n) {
      const Lattice lattice{randomPoint(random, 1.2), spacing};
      float values[kBlockPoints], expected[kBlockPoints];
      mesh->evaluate(lattice, values);
      sphere->evaluate(lattice, expected);
      for (int k = 0; k < kBlockPoints; ++k) ASSERT_NEAR(values[k], expected[k], 0.01) << spacing;
    }
}

TEST(Mesh, RaysThroughEdgesAndCornersCountOnce) {
  // Lines along z through the octahedron's tips, edges and the diagonals of the cube's faces.
  const ScratchFolder folder;
  for (const std::string& text : {ballAsObj(0, 1.0), examples::cubeAsObj(1.0)}) {
    const std::string path = folder.write("m.obj", text);
    const Solid solid(closedMesh(readMesh(path), path), 1.0, glm::dvec3(0.0));
    for (int i = -4; i <= 4; ++i)
      for (int j = -4; j <= 4; ++j)
        for (int k = -4; k <= 4; ++k) {
          const glm::dvec3 p = glm::dvec3(i, j, k) / 4.0;
          const double distance = solid.distance(p);
          if (distance < 1e-9) continue;
          const bool inside = text[0] == '#' ? true : std::abs(p.x) + std::abs(p.y) + std::abs(p.z) < 1.0;
          EXPECT_EQ(solid.contains(p), inside) << p.x << ' ' << p.y << ' ' << p.z;
        }
  }
}

TEST(Mesh, DistanceToATriangleIsThatOfItsNearestPart) {
  const Solid::Triangle t{{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  EXPECT_DOUBLE_EQ(squaredDistance({1, 1, 3}, t), 9.0);       // face
  EXPECT_DOUBLE_EQ(squaredDistance({2, -3, 4}, t), 25.0);     // edge
  EXPECT_DOUBLE_EQ(squaredDistance({4, 4, 0}, t), 8.0);       // the slanting edge
  EXPECT_DOUBLE_EQ(squaredDistance({-3, -4, 12}, t), 169.0);  // corner
  const Solid::Triangle flat{{0, 0, 0}, {2, 0, 0}, {1, 0, 0}};
  EXPECT_DOUBLE_EQ(squaredDistance({1, 3, 0}, flat), 9.0);
}

TEST(Mesh, CavitiesAreEmptyAndInsideOutIsTheSame) {
  const ScratchFolder folder;
  // A second, smaller cube whose faces turn the other way is a hole; indices continue from 8.
  std::string hollow = examples::cubeAsObj(0.8);
  std::string inner = examples::cubeAsObj(0.4);
  hollow += inner.substr(0, inner.find("f "));
  hollow += "f 10 12 11 9\nf 15 16 14 13\nf 13 14 10 9\nf 12 16 15 11\nf 11 15 13 9\nf 14 16 12 10\n";
  const FieldPtr field = meshOf(folder.write("hollow.obj", hollow), 0.0);
  EXPECT_EQ(valueAt(*field, {0.1, 0, 0}), 0.0f);
  EXPECT_EQ(valueAt(*field, {0.6, 0, 0}), 1.0f);
  EXPECT_EQ(valueAt(*field, {0.9, 0, 0}), 0.0f);
  const std::string turned = inner.substr(0, inner.find("f ")) +
                             "f 2 4 3 1\nf 7 8 6 5\nf 5 6 2 1\nf 4 8 7 3\nf 3 7 5 1\nf 6 8 4 2\n";
  EXPECT_EQ(valueAt(*meshOf(folder.write("turned.obj", turned), 0.0), {0.1, 0, 0}), 1.0f);
}

TEST(Mesh, ScaleAndCentreMoveIt) {
  const ScratchFolder folder;
  const FieldPtr field =
      makeField("mesh", {{"file", InputFile{folder.write("c.obj", examples::cubeAsObj(1)), {}}},
                         {"scale", 3.0},
                         {"center", Vector{1e7, 0, 0}},
                         {"falloff", 2.0}});
  EXPECT_NEAR(valueAt(*field, {1e7 + 2.5, 0.1, 0.2}), 0.25, 1e-6);
  EXPECT_DOUBLE_EQ(field->support().high.x, 1e7 + 3.0);
}

/// A tetrahedron as PLY with a vertex property and an element that nobody needs.
std::string tetrahedronAsPly(bool binary) {
  std::string text = std::string("ply\nformat ") + (binary ? "binary_little_endian" : "ascii") +
                     " 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty float x\nproperty float y\n"
                     "property float z\nproperty uchar red\nelement junk 1\nproperty list uchar short n\n"
                     "element face 4\nproperty list uchar int vertex_indices\nend_header\n";
  const float places[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  if (!binary) {
    for (const auto& p : places)
      for (int axis = 0; axis < 4; ++axis)
        text += (axis < 3 ? std::to_string(p[axis]) : "255") + (axis < 3 ? " " : "\n");
    text += "2 7 8\n";
    for (const auto& f : faces)
      text += "3 " + std::to_string(f[0]) + " " + std::to_string(f[1]) + " " + std::to_string(f[2]) + "\n";
    return text;
  }
  const auto put = [&text](const auto& v) { text.append(reinterpret_cast<const char*>(&v), sizeof v); };
  for (const auto& p : places) {
    for (const float v : p) put(v);
    put(uint8_t(255));
  }
  put(uint8_t(2));
  put(int16_t(7));
  put(int16_t(8));
  for (const auto& f : faces) {
    put(uint8_t(3));
    for (const int v : f) put(v);
  }
  return text;
}

TEST(Mesh, PlyReadsTheSameInTextAndBytes) {
  for (const bool binary : {false, true}) {
    const TriangleMesh mesh = closedMesh(parsePly(tetrahedronAsPly(binary), "t.ply"), "t.ply");
    ASSERT_EQ(mesh.vertices.size(), 4u);
    ASSERT_EQ(mesh.triangles.size(), 4u);
    EXPECT_EQ(mesh.vertices[3], glm::dvec3(0, 0, 1));
    const Solid solid(mesh, 1.0, glm::dvec3(0.0));
    EXPECT_TRUE(solid.contains({0.2, 0.2, 0.2}));
    EXPECT_FALSE(solid.contains({0.4, 0.4, 0.4}));
    // The slanting face x + y + z = 1.
    EXPECT_NEAR(solid.distance({1, 1, 1}), 2.0 / std::sqrt(3.0), 1e-15);
  }
}

std::string complaintAbout(const std::string& content) {
  const ScratchFolder folder;
  const std::string path = folder.write("m", content);
  try {
    closedMesh(readMesh(path), path);
  } catch (const InputError& error) {
    const Diagnostic& d = error.diagnostics().front();
    return std::to_string(d.where.line) + ": " + d.sentence;
  }
  return "accepted";
}

TEST(Mesh, RefusesBadFilesWithLineAndSentence) {
  const std::string cube = examples::cubeAsObj(1.0), ply = tetrahedronAsPly(false),
                    bytes = tetrahedronAsPly(true);
  const auto with = [](std::string text, const std::string& from, const std::string& to) {
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return text.replace(text.find(from), from.size(), to);
  };
  const std::pair<std::string, std::string> cases[] = {
      {"", "0: holds no faces"},
      {"v 0 0 0\nv 1 0\n", "2: a vertex needs three finite numbers, found ''"},
      {"v 0 0 0\nv 1 nan 0\n", "2: a vertex needs three finite numbers, found 'nan'"},
      {"v 0 0 1e999\n", "1: a vertex needs three finite numbers, found '1e999'"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", "4: a face needs at least three corners, found 2"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", "4: a face names vertex 4 of 3 so far"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 0\n", "4: a face names vertex 0 of 3 so far"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 -4 3\n", "4: a face names vertex -4 of 3 so far"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 x\n", "4: a face's corner must be a vertex number, found 'x'"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "0: is not closed: 3 open edges"},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 2\n", "0: holds no face with an area"},
      {with(cube, "f 2 4 8 6\n", ""), "0: is not closed: 4 open edges"},
      {with(cube, "f 2 4 8 6\n", "f 6 8 4 2\n"), "0: has neighbours that face opposite ways at 4 edges"},
      {with(ply, "ascii", "binary_big_endian"), "2: format 'binary_big_endian' is not read"},
      {with(ply, "float y", "quad y"), "6: a property has no type 'quad'"},
      {with(ply, "property float z\n", ""), "13: "},
      {with(ply, "vertex 4", "vertex 4000000000"), "14: claims 4000000000 of 'vertex'"},
      {with(ply, "3 0 2 1", "3 0 2 9"), "22: a face names vertex 9 of 4, counted from 0"},
      {with(ply, "3 0 2 1", "3 0 2 x"), "19: face 0 has 'x' where a number belongs"},
      {with(ply, "3 0 2 1", "2 0 2"), "19: face 0 has 2 corners"},
      {with(ply, "end_header", "end"), "13: a PLY header has no line 'end'"},
      {ply.substr(0, ply.find("end_header")), "12: ends inside its header"},
      {bytes.substr(0, bytes.size() - 2), "0: ends in the middle of face 3"},
  };
  for (const auto& [content, complaint] : cases) {
    const std::string said = complaintAbout(content);
    EXPECT_EQ(said.rfind(complaint, 0), 0u) << "said:     " << said << "\nexpected: " << complaint;
  }
}

}  // namespace
}  // namespace nephele::test
