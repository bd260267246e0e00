// Recipes: reading, hashing, building fields. Depends on fields, scene, base.
#include "bake/pipeline.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>
#include <tuple>

#include "bake/field_specs.h"
#include "bake/fields/motion.h"
#include "bake/pipeline_identity.h"
#include "bake/pipeline_particles.h"
#include "base/density_step.h"
#include "base/figures.h"
#include "base/hash.h"
#include "base/tolerance.h"
#include "base/version.h"
#include "base/yaml.h"

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

/// Every field of a spec once, however often it is shared.
template <class Visit>
void forEachSpec(const FieldSpec& spec, std::set<const FieldSpec*>& seen, const Visit& visit) {
  if (!seen.insert(&spec).second) return;
  visit(spec);
  for (const auto& [name, children] : spec.children)
    for (const FieldSpecPtr& child : children) forEachSpec(*child, seen, visit);
}

struct PlaceOrder {
  bool operator()(const SourceLocation& a, const SourceLocation& b) const {
    return std::tie(a.line, a.column) < std::tie(b.line, b.column);
  }
};

/// The asset's own fields that move, with their motion.
std::vector<std::pair<const FieldSpec*, Motion>> motionsOf(const Asset& asset) {
  std::vector<std::pair<const FieldSpec*, Motion>> list;
  std::set<const FieldSpec*> seen;
  const auto take = [&](const FieldSpec& spec) {
    if (spec.row->motion) list.emplace_back(&spec, spec.row->motion(Arguments(spec.values)));
  };
  if (asset.density) forEachSpec(*asset.density, seen, take);
  // Components of one curl move alike: the first stands for all.
  std::set<SourceLocation, PlaceOrder> places;
  for (const FieldSpecPtr& component : asset.velocityFields)
    if (component)
      forEachSpec(*component, seen, [&](const FieldSpec& spec) {
        if (places.insert(spec.where).second) take(spec);
      });
  return list;
}

Loop loopOf(const Asset& asset, int64_t frame) { return {*asset.loopFrames, frame, asset.fps}; }

