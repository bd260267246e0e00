// A closed surface of triangles as a solid: how far a point is from it, and whether it is inside. Depends on
// box_tree.h and mesh_file.h.
#pragma once

#include "bake/fields/box_tree.h"
#include "bake/fields/mesh_file.h"

namespace nephele {

/// Immutable once built; queries may run on any number of threads. All in double, by + − · / and square roots
/// alone, so that every machine gives the same numbers.
class Solid {
 public:
  /// A mesh that closedMesh() let pass, every vertex at scale · v + offset.
  Solid(const TriangleMesh& mesh, double scale, const glm::dvec3& offset);

  struct Triangle {
    glm::dvec3 a, b, c;
  };
  const Box& box() const { return box_; }

  /// Distance to the nearest point of the surface, 0 or more. `nearest` is a triangle to start from, at best
  /// that of a point close by, and becomes the nearest one; the result does not depend on it.
  double distance(const glm::dvec3& p, uint32_t& nearest) const;
  double distance(const glm::dvec3& p) const {
    uint32_t nearest = 0;
    return distance(p, nearest);
  }

  /// Whether the surface winds round the point. Exact for points off the surface: crossings of a ray upwards
  /// along z are counted by half-open edges, so that a ray through an edge or a corner counts once.
  bool contains(const glm::dvec3& p) const;

  /// A place where the line through (x, y) along z passes the surface, and by how much its winding changes.
  struct Crossing {
    double z;
    int turns;
  };
  void crossings(double x, double y, std::vector<Crossing>& out) const;

  /// All triangles whose boxes come within `reach` of the point, or false where there are more than `most`.
  bool near(const glm::dvec3& p, double reach, size_t most, std::vector<Triangle>& out) const;

 private:
  Box box_;
  std::vector<Triangle> triangles_;
  std::vector<glm::dvec3> normals_;  // of length 1, or 0 where a triangle has no area
  BoxTree tree_;
};

/// Squared distance between a point and a triangle, which may have no area.
double squaredDistance(const glm::dvec3& p, const Solid::Triangle& triangle);

/// Whether the crossings above z wind round a point there.
bool windsRound(const std::vector<Solid::Crossing>& crossings, double z);

}  // namespace nephele
