// One asset of a recipe: every key of it but what is in its fields and particles. Depends on
// pipeline_asset.h, base.
#include "bake/pipeline_asset.h"

#include <algorithm>
#include <map>

#include "bake/pipeline_loop.h"
#include "bake/pipeline_particles.h"
#include "base/density_step.h"
#include "base/figures.h"
#include "base/tolerance.h"

namespace nephele {
namespace {

/// What a file name may be made of: ASCII, no digits at the end (sequences are found by them).
bool isAssetName(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
  };
  return !name.empty() && std::all_of(name.begin(), name.end(), plain) && name.front() != '-' &&
         !(name.back() >= '0' && name.back() <= '9');
}

void readFrames(yaml::MapReader& reader, Asset& asset, Diagnostics& out) {
  const yaml::NodePtr node = reader.find("frames");
  // Seconds since frame 0 then stay below 10^8, and so precise that fields move on from frame to frame.
  constexpr Range kFps{0.01, 1e5, false, false};
  asset.fps = reader.number("fps", asset.fps, kFps);
  if (!node) return;
  const auto text = yaml::readText(*node, "'frames'", out);
  if (!text) return;
  asset.frames = parseFrames(*text);
  if (!asset.frames)
    out.add(node->where,
            "'frames' must read A-B, with 0 <= A <= B <= " + std::to_string(kLastFrame) + ", as in 1-48");
}

/// `loop: true` is the frame range; a number is so many frames.
void readLoop(yaml::MapReader& reader, Asset& asset, Diagnostics& out) {
  const yaml::NodePtr node = reader.find("loop");
  if (!node || (node->kind == yaml::Kind::scalar && node->scalar == "false")) return;
  if (!reader.has("frames")) {
    out.add(reader.where("loop"), "'loop' needs 'frames', the range that is baked");
    return;
  }
  if (node->kind == yaml::Kind::scalar && node->scalar == "true") {
    if (asset.frames) asset.loopFrames = int64_t{asset.frames->last} - asset.frames->first + 1;
    return;
  }
  constexpr double kLongestLoop = 1e6;
  asset.loopFrames = yaml::readInteger(*node, "'loop' (true, or a number of frames)",
                                       {1.0, kLongestLoop, false, false}, out);
}

/// The field with every curl whose component is left open as that of one axis; equal to the field itself
/// where it holds none. Shared fields stay shared.
FieldSpecPtr componentOf(const FieldSpecPtr& spec, char axis,
                         std::map<const FieldSpec*, FieldSpecPtr>& done) {
  FieldSpecPtr& known = done[spec.get()];
  if (known) return known;
  const bool open = spec->row->name == "curl" && !spec->places.contains("component");
  auto copy = std::make_shared<FieldSpec>(*spec);
  bool changed = open;
  if (open) copy->values["component"] = std::string(1, axis);
  for (auto& [name, children] : copy->children)
    for (FieldSpecPtr& child : children) {
      FieldSpecPtr part = componentOf(child, axis, done);
      changed = changed || part != child;
      child = std::move(part);
    }
  // `known` may have moved while children were added.
  return done[spec.get()] = changed ? FieldSpecPtr(copy) : spec;
}

/// `velocity: true`, a field that holds a curl, or a list of three fields.
void readVelocity(yaml::MapReader& reader, Asset& asset, FieldReader& fields, Diagnostics& out) {
  const yaml::NodePtr node = reader.find("velocity");
  if (!node || (node->kind == yaml::Kind::scalar && node->scalar == "false")) return;
  if (node->kind == yaml::Kind::scalar && node->scalar == "true") {
    asset.velocityFromMotion = true;
    return;
  }
  if (node->kind == yaml::Kind::sequence) {
    if (node->items.size() != 3)
      out.add(node->where,
              "'velocity' takes three fields, one a component, not " + std::to_string(node->items.size()));
    else
      for (const yaml::NodePtr& item : node->items)
        asset.velocityFields.push_back(fields.read(item, "a component of 'velocity'"));
    return;
  }
  const FieldSpecPtr field = fields.read(node, "'velocity' (or true, or three fields)");
  if (!field) return;
  for (const char axis : {'x', 'y', 'z'}) {
    std::map<const FieldSpec*, FieldSpecPtr> done;
    asset.velocityFields.push_back(componentOf(field, axis, done));
  }
  if (asset.velocityFields.front() == field) {
    out.add(node->where, "'velocity' needs three components and this field has one",
            "give a curl without 'component', or a list of three fields");
    asset.velocityFields.clear();
  }
}

/// An asset holds a density or particles.
void readContent(yaml::MapReader& reader, const std::string& what, const std::string& folder,
                 FieldReader& fields, Asset& asset, Diagnostics& out) {
  const yaml::NodePtr density = reader.find("density"), particles = reader.find("particles");
  if (density && particles)
    out.add(reader.where("particles"), what + " gives both 'density' and 'particles'; give one of them");
  if (density) asset.density = fields.read(density, "'density'");
  if (particles) readParticles(*particles, folder, fields, asset, out);
  if (!density && !particles) out.add(asset.where, what + " needs 'density' or 'particles'");
  if (!particles) return;
  for (const char* const key : {"loop", "velocity"})
    if (reader.has(key))
      out.add(reader.where(key), std::string("'") + key + "' goes with 'density'",
              key == std::string("velocity") ? "particles take 'grids: [vel]'" : "");
}

/// `voxel_size` or `tolerance`, exactly one of them.
void readTolerance(yaml::MapReader& reader, const std::string& what, Asset& asset, Diagnostics& out) {
  const yaml::NodePtr node = reader.find("tolerance");
  if (!node) {
    if (!reader.has("voxel_size")) out.add(asset.where, what + " needs 'voxel_size' or 'tolerance'");
    return;
  }
  if (reader.has("voxel_size")) {
    out.add(reader.where("tolerance"), what + " gives both 'voxel_size' and 'tolerance'; give one of them");
    return;
  }
  const auto text = yaml::readText(*node, "'tolerance'", out);
  if (!text) return;
  try {
    asset.tolerance = parseTolerance(*text);
  } catch (const InputError& error) {
    for (const Diagnostic& d : error.diagnostics()) out.add(node->where, d.sentence, d.hint);
    return;
  }
  if (!(*asset.tolerance > 0.0 && *asset.tolerance < 1.0))
    out.add(node->where, "'tolerance' must lie between 0 and 100%, ends excluded");
}

/// A power of two, or 0; beside a tolerance 0 alone, which chooses it otherwise.
void readDensityStep(yaml::MapReader& reader, Asset& asset, Diagnostics& out) {
  asset.densityStepGiven = reader.has("density_step");
  asset.densityStep = reader.number("density_step", 0.0, kNonNegative);
  if (asset.densityStep == 0.0) return;
  if (!isDensityStep(asset.densityStep))
    out.add(reader.where("density_step"), "'density_step' must be 0 or a power of two from 2^-24 to 2^15",
            "for example " + number(densityStepFor(asset.densityStep, 1.0)));
  else if (asset.tolerance)
    out.add(reader.where("density_step"), "'tolerance' chooses 'density_step'",
            "give 0 where densities are to stay as precise as they can be");
}

}  // namespace

