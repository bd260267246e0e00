// Buffers and dispatches of the rebuild. Depends on gpu/live_grid.h.
#include "preview/gpu/live_grid.h"

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

// As the shaders declare them.
enum Binding : GLuint { kSums = 2, kWide = 3, kCorners = 3, kLargest = 4 };
constexpr GLuint kGridBlock = 3, kAtlasImage = 0, kIndexImage = 1;
constexpr uint32_t kSplatGroup = 32, kIndexGroup = 32;
constexpr double kMostUnits = 4294967295.0;  // of 32 bits
constexpr int kLeastEdge = 8;

struct GridBlock {
  glm::vec4 corner;
  glm::ivec4 size;
  glm::vec4 units;
  glm::ivec4 offset, bricks;
  glm::vec4 bound;
};

GlBuffer storage(uint64_t bytes, const void* data = nullptr) {
  GlBuffer buffer = makeBuffer();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_STORAGE_BIT);
  return buffer;
}

uint32_t groups(uint64_t count, uint32_t size) { return static_cast<uint32_t>((count + size - 1) / size); }

uint64_t volumeOf(const glm::ivec3& size) {
  return static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y) * static_cast<uint64_t>(size.z);
}

int floorToBrick(int voxel) { return static_cast<int>(std::floor(static_cast<double>(voxel) / kBrickCells)); }

/// Bricks along an axis that cover a box's support, which begins a voxel before it.
struct BrickSpan {
  int first = 0, count = 0;
};
BrickSpan brickSpan(const LiveBox& box, int axis) {
  const int first = floorToBrick(box.low[axis] - 1), last = floorToBrick(box.low[axis] + box.size[axis] - 1);
  return {first, last + 1 - first};
}

/// Units for a mass of 1: all the mass there can be stays below 2^32 of them, and so does one more a
/// particle.
double unitsPerMass(double mostMass, uint32_t slots) {
  return mostMass > 0.0 ? (kMostUnits - 2.0 * slots) / mostMass : 0.0;
}

}  // namespace

LiveBox liveBox(const MotionBox& box, int edge) {
  const glm::dvec3 sides = box.high - box.low;
  LiveBox live;
  live.voxelSize = std::max({sides.x, sides.y, sides.z}) / std::clamp(edge, kLeastEdge, kMostLiveEdge);
  for (int axis = 0; axis < 3; ++axis) {
    live.low[axis] = static_cast<int>(std::ceil(box.low[axis] / live.voxelSize));
    live.size[axis] =
        std::clamp(static_cast<int>(std::round(sides[axis] / live.voxelSize)), 1, kMostLiveEdge);
  }
  return live;
}

BrickVolume liveVolume(const LiveBox& box, const BrickVolume& like) {
  BrickVolume volume = withoutBricks(like);
  volume.temperature = nullptr;  // densities alone are live
  volume.gridName = "live density";
  volume.worldFromIndex = glm::dmat4(box.voxelSize);
  volume.worldFromIndex[3][3] = 1.0;
  volume.activeMin = box.low;
  volume.activeMax = box.low + box.size;
  for (int axis = 0; axis < 3; ++axis) {
    const BrickSpan span = brickSpan(box, axis);
    volume.brickMin[axis] = span.first;
    volume.brickCount[axis] = span.count;
  }
  const size_t bricks = volumeOf(volume.brickCount);
  for (size_t n = 0; n < bricks; ++n) volume.index.push_back(static_cast<uint32_t>(n + 1));
  // Every sample counts, so that the layout gives every brick all of its place.
  volume.samples.assign(bricks * kBrickVolume, 1.0f);
  volume.slotMaximum.assign(bricks, 1.0f);
  volume.activeVoxels = volumeOf(box.size);
  return volume;
}

LiveGrid::LiveGrid(const std::vector<TextChange>& changes)
    : changes_(changes),
      resolve_(buildComputeProgram("particles_resolve.comp", {}, changes)),
      index_(buildComputeProgram("particles_index.comp", {}, changes)),
      grid_(storage(sizeof(GridBlock))) {
  checkGl("making the live grid");
}

double LiveGrid::unitOf(const LiveBox& box, double mostMass, uint32_t slots) {
  const double units = unitsPerMass(mostMass, slots);
  return units > 0.0 ? 1.0 / (units * box.voxelSize * box.voxelSize * box.voxelSize) : 0.0;
}

double LiveGrid::boundOf(const LiveBox& box, double mostMass) {
  constexpr double kMargin = 1.0 + 1e-6;
  return kMargin * mostMass / (box.voxelSize * box.voxelSize * box.voxelSize);
}

