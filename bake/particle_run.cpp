// Simulation from frame to frame with checkpoints, and what the splat is told. Depends on particle_run.h,
// particle_sources.h, base.
#include "bake/particle_run.h"

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <numbers>

#include "bake/particle_sources.h"
#include "bake/pipeline_particles.h"
#include "base/figures.h"
#include "base/files.h"

namespace nephele {
namespace {

namespace fs = std::filesystem;

double secondsSince(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

struct ParticleRun::State {
  const Pipeline& pipeline;
  const Asset& asset;
  const ParticleSystem& system;
  std::string folder;  // of checkpoints
  std::string key;     // of all that the simulation depends on
  std::vector<SiteSourcePtr> sources;
  std::unique_ptr<Simulation> simulation;
  std::optional<int> viewed;  // the frame that the view shows
  ParticleView view;
  std::optional<Box> everyFrame;  // the box of all frames, where the recipe asks for one; may be empty
  /// What densityAlong() found of the view's kernels, by voxel size and octaves.
  mutable std::map<std::pair<double, int>, std::vector<double>> sums;

  /// "asset 'plume', frame 3: ".
  std::string name() const {
    return "asset '" + asset.name + "'" + (viewed ? ", frame " + std::to_string(*viewed) : "") + ": ";
  }

  int upAxis() const { return pipeline.upAxis == 'y' ? 1 : 2; }

  std::unique_ptr<Simulation> fresh() const {
    return std::make_unique<Simulation>(system, sources,
                                        SimulationSettings{asset.fps, upAxis(), uint32_t(pipeline.seed)});
  }

  std::string checkpointOf(int frame) const {
    char name[64];
    std::snprintf(name, sizeof name, "%.12s_%04d.state", key.c_str(), frame);
    return (fs::path(folder) / name).string();
  }

  uint64_t stepsAt(int frame) const { return uint64_t(system.prewarm + frame) * uint64_t(system.substeps); }

  /// A simulation that is at `frame` or before: the one at hand, the nearest checkpoint, or a new one.
  void begin(int frame) {
    const uint64_t wanted = stepsAt(frame);
    const uint64_t reached = simulation && simulation->stepsDone() <= wanted ? simulation->stepsDone() : 0;
    if (!simulation || simulation->stepsDone() > wanted) simulation = fresh();
    for (int at = frame; at >= 0 && stepsAt(at) > reached; --at) {
      const std::string path = checkpointOf(at);
      if (!fs::exists(path)) continue;
      // One that is damaged is as good as none.
      if (simulation->load(readWhole(path)) && simulation->stepsDone() == stepsAt(at)) return;
      simulation = fresh();
    }
  }

  void makeFolder() const {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) throw WorldError("cannot make the folder '" + folder + "': " + error.message());
    removeLeftovers(folder);
  }

  void writeCheckpoint(int frame) const {
    const std::string path = checkpointOf(frame);
    if (fs::exists(path)) return;
    makeFolder();
    std::error_code error;
    // Those of other recipes are of no use to anybody.
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if ((name.ends_with(".state") || name.ends_with(".box")) && name.substr(0, 12) != key.substr(0, 12))
        fs::remove(entry.path(), error);
    }
    const std::string bytes = simulation->save();
    writeWhole(path, [&](const std::string& temporary) {
      std::ofstream out(temporary, std::ios::binary);
      if (!(out.write(bytes.data(), std::streamsize(bytes.size())) << std::flush))
        throw WorldError("cannot write '" + path + "'; is the disk full?");
    });
  }

  /// Steps to `frame`, leaving checkpoints on the way.
  void advance(int frame) {
    const int64_t every = system.checkpointEvery;
    while (simulation->stepsDone() < stepsAt(frame)) {
      simulation->step();
      const uint64_t frames = simulation->stepsDone() / uint64_t(system.substeps);
      const int64_t at = int64_t(frames) - system.prewarm;
      if (every > 0 && at > 0 && at % every == 0 && simulation->stepsDone() == stepsAt(int(at)))
        writeCheckpoint(int(at));
    }
  }

  /// What the particles of the view reach, but for the voxel that the smallest are spread over.
  Box reached() const {
    const double halfShutter = 0.5 * system.shutter / asset.fps;
    Box box = nothing();
    for (size_t n = 0; n < view.size(); ++n) {
      const glm::dvec3 at(double(view.x[n]), double(view.y[n]), double(view.z[n]));
      const glm::dvec3 moved =
          halfShutter * glm::abs(glm::dvec3(double(view.vx[n]), double(view.vy[n]), double(view.vz[n])));
      box = hull(box, {at - moved - double(view.radius[n]), at + moved + double(view.radius[n])});
    }
    return box;
  }

