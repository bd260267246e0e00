// Triangle meshes out of OBJ and PLY files. Depends on base and GLM alone.
#pragma once

#include <array>
#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

namespace nephele {

struct TriangleMesh {
  std::vector<glm::dvec3> vertices;
  std::vector<std::array<uint32_t, 3>> triangles;
};

/// Reads a PLY (it starts with the word ply; ascii or binary little-endian) or else an OBJ. Of an OBJ the
/// lines `v` and `f` are read, of a PLY the elements `vertex` (x, y, z) and `face` (vertex_indices or
/// vertex_index); faces of more corners are cut into fans. Throws InputError with file and, in text, line: on
/// what cannot be read, coordinates that are not finite, indices out of range, and no faces at all.
TriangleMesh readMesh(const std::string& path);

/// The same for a file's content; `path` names it in sentences.
TriangleMesh parseObj(const std::string& content, const std::string& path);
TriangleMesh parsePly(const std::string& content, const std::string& path);

/// Vertices at the same place made one, triangles that thereby lose a side left out. Throws InputError that
/// names the path where the surface is not closed, with the count of edges that have no second face, or where
/// neighbours face opposite ways.
TriangleMesh closedMesh(TriangleMesh mesh, const std::string& path);

}  // namespace nephele