Asset readAsset(const yaml::Entry& entry, const std::string& folder, FieldReader& fields, Diagnostics& out) {
  Asset asset;
  asset.name = entry.key;
  asset.where = entry.where;
  const std::string what = "asset '" + entry.key + "'";
  if (!isAssetName(entry.key))
    out.add(entry.where,
            "'" + entry.key + "' cannot name a file: use letters, digits, _ and -, and no digit at the end");
  if (entry.value->kind != yaml::Kind::map) {
    out.add(entry.value->where, what + " must be a map, not " + yaml::describe(*entry.value));
    return asset;
  }
  yaml::MapReader reader(*entry.value, what, out);
  asset.voxelSize = reader.number("voxel_size", 0.0, kPositive);
  asset.precision =
      reader.choice("precision", "half", {"half", "float"}) == "half" ? Precision::half : Precision::single;
  asset.precisionGiven = reader.has("precision");
  asset.cutoff = reader.number("cutoff", asset.cutoff, kNonNegative);
  readFrames(reader, asset, out);
  readLoop(reader, asset, out);
  readTolerance(reader, what, asset, out);
  readDensityStep(reader, asset, out);
  readContent(reader, what, folder, fields, asset, out);
  readVelocity(reader, asset, fields, out);
  checkLoop(asset, out);
  reader.finish();
  return asset;
}

}  // namespace nephele
