// Distances to triangles and windings round points. Depends on solid.h alone.
#include "bake/fields/solid.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace nephele {
namespace {

double dotOf(const glm::dvec3& a, const glm::dvec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
glm::dvec3 crossOf(const glm::dvec3& a, const glm::dvec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

double squaredDistanceToBox(const glm::dvec3& p, const Box& box) {
  double sum = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double beyond = std::max({box.low[axis] - p[axis], p[axis] - box.high[axis], 0.0});
    sum += beyond * beyond;
  }
  return sum;
}

double squaredDistanceToSegment(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b) {
  const glm::dvec3 ab = b - a, ap = p - a;
  const double square = dotOf(ab, ab);
  const double at = square > 0.0 ? std::clamp(dotOf(ap, ab) / square, 0.0, 1.0) : 0.0;
  const glm::dvec3 apart = ap - at * ab;
  return dotOf(apart, apart);
}

Box boxOf(const Solid::Triangle& t) {
  return {glm::min(t.a, glm::min(t.b, t.c)), glm::max(t.a, glm::max(t.b, t.c))};
}

/// +1 or −1 where the edge, seen along z, passes (x, y) on its right going up or down in y; 0 elsewhere. Both
/// faces of an edge get the same answer but for its sign, bit for bit.
int passes(const glm::dvec3& from, const glm::dvec3& to, double x, double y) {
  const bool fromBelow = from.y <= y, toBelow = to.y <= y;
  if (fromBelow == toBelow) return 0;
  const glm::dvec3 &low = fromBelow ? from : to, &high = fromBelow ? to : from;
  const double side = (high.x - low.x) * (y - low.y) - (x - low.x) * (high.y - low.y);
  if (side <= 0.0) return 0;
  return fromBelow ? 1 : -1;
}

/// The height at which the vertical line through (x, y) meets the triangle, held within it.
double heightAt(const Solid::Triangle& t, double x, double y) {
  const glm::dvec3 normal = crossOf(t.b - t.a, t.c - t.a);
  const double low = std::min({t.a.z, t.b.z, t.c.z}), high = std::max({t.a.z, t.b.z, t.c.z});
  if (normal.z == 0.0) return 0.5 * (low + high);  // seen edge-on, up to rounding
  return std::clamp(t.a.z - (normal.x * (x - t.a.x) + normal.y * (y - t.a.y)) / normal.z, low, high);
}

std::vector<Solid::Triangle> placed(const TriangleMesh& mesh, double scale, const glm::dvec3& offset) {
  std::vector<Solid::Triangle> list;
  list.reserve(mesh.triangles.size());
  for (const auto& t : mesh.triangles)
    list.push_back({scale * mesh.vertices[t[0]] + offset, scale * mesh.vertices[t[1]] + offset,
                    scale * mesh.vertices[t[2]] + offset});
  return list;
}

std::vector<Box> boxesOf(const std::vector<Solid::Triangle>& triangles) {
  std::vector<Box> boxes;
  boxes.reserve(triangles.size());
  for (const auto& t : triangles) boxes.push_back(boxOf(t));
  return boxes;
}

}  // namespace

double squaredDistance(const glm::dvec3& p, const Solid::Triangle& t) {
  const glm::dvec3 normal = crossOf(t.b - t.a, t.c - t.a);
  const double square = dotOf(normal, normal);
  // A point beyond none of the sides lies over the face; else its nearest is on a side that it lies beyond.
  double least = std::numeric_limits<double>::infinity();
  const auto side = [&](const glm::dvec3& from, const glm::dvec3& to) {
    if (square > 0.0 && dotOf(crossOf(normal, to - from), p - from) >= 0.0) return;
    least = std::min(least, squaredDistanceToSegment(p, from, to));
  };
  side(t.a, t.b);
  side(t.b, t.c);
  side(t.c, t.a);
  if (least < std::numeric_limits<double>::infinity()) return least;
  const double height = dotOf(normal, p - t.a);
  return height * height / square;
}

bool windsRound(const std::vector<Solid::Crossing>& crossings, double z) {
  int turns = 0;
  for (const Solid::Crossing& crossing : crossings)
    if (crossing.z > z) turns += crossing.turns;
  return turns != 0;
}

Solid::Solid(const TriangleMesh& mesh, double scale, const glm::dvec3& offset)
    : box_(nothing()), triangles_(placed(mesh, scale, offset)), tree_(boxesOf(triangles_)) {
  for (const Triangle& t : triangles_) {
    box_ = hull(box_, boxOf(t));
    const glm::dvec3 normal = crossOf(t.b - t.a, t.c - t.a);
    const double length = std::sqrt(dotOf(normal, normal));
    normals_.push_back(length > 0.0 ? normal / length : glm::dvec3(0.0));
  }
}

double Solid::distance(const glm::dvec3& p, uint32_t& nearest) const {
  const auto measure = [&](uint32_t item, double best) {
    const Triangle& t = triangles_[item];
    // No point of a triangle is nearer than its plane; inside a round solid this settles nearly all of them.
    const double height = dotOf(normals_[item], p - t.a);
    if (height * height >= best) return best;
    const double square = squaredDistance(p, t);
    if (square < best) nearest = item;
    return square;
  };
  return std::sqrt(tree_.least(
      squaredDistance(p, triangles_[nearest]), [&](const Box& box) { return squaredDistanceToBox(p, box); },
      measure));
}

void Solid::crossings(double x, double y, std::vector<Crossing>& out) const {
  out.clear();
  tree_.forEach(
      [&](const Box& box) { return box.low.x <= x && x <= box.high.x && box.low.y <= y && y <= box.high.y; },
      [&](uint32_t item) {
        const Triangle& t = triangles_[item];
        const int turns = passes(t.a, t.b, x, y) + passes(t.b, t.c, x, y) + passes(t.c, t.a, x, y);
        if (turns != 0) out.push_back({heightAt(t, x, y), turns});
      });
}

bool Solid::contains(const glm::dvec3& p) const {
  if (intersection(box_, {p, p}).empty()) return false;
  std::vector<Crossing> found;
  crossings(p.x, p.y, found);
  return windsRound(found, p.z);
}

bool Solid::near(const glm::dvec3& p, double reach, size_t most, std::vector<Triangle>& out) const {
  const double square = reach * reach;
  tree_.forEach([&](const Box& box) { return out.size() <= most && squaredDistanceToBox(p, box) <= square; },
                [&](uint32_t item) {
                  if (squaredDistanceToBox(p, boxOf(triangles_[item])) <= square)
                    out.push_back(triangles_[item]);
                });
  return out.size() <= most;
}

}  // namespace nephele