const GlProgram& LiveGrid::splat(const LiveMotion& motion, bool wide) {
  const std::vector<std::string> defines{
      "NPH_KERNEL " + std::to_string(static_cast<int>(motion.system().kernel)),
      std::string("NPH_STRETCHED ") + (motion.system().shutter > 0.0 ? "true" : "false"),
      std::string("NPH_WIDE ") + (wide ? "1" : "0")};
  GlProgram& program = splats_[defines];
  if (program.name() == 0) program = buildComputeProgram("particles_splat.comp", defines, changes_);
  return program;
}

void LiveGrid::shape(const LiveBox& box, const BrickAtlas& atlas, uint32_t slots) {
  const BrickLayout& layout = atlas.layout();
  box_ = box;
  slots_ = slots;
  atlasSerial_ = atlas.serial();
  for (int axis = 0; axis < 3; ++axis) {
    const BrickSpan span = brickSpan(box, axis);
    bricks_[axis] = span.count;
    offset_[axis] = span.first * kBrickCells - box.low[axis];
  }
  std::vector<glm::ivec4> corners;
  for (const glm::uvec2& word : layout.words) corners.emplace_back(brick_word::corner(word), 0);
  NEPHELE_CHECK_EQ(corners.size(), volumeOf(bricks_));
  gpuBytes_ = 0;
  const auto make = [&](uint64_t bytes, const void* data = nullptr) {
    gpuBytes_ += bytes;
    return storage(bytes, data);
  };
  sums_ = make(volumeOf(box.size) * sizeof(uint32_t));
  wide_ = make(sizeof(glm::uvec4) + std::max<uint64_t>(slots, 1) * sizeof(uint32_t));
  corners_ = make(corners.size() * sizeof(glm::ivec4), corners.data());
  largest_ = make(corners.size() * sizeof(uint32_t));
  checkGl("making a live grid of " + std::to_string(volumeOf(box.size)) + " voxels");
}

void LiveGrid::upload(const LiveMotion& motion, double mostMass) {
  const double h = box_.voxelSize, units = unitsPerMass(mostMass, slots_);
  GridBlock block;
  block.corner = glm::vec4(glm::vec3(glm::dvec3(box_.low) * h), static_cast<float>(1.0 / h));
  block.size = glm::ivec4(box_.size, 0);
  block.units = {static_cast<float>(units), static_cast<float>(unitOf(box_, mostMass, slots_)),
                 static_cast<float>(motion.system().shutter / (motion.settings().fps * h)),
                 static_cast<float>(motion.seconds())};
  block.offset = glm::ivec4(offset_, 0);
  block.bricks = glm::ivec4(bricks_, bricks_.x * bricks_.y * bricks_.z);
  block.bound = glm::vec4(static_cast<float>(boundOf(box_, mostMass)));
  glNamedBufferSubData(grid_.name(), 0, sizeof block, &block);
  const glm::uvec4 dispatch{groups(static_cast<uint64_t>(box_.size.z), kSplatGroup), 0, 1, 0};
  glNamedBufferSubData(wide_.name(), 0, sizeof dispatch, &dispatch);
}

void LiveGrid::rebuild(const LiveMotion& motion, const LiveBox& box, double mostMass, BrickAtlas& atlas) {
  if (!(box == box_) || atlas.serial() != atlasSerial_ || motion.slotCount() != slots_)
    shape(box, atlas, motion.slotCount());
  upload(motion, mostMass);
  motion.bind();
  motion.clearCount();
  glClearNamedBufferData(sums_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glBindBufferBase(GL_UNIFORM_BUFFER, kGridBlock, grid_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSums, sums_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kWide, wide_.name());
  glUseProgram(splat(motion, false).name());
  glDispatchCompute(groups(slots_, kSplatGroup), 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT);
  glUseProgram(splat(motion, true).name());
  glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, wide_.name());
  glDispatchComputeIndirect(0);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kCorners, corners_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kLargest, largest_.name());
  glBindImageTexture(kAtlasImage, atlas.texture(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_R32F);
  glBindImageTexture(kIndexImage, atlas.indexTexture(), 0, GL_FALSE, 0, GL_WRITE_ONLY, GL_RG32UI);
  glUseProgram(resolve_.name());
  glDispatchCompute(static_cast<GLuint>(bricks_.x), static_cast<GLuint>(bricks_.y),
                    static_cast<GLuint>(bricks_.z));
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT);
  glUseProgram(index_.name());
  glDispatchCompute(groups(volumeOf(bricks_), kIndexGroup), 1, 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  atlas.contentsChanged(static_cast<float>(boundOf(box, mostMass)));
  checkGl("rebuilding the live grid");
}

std::vector<uint32_t> LiveGrid::readSums() const {
  std::vector<uint32_t> sums(volumeOf(box_.size));
  glGetNamedBufferSubData(sums_.name(), 0, static_cast<GLsizeiptr>(sums.size() * sizeof(uint32_t)),
                          sums.data());
  return sums;
}

}  // namespace nephele
