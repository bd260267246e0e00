// Recipes: reading, hashing, building fields. Depends on fields, scene, base.
#include "bake/pipeline.h"

#include <charconv>
#include <filesystem>

#include "bake/field_specs.h"
#include "bake/pipeline_asset.h"
#include "bake/pipeline_identity.h"
#include "bake/pipeline_loop.h"
#include "bake/pipeline_particles.h"
#include "base/hash.h"
#include "base/version.h"
#include "base/yaml.h"

namespace nephele {
namespace {

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
