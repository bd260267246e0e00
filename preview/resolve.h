// What a scene leaves open, decided from the volume: the camera and the medium. Depends on scene,
// volume/bricks.h and preview/stage_places.h.
#pragma once

#include <optional>
#include <string>

#include "preview/viewed_scene.h"
#include "volume/bricks.h"

namespace nephele {

/// The world's unit vector along the file's up axis: its metadata's up_axis, else Y for files that Houdini
/// wrote, else Z.
glm::dvec3 upOf(const BrickVolume& bricks);

/// Looks at the centre of the medium's support from the right front and slightly below, as
/// near as its eight corners stay in the picture with a little margin. An empty volume is a box of two
/// voxels. Where a stage is on, from slightly above, with its things in the picture.
Camera frameCamera(const BrickVolume& bricks, const glm::dvec3& up, double fov, double aspect,
                   const Stage& stage = {});

/// Whether the stage is on, its floor too, and the camera beneath it.
bool seesFloorFromBelow(const Camera& camera, const Stage& stage, const glm::dvec3& up,
                        const BrickVolume& bricks);

/// Where a medium comes from.
enum class MediumSource { scene, file, exposure };

struct ChosenMedium {
  Medium medium;
  MediumSource source = MediumSource::scene;
  std::string sentence;  // for stderr: which source, and the values
};

/// The scene's medium, else that of the file's metadata (sigma_s, sigma_a, g), else density auto-exposure:
/// albedo 1, g 0.6, and σ_t such that the mean active density over the edge of a cube of the active volume
/// gives an optical depth of 8. Throws InputError where the metadata does not hold a medium.
ChosenMedium chooseMedium(const Scene& scene, const BrickVolume& bricks);

/// `direction`, given for Z up, where the world's up is `up`: itself, or a quarter turn about X that takes +Z
/// to +Y and +Y to −Z.
glm::dvec3 turnedTo(const glm::dvec3& up, const glm::dvec3& direction);

/// Turns lights that follow up to where `up` is; they stay so.
void turnLights(Scene& scene, const glm::dvec3& up);

/// Names of the factors of octaves that `nephele-preview fit` leaves in a file's metadata: a, b, c, d. Each
/// is one number for all suns, or three, for suns at kFittedElevations; without the last, d is 0.
inline constexpr const char* kFittedFactors[] = {"octaves_a", "octaves_b", "octaves_c", "octaves_d"};

/// Name of how many orders beyond the first they were fitted for.
inline constexpr const char* kFittedCount = "octaves_count";

/// The number under that name; none where the file has none. Throws InputError where it is none that a scene
/// may ask for.
std::optional<int> fittedCount(const BrickVolume& bricks);

/// Whether the file holds factors of octaves.
bool hasFittedFactors(const BrickVolume& bricks);

/// Octaves whose factors (and, with them, whose number) the scene leaves open take those that were fitted to
/// the file for a sun at `elevation` (degrees, as sunElevation has it), where it holds them. Returns whether
/// it does. Throws InputError where they are no factors in [0, 1].
bool takeFittedFactors(Octaves& octaves, const BrickVolume& bricks, double elevation);

/// The same for a sun that has moved: factors that the scene leaves open follow it, the number of octaves
/// stays. A scene without octaves stays as it is.
void followSun(Scene& scene, const Medium& medium, const BrickVolume& bricks, const glm::dvec3& up);

/// Camera and medium of a scene, given or chosen; the file's up; the environment's picture, read. A camera
/// without `up` takes the file's. Lights that follow up are turned, and stay so. Throws InputError for an
/// environment that cannot be read.
ViewedScene resolveScene(const Scene& scene, const BrickVolume& bricks, double aspect,
                         std::string& mediumSentence);

/// For stderr: the look, the terms that are on, which of them are not physical, and the furnace value where
/// octaves are on, marked above 1.
std::string describeLight(const ViewedScene& view);

}  // namespace nephele