void checkLoop(const Asset& asset, Diagnostics& out) {
  if (!asset.loopFrames) return;
  for (const auto& [spec, motion] : motionsOf(asset))
    for (const auto& [parameter, sentence] : loopComplaints(motion, loopOf(asset, 0))) {
      const auto place = spec->places.find(parameter);
      out.add(place == spec->places.end() ? spec->where : place->second, sentence);
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

/// Builds each shared field once for each size of voxel that it is read with.
class FieldBuilder {
 public:
  FieldPtr build(const FieldSpec& spec, const BuildContext& context) {
    const Key key{&spec, context.voxelSize};
    if (const auto known = built_.find(key); known != built_.end()) return known->second;
    // Transforms of transforms of one field can ask for it at ever new sizes.
    constexpr size_t kMostFields = 100000;
    if (built_.size() >= kMostFields)
      throw InputError(spec.where, "the recipe makes more than " + std::to_string(kMostFields) +
                                       " fields, by transforms that share their inputs");
    auto values = spec.values;
    const BuildContext inner = spec.row->inner ? spec.row->inner(Arguments(values), context) : context;
    for (const auto& [name, children] : spec.children) {
      std::vector<FieldPtr> list;
      for (const FieldSpecPtr& child : children) list.push_back(build(*child, inner));
      const bool isList = listParameter(*spec.row) && listParameter(*spec.row)->name == name;
      values.emplace(name, isList ? Value{std::move(list)} : Value{list.front()});
    }
    return built_[key] = spec.row->build(Arguments(std::move(values)), context);
  }

 private:
  using Key = std::pair<const FieldSpec*, double>;
  std::map<Key, FieldPtr> built_;
};

/// Hashes specs from the leaves up, each shared one once, so that sharing by name or alias changes nothing.
class SpecHasher {
 public:
  const std::string& digest(const FieldSpec& spec) {
    std::string& known = digests_[&spec];
    if (!known.empty()) return known;
    Hasher hasher;
    hasher.text(spec.row->name);
    for (const auto& [name, value] : spec.values) {
      hasher.text(name);
      hasher.value(int(value.index()));
      std::visit([&hasher](const auto& v) { feed(hasher, v); }, value);
    }
    for (const auto& [name, children] : spec.children) {
      hasher.text(name);
      for (const FieldSpecPtr& child : children) hasher.text(digest(*child));
    }
    return digests_[&spec] = hasher.hex();
  }

 private:
  static void feed(Hasher& out, double v) { out.value(v == 0.0 ? 0.0 : v); }  // -0 is 0
  static void feed(Hasher& out, int64_t v) { out.value(v); }
  static void feed(Hasher& out, const std::string& v) { out.text(v); }
  template <size_t N>
  static void feed(Hasher& out, const std::array<double, N>& v) {
    for (const double x : v) feed(out, x);
  }
  static void feed(Hasher& out, const Curve& v) {
    out.value(v.size());
    for (const auto& point : v) feed(out, point);
  }
  static void feed(Hasher& out, const InputFile& v) { out.text(v.contentHash); }
  // Built fields stand in arguments, never in specs.
  static void feed(Hasher&, const FieldPtr&) {}
  static void feed(Hasher&, const std::vector<FieldPtr>&) {}

  std::map<const FieldSpec*, std::string> digests_;
};

Pipeline pipelineOf(const yaml::NodePtr& root, const std::string& path) {
  Diagnostics out;
  Pipeline pipeline;
  pipeline.path = path;
  if (root->kind != yaml::Kind::map)
    throw InputError(root->where, "a recipe must be a map with 'assets', not " + yaml::describe(*root));
  yaml::MapReader reader(*root, "the recipe", out);
  pipeline.upAxis = reader.choice("up_axis", "z", {"y", "z"}).front();
  pipeline.seed = reader.integer("seed", 0, {-2147483648.0, 4294967295.0, false, false});
  if (const yaml::NodePtr scene = reader.find("scene")) pipeline.scene = readScene(*scene, out);
  const std::string folder = std::filesystem::path(path).parent_path().string();
  FieldReader fields(out, folder);
  if (const yaml::NodePtr named = reader.find("fields")) fields.setNamed(*named);
  const yaml::NodePtr assets = reader.find("assets");
  if (!assets || assets->kind != yaml::Kind::map || assets->entries.empty())
    out.add(reader.where("assets"), "the recipe needs 'assets', a map of at least one asset");
  else
    for (const yaml::Entry& entry : assets->entries)
      pipeline.assets.push_back(readAsset(entry, folder, fields, out));
  fields.readRest();
  reader.finish();
  out.throwIfAny();
  return pipeline;
}

}  // namespace

Pipeline loadPipeline(const std::string& path) { return pipelineOf(yaml::load(path), path); }

Pipeline readPipeline(const std::string& text, const std::string& name) {
  return pipelineOf(yaml::parse(text, name), name);
}

std::optional<FrameRange> parseFrames(const std::string& text) {
  FrameRange range;
  const char* const end = text.data() + text.size();
  const auto first = std::from_chars(text.data(), end, range.first);
  if (first.ec != std::errc{} || range.first < 0 || range.first > kLastFrame) return std::nullopt;
  if (first.ptr == end) return FrameRange{range.first, range.first};
  if (*first.ptr != '-') return std::nullopt;
  const auto last = std::from_chars(first.ptr + 1, end, range.last);
  if (last.ec != std::errc{} || last.ptr != end || range.last < range.first || range.last > kLastFrame)
    return std::nullopt;
  return range;
}

FieldPtr buildField(const FieldSpec& spec, const BuildContext& context) {
  return FieldBuilder().build(spec, context);
}

BuildContext contextOf(const Pipeline& pipeline, const Asset& asset, std::optional<int> frame) {
  BuildContext context;
  context.voxelSize = asset.voxelSize;
  context.mostOctaves = asset.mostOctaves;
  context.upAxis = pipeline.upAxis == 'y' ? 1 : 2;
  context.seed = uint32_t(pipeline.seed);
  if (frame) context.time = *frame / asset.fps;
  if (frame && asset.loopFrames) context.loop = loopOf(asset, *frame);
  return context;
}

std::vector<LoopNote> loopNotesOf(const Asset& asset) {
  std::vector<LoopNote> notes;
  if (!asset.loopFrames) return notes;
  for (const auto& [spec, motion] : motionsOf(asset))
    for (LoopNote& note : loopNotes(motion, loopOf(asset, 0), spec->row->name))
      notes.push_back(std::move(note));
  return notes;
}

std::string recipeHash(const Pipeline& pipeline, const Asset& asset, std::optional<int> frame) {
  Hasher hasher;
  hasher.text(programVersion());
  hasher.text(buildIdentity());
  hasher.value(pipeline.upAxis);
  hasher.value(pipeline.seed);
  hasher.value(asset.voxelSize);
  if (asset.tolerance) {
    hasher.value(*asset.tolerance);
    hasher.value(int(asset.precisionGiven));
    hasher.value(int(asset.densityStepGiven));
  }
  hasher.value(int(asset.precision));
  hasher.value(asset.densityStep);
  hasher.value(asset.cutoff);
  const BuildContext context = contextOf(pipeline, asset, frame);
  hasher.value(context.loop ? 0.0 : context.time);
  if (context.loop) {
    hasher.value(context.loop->frames);
    hasher.value(context.loop->frame % context.loop->frames);
    hasher.value(context.loop->fps);
  }
  const bool medium = pipeline.scene && pipeline.scene->medium;
  hasher.value(int(medium));
  if (medium) {
    hasher.value(pipeline.scene->medium->sigmaS);
    hasher.value(pipeline.scene->medium->sigmaA);
    hasher.value(pipeline.scene->medium->g);
  }
  SpecHasher specs;
  if (asset.particles) {
    hashParticles(hasher, asset);
    hasher.value(frame.value_or(0));
    if (asset.erosion) hasher.text(specs.digest(*asset.erosion));
    return hasher.hex();
  }
  hasher.text(specs.digest(*asset.density));
  hasher.value(int(asset.velocityFromMotion));
  for (const FieldSpecPtr& component : asset.velocityFields) hasher.text(specs.digest(*component));
  return hasher.hex();
}

}  // namespace nephele
