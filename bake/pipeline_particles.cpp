// The `particles:` of an asset. Depends on particles, fields, base.
#include "bake/pipeline_particles.h"

#include <filesystem>

#include "base/files.h"
#include "base/version.h"

namespace nephele {
namespace {

InputFile inputFile(const std::string& name, const std::string& folder) {
  if (name.empty()) return {};
  const std::string path = (std::filesystem::path(folder) / name).string();
  Hasher hasher;
  hasher.text(readWhole(path));
  return {path, hasher.hex()};
}

/// The system without what changes no file: names of files stand as their contents elsewhere.
std::string contentOf(ParticleSystem system) {
  for (Emitter& emitter : system.emitters) emitter.file.clear();
  system.erosionField = nullptr;
  system.checkpointEvery = 0;
  return writeParticles(system);
}

void hashFiles(Hasher& hasher, const Asset& asset) {
  for (const InputFile& file : asset.particleFiles) hasher.text(file.contentHash);
  hasher.value(asset.fps);
}

}  // namespace

void readParticles(const yaml::Node& node, const std::string& folder, FieldReader& fields, Asset& asset,
                   Diagnostics& out) {
  asset.particles = readParticles(node, out);
  for (const Emitter& emitter : asset.particles->emitters) {
    try {
      asset.particleFiles.push_back(inputFile(emitter.file, folder));
    } catch (const InputError& error) {
      for (const Diagnostic& d : error.diagnostics()) out.add(d.where, d.sentence, d.hint);
    }
  }
  yaml::NodePtr& field = asset.particles->erosionField;
  if (field) asset.erosion = fields.read(field, "'field' of 'erosion'");
  // The system is written into files, where the recipe's names mean nothing.
  if (asset.erosion) field = fields.withoutNames(field);
}

void hashParticles(Hasher& hasher, const Asset& asset) {
  hasher.text(contentOf(*asset.particles));
  hashFiles(hasher, asset);
  if (!asset.particles->stableBox || !asset.frames) return;
  hasher.value(asset.frames->first);
  hasher.value(asset.frames->last);
}

std::string simulationHash(const Pipeline& pipeline, const Asset& asset) {
  // The splat's keys, and the curves that are read when particles are looked at, move nothing.
  ParticleSystem moving = *asset.particles;
  const ParticleSystem plain;
  moving.kernel = plain.kernel;
  moving.shutter = plain.shutter;
  moving.erosion = plain.erosion;
  moving.grids = plain.grids;
  moving.writePoints = plain.writePoints;
  moving.massTolerance = plain.massTolerance;
  moving.boxMin = moving.boxMax = plain.boxMin;
  moving.stableBox = plain.stableBox;
  moving.sizeOverLife.clear();
  moving.densityOverLife.clear();
  Hasher hasher;
  hasher.text(programVersion());
  hasher.value(pipeline.upAxis);
  hasher.value(pipeline.seed);
  hasher.text(contentOf(std::move(moving)));
  hashFiles(hasher, asset);
  return hasher.hex();
}

}  // namespace nephele
