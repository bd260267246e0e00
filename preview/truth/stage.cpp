// Intersections in closed form. Depends on what its header names.
#include "preview/truth/stage.h"

#include <cmath>
#include <glm/matrix.hpp>

namespace nephele::truth {
namespace {

using glm::dvec3;

constexpr double kFloorThickness = 0.02;            // of its radius
constexpr double kDark = 0.1, kLight = 0.5;         // the floor's squares
constexpr double kGrey = 0.18, kMirrorShare = 0.9;  // the grey ball; chrome
constexpr double kOff = 1e-6;                       // of the stage's size: nearer is the surface itself

/// The nearest of what was met.
struct Nearest {
  double least;
  double distance = std::numeric_limits<double>::infinity();
  dvec3 normal{0.0};
  int thing = -1;

  void take(double t, const dvec3& outward, int which) {
    if (!(t > least && t < distance)) return;
    distance = t;
    normal = outward;
    thing = which;
  }
};

enum Thing { kFloor, kChrome, kGreyBall, kCube };

void meetBall(Nearest& nearest, const dvec3& origin, const dvec3& along, const StagePlace& ball, int which) {
  if (!(ball.half > 0.0)) return;
  const dvec3 from = origin - ball.centre;
  const double middle = -glm::dot(from, along);
  const dvec3 aside = from + middle * along;
  const double inside = ball.half * ball.half - glm::dot(aside, aside);
  if (!(inside > 0.0)) return;
  for (const double t : {middle - std::sqrt(inside), middle + std::sqrt(inside)})
    nearest.take(t, (from + t * along) / ball.half, which);
}

void meetCube(Nearest& nearest, const dvec3& origin, const dvec3& along, const StagePlace& cube,
              const glm::dmat3& axes) {
  if (!(cube.half > 0.0)) return;
  const dvec3 from = glm::transpose(axes) * (origin - cube.centre), way = glm::transpose(axes) * along;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-1.0, 1.0}) {
      if (way[axis] == 0.0) continue;
      const double t = (side * cube.half - from[axis]) / way[axis];
      const dvec3 at = from + t * way;
      const int second = (axis + 1) % 3, third = (axis + 2) % 3;
      if (std::abs(at[second]) <= cube.half && std::abs(at[third]) <= cube.half)
        nearest.take(t, side * axes[axis], kCube);
    }
}

/// A round plate whose upper face is the ground.
void meetFloor(Nearest& nearest, const dvec3& origin, const dvec3& along, const StagePlaces& places) {
  const double radius = places.floorRadius;
  if (!(radius > 0.0)) return;
  const dvec3 up = places.axes.up, from = origin - places.ground;
  const double height = glm::dot(from, up), rising = glm::dot(along, up), thick = kFloorThickness * radius;
  const auto beside = [&](const dvec3& v) { return v - glm::dot(v, up) * up; };
  if (rising != 0.0)
    for (const double level : {0.0, -thick}) {
      const double t = (level - height) / rising;
      if (glm::length(beside(from + t * along)) <= radius) nearest.take(t, level == 0.0 ? up : -up, kFloor);
    }
  const dvec3 flat = beside(along), start = beside(from);
  const double a = glm::dot(flat, flat), b = glm::dot(flat, start),
               c = glm::dot(start, start) - radius * radius;
  if (!(a > 0.0) || !(b * b > a * c)) return;
  for (const double sign : {-1.0, 1.0}) {
    const double t = (-b + sign * std::sqrt(b * b - a * c)) / a;
    const double at = height + t * rising;
    if (at <= 0.0 && at >= -thick) nearest.take(t, (start + t * flat) / radius, kFloor);
  }
}

Nearest meet(const StagePlaces& places, const glm::dmat3& axes, const dvec3& origin, const dvec3& along) {
  Nearest nearest{kOff * places.size};
  meetFloor(nearest, origin, along, places);
  meetBall(nearest, origin, along, places.chrome, kChrome);
  meetBall(nearest, origin, along, places.grey, kGreyBall);
  meetCube(nearest, origin, along, places.cube, axes);
  return nearest;
}

}  // namespace

StageSurfaces::StageSurfaces(const ViewedScene& view, const BrickVolume& bricks)
    : places_(placesOf(view.scene.stage, view.up, bricks)),
      axes_(places_.axes.right, places_.axes.forward, places_.axes.up),
      worldFromPosition_(bricks.worldFromIndex) {
  const Stage& stage = view.scene.stage;
  if (!stage.floor) places_.floorRadius = 0.0;
  if (!stage.chrome.on) places_.chrome.half = 0.0;
  if (!stage.grey.on) places_.grey.half = 0.0;
  if (!stage.cube.on) places_.cube.half = 0.0;
  worldFromPosition_[3] = bricks.worldFromIndex * glm::dvec4(dvec3(bricks.brickMin * kBrickCells), 1.0);
}

std::optional<StageHit> StageSurfaces::hit(const dvec3& origin, const dvec3& along) const {
  const Nearest nearest = meet(places_, axes_, origin, along);
  if (nearest.thing < 0) return {};
  StageHit hit{nearest.distance, nearest.normal, dvec3(0.0), 0.0};
  if (glm::dot(hit.normal, along) > 0.0) hit.normal = -hit.normal;
  if (nearest.thing == kGreyBall) {
    hit.albedo = dvec3(kGrey);
  } else if (nearest.thing == kFloor) {
    const dvec3 from = origin + nearest.distance * along - places_.ground;
    const double squares = std::floor(glm::dot(from, places_.axes.right) / places_.checker) +
                           std::floor(glm::dot(from, places_.axes.forward) / places_.checker);
    hit.albedo = dvec3(std::fmod(std::abs(squares), 2.0) == 1.0 ? kLight : kDark);
  } else {
    hit.mirror = kMirrorShare;
  }
  return hit;
}

bool StageSurfaces::blocks(const dvec3& origin, const dvec3& along, double reach) const {
  return meet(places_, axes_, origin, along).distance < reach;
}

float StageSurfaces::wayFrom(const glm::vec3& position, const glm::vec3& along) const {
  const dvec3 place(worldFromPosition_ * glm::dvec4(dvec3(position), 1.0));
  return static_cast<float>(meet(places_, axes_, place, dvec3(along)).distance);
}

}  // namespace nephele::truth