  /// Beside the checkpoints; keyed by all that the box of all frames depends on.
  std::string boxFile() const {
    Hasher hasher;
    hashParticles(hasher, asset);
    return (fs::path(folder) / (key.substr(0, 12) + "_" + hasher.hex().substr(0, 12) + ".box")).string();
  }

  /// The box that an earlier run has left; one that is damaged is as good as none.
  std::optional<Box> readBox() const {
    std::ifstream in(boxFile());
    Box box = nothing();
    std::string word;
    if (!(in >> word)) return std::nullopt;
    if (word == "empty") return box;
    for (double* value : {&box.low.x, &box.low.y, &box.low.z, &box.high.x, &box.high.y, &box.high.z})
      if (!(in >> *value)) return std::nullopt;
    const bool whole = word == "box" && in >> word && word == "end" && !box.empty();
    return whole ? std::optional(box) : std::nullopt;
  }

  void writeBox(const Box& box) const {
    makeFolder();
    const std::string path = boxFile();
    writeWhole(path, [&](const std::string& temporary) {
      std::ofstream out(temporary);
      out.precision(std::numeric_limits<double>::max_digits10);
      if (box.empty())
        out << "empty\n";
      else
        out << "box " << box.low.x << ' ' << box.low.y << ' ' << box.low.z << ' ' << box.high.x << ' '
            << box.high.y << ' ' << box.high.z << " end\n";
      if (!(out << std::flush)) throw WorldError("cannot write '" + path + "'; is the disk full?");
    });
  }

  /// Simulates all frames of the asset, whichever of them are asked for, so that each gets the same box.
  void findBoxOfAllFrames() {
    if (everyFrame || !system.stableBox) return;
    everyFrame = readBox();
    if (everyFrame) return;
    Box box = nothing();
    const FrameRange frames = asset.frames.value_or(FrameRange{0, 0});
    for (int frame = frames.first; frame <= frames.last; ++frame) {
      begin(frame);
      advance(frame);
      view = simulation->view();
      box = hull(box, reached());
    }
    everyFrame = box;
    writeBox(box);
  }

  Splatted splatWith(const SplatSettings& settings) const {
    const ParticleView& v = view;
    try {
      return splat({v.x, v.y, v.z, v.radius, v.mass, v.vx, v.vy, v.vz, v.temperature, v.age,
                    simulation->particles().id},
                   settings);
    } catch (const SplatError& error) {
      throw InputError(asset.where, name() + error.what());
    }
  }

