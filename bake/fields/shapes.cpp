// Envelopes from signed distances: sphere, ellipsoid, box, capsule, torus, plane. Depends on envelope_field.h
// and shared text.
#include <cmath>

#include "bake/fields/envelope_field.h"
#include "bake/fields/rows.h"

namespace nephele {

Complaint complainOfSizes(const Arguments& arguments, std::initializer_list<std::string_view> numbers,
                          std::initializer_list<std::string_view> vectors) {
  constexpr double kLeast = 1e-15, kMost = 1e15;
  const auto complain = [](std::string_view name) {
    return Complaint{{name, "'" + std::string(name) + "' must lie between 1e-15 and 1e15"}};
  };
  for (const std::string_view name : numbers)
    if (const double v = arguments.number(name); v < kLeast || v > kMost) return complain(name);
  for (const std::string_view name : vectors)
    for (int axis = 0; axis < 3; ++axis)
      if (const double v = arguments.vector(name)[axis]; v < kLeast || v > kMost) return complain(name);
  return std::nullopt;
}

glm::dvec3 directionOrUp(const glm::dvec3& given, const BuildContext& context) {
  const double largest = std::max({std::abs(given.x), std::abs(given.y), std::abs(given.z)});
  glm::dvec3 up(0.0);
  up[context.upAxis] = 1.0;
  if (largest == 0.0) return up;
  const glm::dvec3 scaled = given / largest;  // so that no square over- or underflows
  return scaled / lengthOf(scaled);
}

Parameter falloffParameter(double fallback) {
  return {"falloff",
          ParameterType::number,
          "Depth below the surface at which the value reaches 1; 0: a hard edge.",
          Value{fallback},
          kNonNegative,
          "world units"};
}

namespace {

struct Sphere {
  float radius;
  float distance(const glm::vec3& p) const { return shared::distanceToSphere(p, radius); }
  Interval distances(const Box& local) const { return distancesByMagnitude(*this, local); }
  Box extent() const { return grown({glm::dvec3(0.0), glm::dvec3(0.0)}, double(radius)); }
  double size() const { return double(radius); }
};

struct Ellipsoid {
  glm::vec3 radii;
  float shortest;
  float distance(const glm::vec3& p) const { return shared::distanceToEllipsoid(p, radii, shortest); }
  Interval distances(const Box& local) const { return distancesByMagnitude(*this, local); }
  Box extent() const { return {-glm::dvec3(radii), glm::dvec3(radii)}; }
  double size() const { return lengthOf(glm::dvec3(radii)); }
};

struct RoundedBox {
  glm::vec3 halfSize;
  float rounding;
  float distance(const glm::vec3& p) const { return shared::distanceToBox(p, halfSize, rounding); }
  Interval distances(const Box& local) const { return distancesByMagnitude(*this, local); }
  Box extent() const { return {-glm::dvec3(halfSize), glm::dvec3(halfSize)}; }
  double size() const { return lengthOf(glm::dvec3(halfSize)); }
};

/// From the origin to `along`.
struct Capsule {
  glm::vec3 along;
  float radius;
  float distance(const glm::vec3& p) const { return shared::distanceToCapsule(p, along, radius); }
  Interval distances(const Box& local) const { return distancesByCentre(*this, local); }
  Box extent() const {
    const glm::dvec3 end(along);
    return grown(hull({glm::dvec3(0.0), glm::dvec3(0.0)}, {end, end}), double(radius));
  }
  double size() const { return double(radius) + lengthOf(glm::dvec3(along)); }
};

struct Torus {
  glm::vec3 axis;
  float major, minor;
  float distance(const glm::vec3& p) const { return shared::distanceToTorus(p, axis, major, minor); }
  Interval distances(const Box& local) const { return distancesByCentre(*this, local); }
  Box extent() const {
    glm::dvec3 reach(0.0);
    for (int a = 0; a < 3; ++a)
      reach[a] =
          double(major) * std::sqrt(std::max(0.0, 1.0 - double(axis[a]) * double(axis[a]))) + double(minor);
    return {-reach, reach};
  }
  double size() const { return double(major) + double(minor); }
};

/// Behind the plane through the origin.
struct HalfSpace {
  glm::vec3 normal;
  float distance(const glm::vec3& p) const { return shared::distanceToPlane(p, normal); }
  Interval distances(const Box& local) const {
    const glm::dvec3 n(normal), centre = local.centre(), half = local.halfSize();
    double at = 0.0, reach = 0.0;
    for (int a = 0; a < 3; ++a) {
      at += n[a] * centre[a];
      reach += std::abs(n[a]) * half[a];
    }
    return {at - reach, at + reach};
  }
  Box extent() const {
    Box box;
    for (int a = 0; a < 3; ++a) {
      if (normal[a] == 1.0f) box.high[a] = 0.0;
      if (normal[a] == -1.0f) box.low[a] = 0.0;
    }
    return box;
  }
  double size() const { return 0.0; }
};

const Parameter kCentre{"center", ParameterType::vector, "Centre.", Value{std::array<double, 3>{0, 0, 0}},
                        kAny,     "world units"};

/// Notes a shape so thin that samples may miss it, or stand for more than there is of it.
void noteThin(const BuildContext& context, const char* field, double thickness) {
  constexpr double kThin = 2.0;  // voxels; docs/stability.md, mass of thin shapes
  const double voxels = thickness / context.voxelSize;
  if (context.notes && voxels < kThin) context.notes->push_back({field, 0, 0.0, 1.0, 0.0, voxels});
}

template <class Shape>
FieldPtr envelopeOf(const Arguments& a, const glm::dvec3& centre, const Shape& shape) {
  return std::make_shared<EnvelopeField<Shape>>(centre, shape, a.number("falloff"));
}

double shortestOf(const glm::dvec3& v) { return std::min({v.x, v.y, v.z}); }

Complaint validateBox(const Arguments& a) {
  if (auto complaint = complainOfSizes(a, {}, {"size"})) return complaint;
  if (2.0 * a.number("rounding") > shortestOf(a.vector("size")))
    return {{"rounding", "'rounding' must not exceed half of the shortest edge"}};
  return std::nullopt;
}

}  // namespace

FieldRow sphereRow() {
  return {"sphere",
          "1 deep inside a sphere, 0 from its surface outwards, falling over `falloff`.",
          {kCentre,
           {"radius", ParameterType::number, "Radius.", Value{1.0}, kPositive, "world units"},
           falloffParameter(1.0)},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            noteThin(context, "sphere", 2.0 * a.number("radius"));
            return envelopeOf(a, a.vector("center"), Sphere{float(a.number("radius"))});
          },
          [](const Arguments& a) { return complainOfSizes(a, {"radius"}); }};
}

