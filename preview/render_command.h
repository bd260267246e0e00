// The headless commands behind main: render a file or a sequence, compare two pictures. Depends on preview,
// volume, base.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "base/picture.h"
#include "preview/filter.h"
#include "preview/viewed_scene.h"
#include "scene/scene.h"
#include "volume/bricks.h"

namespace nephele {

/// What the command line may say of a render; defaults as in --help.
struct RenderOptions {
  std::string file;
  std::string out;  // .exr or .png
  std::string method = "march";
  std::string scene;  // a file or a preset; empty: the default scene in the report look
  std::string grid;   // empty: chosen
  int width = 960;
  int height = 540;
  std::optional<unsigned> samples;   // none: 4, and 64 for the reference
  std::optional<double> stepVoxels;  // overrides the scene's
  std::string stats;                 // empty: none
  unsigned seed = 0;
  std::optional<double> exposureEv;  // none: 0 with a scene, chosen from the picture without
  bool aov = false;
  Filter filter = Filter::hardware;
  uint64_t vramBytes = 0;      // limit of GPU memory; 0: none
  std::optional<int> bounces;  // scatterings after the first, for methods that count them; none: all
  double error = 0.0;          // above 0: relative RMSE that the picture's noise may have
  std::optional<std::pair<int, int>> frames;  // both ends included
};

/// The scene of the file `path`, or the preset of that name where there is no such file, or the default scene
/// in the report look where it is empty; a step given replaces the scene's. Throws InputError.
Scene openScene(const std::string& path, std::optional<double> stepVoxels);

/// Loads a grid and puts its notes on stderr; an empty one gets a sentence.
BrickVolume openVolume(const std::string& path, const std::string& grid);

/// The file of one frame: a run of # in the name, else the digits at the end of the stem, replaced by the
/// frame, padded with zeros to the same width. Throws InputError where the name has neither.
std::string framePath(const std::string& pattern, int frame);

/// OUT_0001.exr for OUT.exr, or a run of # replaced.
std::string frameOutput(const std::string& pattern, int frame);

/// Writes a render with its eight planes by the ending of `path`: .png over what behindOf(scene) says
/// (preview/behind.h); .exr with R, G, B, A, and all planes where `aov` is set.
void writePicture(const std::string& path, Picture picture, const ViewedScene& view, double exposureEv,
                  bool aov);

/// The exposure at which the medium's bright parts (95th percentile of radiance over alpha, where alpha
/// exceeds ½) are shown at 0.88 of white before the transfer function, within ±16 EV; 0 where nothing of it
/// is lit.
double chooseExposure(const Picture& picture);

/// The exposure that the options ask for: as given, else 0 with a scene, else chosen from the picture and
/// told on stderr.
double exposureFor(const RenderOptions& options, const Picture& picture);

/// Renders and writes. Throws InputError or WorldError. Of a sequence, frames that cannot be read are told of
/// on stderr and left out. Returns the exit code: 0, or 2 where a frame was left out.
int renderCommand(const RenderOptions& options);

/// Prints the comparison on stdout; returns 3 where `tolerance` is given and the relative RMSE exceeds it,
/// else 0.
int compareCommand(const std::string& picture, const std::string& reference, std::optional<double> tolerance,
                   bool json);

}  // namespace nephele
