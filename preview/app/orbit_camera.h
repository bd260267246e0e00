// A camera on a sphere about its target, as a hand moves it. No window in here. Depends on scene alone.
#pragma once

#include <glm/vec3.hpp>

#include "scene/scene.h"

namespace nephele {

/// Angles in radians: azimuth about `up`, elevation above the plane across it, within ±kMostElevation so that
/// the view never lies along up.
class OrbitCamera {
 public:
  static constexpr double kMostElevation = 1.55;  // 88.8 degrees

  /// Starts where `camera` is. A camera straight above its target is tilted to kMostElevation.
  explicit OrbitCamera(const Camera& camera);

  /// Turns about the target.
  void orbit(double azimuth, double elevation);
  /// Moves camera and target across the view, so that what is at the target's distance follows the hand: one
  /// is the picture's whole height; positive to the right and up.
  void pan(double right, double up);
  /// Multiplies the distance to the target; `factor` > 0.
  void zoom(double factor);
  /// Turns the view about the camera's own place: the target moves. Angles as orbit() takes them.
  void look(double azimuth, double elevation);
  /// Moves camera and target by world distances along the view, to the right, and along up.
  void fly(double forward, double right, double up);
  /// Makes a point the target: the camera moves across the view, and turns no way. A point behind the camera
  /// or on it changes nothing.
  void focus(const glm::dvec3& point);
  double distance() const { return distance_; }
  Camera camera() const;

 private:
  glm::dvec3 target_;
  glm::dvec3 up_;
  glm::dvec3 sideA_;  // azimuth 0
  glm::dvec3 sideB_;  // azimuth a quarter turn
  double fov_;
  double distance_;
  double azimuth_;
  double elevation_;
};

/// The unit direction through a picture position: shares of the picture's sides from its top left corner.
glm::dvec3 rayThrough(const Camera& camera, double x, double y, double aspect);

/// Azimuth and elevation of a direction about `up`, and back; the axes of OrbitCamera. For the panel's sun.
struct Angles {
  double azimuth = 0.0;
  double elevation = 0.0;
};
Angles anglesOf(const glm::dvec3& direction, const glm::dvec3& up);
glm::dvec3 directionOf(const Angles& angles, const glm::dvec3& up);

}  // namespace nephele