  SplatSettings splatSettings(const Asset& look) const {
    SplatSettings settings;
    settings.voxelSize = look.voxelSize;
    settings.kernel = system.kernel;
    settings.cutoff = look.cutoff;
    settings.half = look.precision == Precision::half;
    settings.densityStep = look.densityStep;
    settings.shutterSeconds = system.shutter / asset.fps;
    for (const std::string& grid : system.grids) {
      settings.vel = settings.vel || grid == "vel";
      settings.temperature = settings.temperature || grid == "temperature";
      settings.age = settings.age || grid == "age";
    }
    if (asset.erosion) {
      BuildContext context = contextOf(pipeline, look, viewed);
      // It is read in radii of particles, which the grid's band limit knows nothing of: no octave is left
      // out.
      constexpr double kFine = 1e-6;
      context.voxelSize = kFine;
      settings.erosion = buildField(*asset.erosion, context);
      settings.erosionAmount = system.erosion;
    }
    if (system.hasBox()) settings.box = Box{system.boxMin, system.boxMax};
    // A point is spread over the voxels round it; one more keeps the box's corners free of rounding.
    if (everyFrame && !everyFrame->empty()) settings.box = grown(*everyFrame, 2.0 * look.voxelSize);
    return settings;
  }
};

ParticleRun::ParticleRun(const Pipeline& pipeline, const Asset& asset, const std::string& outFolder)
    : state_(new State{pipeline,
                       asset,
                       *asset.particles,
                       (fs::path(outFolder) / (asset.name + ".checkpoints")).string(),
                       simulationHash(pipeline, asset),
                       {},
                       nullptr,
                       std::nullopt,
                       {},
                       std::nullopt,
                       {}}) {
  for (size_t n = 0; n < asset.particles->emitters.size(); ++n)
    state_->sources.push_back(makeSiteSource(asset.particles->emitters[n], asset.particleFiles[n].path));
}

ParticleRun::~ParticleRun() = default;

uint64_t ParticleRun::moveTo(std::optional<int> frame) {
  State& s = *state_;
  s.viewed = frame;
  try {
    s.findBoxOfAllFrames();
    s.begin(frame.value_or(0));
    const uint64_t before = s.simulation->stepsDone();
    s.advance(frame.value_or(0));
    s.view = s.simulation->view();
    s.sums.clear();
    return s.simulation->stepsDone() - before;
  } catch (const SimulationError& error) {
    throw InputError(s.asset.where, s.name() + error.what());
  }
}

Splatted ParticleRun::splatted(const Asset& look) const {
  return state_->splatWith(state_->splatSettings(look));
}

Splatted ParticleRun::densityAlong(std::span<const Chord> chords, const Asset& look) const {
  SplatSettings settings = state_->splatSettings(look);
  settings.vel = settings.temperature = settings.age = false;
  // Points and the smallest are spread over the voxels round them.
  const Box box = grown(state_->reached(), 2.0 * look.voxelSize);
  const ChordVoxels read(chords, look.voxelSize, box.low, box.high);
  const SplatMeasure measure{read, state_->sums[{look.voxelSize, look.mostOctaves}]};
  settings.measure = &measure;
  return state_->splatWith(settings);
}

Box ParticleRun::extent() const {
  Box box = nothing();
  const ParticleView& v = state_->view;
  for (size_t n = 0; n < v.size(); ++n) {
    const glm::dvec3 at(double(v.x[n]), double(v.y[n]), double(v.z[n]));
    box = hull(box, {at - double(v.radius[n]), at + double(v.radius[n])});
  }
  return box;
}

ParticleFrame ParticleRun::frame(std::optional<int> frame) {
  State& s = *state_;
  ParticleFrame result;
  auto start = std::chrono::steady_clock::now();
  result.stepsSimulated = moveTo(frame);
  result.secondsSimulate = secondsSince(start);
  start = std::chrono::steady_clock::now();
  result.splatted = splatted(s.asset);
  result.secondsSplat = secondsSince(start);
  const BirthLedger& births = s.simulation->ledger();
  const SplatLedger& grid = result.splatted.ledger;
  MassLedger& m = result.mass;
  m = {births.emitted,      births.died,     births.emitted - births.died - grid.given,
       grid.given,          grid.outsideBox, grid.splatted,
       grid.lostToCutoff,   grid.lostToHalf, grid.stored,
       births.countEmitted, s.view.size()};
  const double lost = m.alive > 0.0 ? (m.alive - m.stored) / m.alive : 0.0;
  if (lost > s.system.massTolerance)
    throw InputError(s.asset.where, s.name() + "the grid loses " + percent(lost) +
                                        " of the particles' mass (to the cutoff " +
                                        percent(m.lostToCutoff / m.alive) + ", to half precision " +
                                        percent(m.lostToHalf / m.alive) + ", outside the box " +
                                        percent(m.outsideBox / m.alive) + "), more than mass_tolerance, " +
                                        percent(s.system.massTolerance));
  return result;
}

void ParticleRun::writePointsBeside(const std::string& vdbFile) const {
  const State& s = *state_;
  if (s.system.writePoints.empty()) return;
  const ParticleView& v = s.view;
  PointSet points;
  points.x = v.x, points.y = v.y, points.z = v.z;
  points.vx = v.vx, points.vy = v.vy, points.vz = v.vz;
  points.radius = v.radius, points.mass = v.mass, points.temperature = v.temperature, points.age = v.age;
  points.density.resize(v.size());
  for (size_t n = 0; n < v.size(); ++n)
    points.density[n] =
        v.mass[n] / (float(4.0 / 3.0 * std::numbers::pi) * v.radius[n] * v.radius[n] * v.radius[n]);
  // NAME_0001.vdb → NAME_points_0001.csv
  const fs::path file(vdbFile);
  std::string stem = file.stem().string();
  stem.insert(s.asset.name.size(), "_points");
  for (const std::string& extension : s.system.writePoints)
    writePoints((file.parent_path() / (stem + "." + extension)).string(), points);
}

}  // namespace nephele
