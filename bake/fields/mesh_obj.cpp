// Reading OBJ meshes, telling OBJ from PLY, and the demand that a mesh be closed. Depends on base alone.
#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <string_view>

#include "bake/fields/mesh_file.h"
#include "base/error.h"
#include "base/files.h"

namespace nephele {
namespace {

std::string_view nextWord(std::string_view& line) {
  constexpr std::string_view kBlank = " \t\r";
  line.remove_prefix(std::min(line.find_first_not_of(kBlank), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(kBlank));
  line.remove_prefix(word.size());
  return word;
}

class ObjReader {
 public:
  ObjReader(const std::string& content, const std::string& path) : rest_(content), path_(path) {}

  TriangleMesh read() {
    while (!rest_.empty()) {
      std::string_view line = rest_.substr(0, rest_.find('\n'));
      rest_.remove_prefix(std::min(line.size() + 1, rest_.size()));
      ++line_;
      const std::string_view keyword = nextWord(line);
      if (keyword == "v")
        readVertex(line);
      else if (keyword == "f")
        readFace(line);
    }
    if (mesh_.triangles.empty()) throw InputError({path_}, "holds no faces; a mesh is an OBJ or a PLY");
    return std::move(mesh_);
  }

 private:
  [[noreturn]] void fail(const std::string& sentence) const { throw InputError({path_, line_}, sentence); }

  void readVertex(std::string_view line) {
    glm::dvec3 vertex(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = nextWord(line);
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), vertex[axis]);
      if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(vertex[axis]))
        fail("a vertex needs three finite numbers, found '" + std::string(word) + "'");
    }
    mesh_.vertices.push_back(vertex);
  }

  void readFace(std::string_view line) {
    std::vector<uint32_t> corners;
    for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line))
      corners.push_back(cornerOf(word));
    if (corners.size() < 3)
      fail("a face needs at least three corners, found " + std::to_string(corners.size()));
    for (size_t n = 2; n < corners.size(); ++n)
      mesh_.triangles.push_back({corners[0], corners[n - 1], corners[n]});
  }

  /// "7", "7/1", "7//2", "7/1/2" or, counted from the last vertex so far, "-1".
  uint32_t cornerOf(std::string_view word) const {
    const std::string_view number = word.substr(0, word.find('/'));
    int64_t index = 0;
    const auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), index);
    if (error != std::errc{} || end != number.data() + number.size())
      fail("a face's corner must be a vertex number, found '" + std::string(word) + "'");
    const auto count = int64_t(mesh_.vertices.size());
    const int64_t from0 = index > 0 ? index - 1 : count + index;
    if (index == 0 || from0 < 0 || from0 >= count)
      fail("a face names vertex " + std::to_string(index) + " of " + std::to_string(count) + " so far");
    return uint32_t(from0);
  }

  std::string_view rest_;
  const std::string& path_;
  int line_ = 0;
  TriangleMesh mesh_;
};

/// Gives every vertex the number of the first one at its place.
std::vector<uint32_t> firstAtPlace(const std::vector<glm::dvec3>& vertices) {
  std::vector<uint32_t> order(vertices.size()), first(vertices.size());
  for (uint32_t n = 0; n < order.size(); ++n) order[n] = n;
  const auto key = [&](uint32_t n) {
    return std::tuple(vertices[n].x + 0.0, vertices[n].y + 0.0, vertices[n].z + 0.0, n);  // −0 becomes 0
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return key(a) < key(b); });
  for (size_t n = 0; n < order.size(); ++n)
    first[order[n]] = n > 0 && vertices[order[n]] == vertices[order[n - 1]] ? first[order[n - 1]] : order[n];
  return first;
}

}  // namespace

TriangleMesh parseObj(const std::string& content, const std::string& path) {
  return ObjReader(content, path).read();
}

TriangleMesh readMesh(const std::string& path) {
  const std::string content = readWhole(path);
  const bool ply = content.rfind("ply\n", 0) == 0 || content.rfind("ply\r\n", 0) == 0;
  return ply ? parsePly(content, path) : parseObj(content, path);
}

TriangleMesh closedMesh(TriangleMesh mesh, const std::string& path) {
  const std::vector<uint32_t> first = firstAtPlace(mesh.vertices);
  for (auto& triangle : mesh.triangles)
    for (uint32_t& corner : triangle) corner = first[corner];
  std::erase_if(mesh.triangles, [](const auto& t) { return t[0] == t[1] || t[1] == t[2] || t[2] == t[0]; });
  struct Sides {
    int faces = 0, balance = 0;  // balance: faces that run up the edge less those that run down
  };
  std::map<std::pair<uint32_t, uint32_t>, Sides> edges;
  for (const auto& t : mesh.triangles)
    for (int n = 0; n < 3; ++n) {
      const uint32_t from = t[size_t(n)], to = t[size_t((n + 1) % 3)];
      Sides& sides = edges[std::minmax(from, to)];
      ++sides.faces;
      sides.balance += from < to ? 1 : -1;
    }
  size_t open = 0, turned = 0;
  for (const auto& [edge, sides] : edges) {
    open += sides.faces % 2 != 0;
    turned += sides.faces % 2 == 0 && sides.balance != 0;
  }
  if (mesh.triangles.empty()) throw InputError({path}, "holds no face with an area");
  if (open > 0)
    throw InputError({path},
                     "is not closed: " + std::to_string(open) + " open edges, where a face ends alone",
                     "fill the holes in a modelling program");
  if (turned > 0)
    throw InputError({path}, "has neighbours that face opposite ways at " + std::to_string(turned) + " edges",
                     "make its normals consistent in a modelling program");
  return mesh;
}

}  // namespace nephele