FieldRow ellipsoidRow() {
  return {
      "ellipsoid",
      "1 deep inside an ellipsoid, 0 from its surface outwards. Depth is measured along the shortest axis "
      "and stretched along the others, a lower bound of the true one.",
      {kCentre,
       {"radii", ParameterType::vector, "Half of its extent along x, y and z.",
        Value{std::array<double, 3>{1.0, 0.8, 0.6}}, kPositive, "world units"},
       falloffParameter(0.6)},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        const glm::vec3 radii(a.vector("radii"));
        noteThin(context, "ellipsoid", 2.0 * shortestOf(a.vector("radii")));
        return envelopeOf(a, a.vector("center"), Ellipsoid{radii, std::min({radii.x, radii.y, radii.z})});
      },
      [](const Arguments& a) { return complainOfSizes(a, {}, {"radii"}); }};
}

FieldRow boxRow() {
  return {"box",
          "1 deep inside a box along the axes, 0 from its surface outwards, falling over `falloff`.",
          {kCentre,
           {"size", ParameterType::vector, "Its edges along x, y and z, in full.",
            Value{std::array<double, 3>{1.4, 1.4, 1.0}}, kPositive, "world units"},
           {"rounding", ParameterType::number, "Radius of its edges and corners, within its size.",
            Value{0.1}, kNonNegative, "world units"},
           falloffParameter(0.3)},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            noteThin(context, "box", shortestOf(a.vector("size")));
            return envelopeOf(a, a.vector("center"),
                              RoundedBox{glm::vec3(0.5 * a.vector("size")), float(a.number("rounding"))});
          },
          validateBox};
}

FieldRow capsuleRow() {
  return {"capsule",
          "1 deep inside all that lies within `radius` of a line, 0 from there outwards; equal ends are a "
          "sphere.",
          {{"from", ParameterType::vector, "One end of the line.", Value{std::array<double, 3>{-0.6, 0, 0}},
            kAny, "world units"},
           {"to", ParameterType::vector, "Its other end.", Value{std::array<double, 3>{0.6, 0, 0.2}}, kAny,
            "world units"},
           {"radius", ParameterType::number, "Radius.", Value{0.4}, kPositive, "world units"},
           falloffParameter(0.4)},
          [](const Arguments& a, const BuildContext& context) -> FieldPtr {
            noteThin(context, "capsule", 2.0 * a.number("radius"));
            const glm::dvec3 from = a.vector("from");
            return envelopeOf(a, from, Capsule{glm::vec3(a.vector("to") - from), float(a.number("radius"))});
          },
          [](const Arguments& a) { return complainOfSizes(a, {"radius"}); }};
}

FieldRow torusRow() {
  return {
      "torus",
      "1 deep inside a ring, 0 from its surface outwards, falling over `falloff`.",
      {kCentre,
       {"axis", ParameterType::vector, "What the ring lies around; [0, 0, 0]: the up axis.",
        Value{std::array<double, 3>{0, 0, 0}}},
       {"major", ParameterType::number, "Radius of the ring.", Value{0.7}, kPositive, "world units"},
       {"minor", ParameterType::number, "Radius of its cross-section.", Value{0.3}, kPositive, "world units"},
       falloffParameter(0.3)},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        noteThin(context, "torus", 2.0 * a.number("minor"));
        return envelopeOf(a, a.vector("center"),
                          Torus{glm::vec3(directionOrUp(a.vector("axis"), context)), float(a.number("major")),
                                float(a.number("minor"))});
      },
      [](const Arguments& a) {
        return complainOfSizes(a, {"major", "minor"});
      }};
}

FieldRow planeRow() {
  return {
      "plane",
      "1 deep behind a plane, 0 from it onwards in the direction of its normal; it has no other end.",
      {{"point", ParameterType::vector, "A point of the plane.", Value{std::array<double, 3>{0, 0, 0}}, kAny,
        "world units"},
       {"normal", ParameterType::vector, "Points to where nothing is, at any length; [0, 0, 0]: the up axis.",
        Value{std::array<double, 3>{0, 0, 0}}},
       falloffParameter(0.5)},
      [](const Arguments& a, const BuildContext& context) -> FieldPtr {
        return envelopeOf(a, a.vector("point"),
                          HalfSpace{glm::vec3(directionOrUp(a.vector("normal"), context))});
      }};
}

}  // namespace nephele
