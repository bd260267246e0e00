// Filling the light cache piece by piece. Depends on what its header names.
#include "preview/gpu/light_cache.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstring>
#include <iterator>
#include <limits>
#include <utility>

namespace nephele {
namespace {

using Clock = std::chrono::steady_clock;
using shared::MarchParameters;

// As shaders/light_cache.comp declares them.
constexpr GLuint kBlocksBinding = 1, kCostBinding = 2, kColumnsImage = 0, kSkyImage = 1;
constexpr GLint kFirstBlockLocation = 0, kLightLocation = 1;
constexpr int kGroupSize = 32;
constexpr int kSky = -1;
constexpr double kPieceSeconds = 0.02;
constexpr uint32_t kFirstPieceBlocks = 64;

struct TexelFormat {
  GLenum name;
  uint64_t bytes;  // of a texel
};
/// `kind` as MarchParameters::cache.x.
TexelFormat columnFormat(bool floats, float kind) {
  if (floats) return {GL_R32F, 4};
  return kind == shared::kColumnsInBytes ? TexelFormat{GL_R8, 1} : TexelFormat{GL_R16F, 2};
}
TexelFormat skyFormat(bool floats) {
  return floats ? TexelFormat{GL_RGBA32F, 16} : TexelFormat{GL_RGB10_A2, 4};
}

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

template <class T>
bool same(const T& a, const T& b) {
  return std::memcmp(&a, &b, sizeof(T)) == 0;
}

bool sameShape(const MarchParameters& a, const MarchParameters& b) {
  return same(a.cacheShape, b.cacheShape) && a.skySize.z == b.skySize.z && a.counts.x == b.counts.x &&
         a.blockCount.w == b.blockCount.w;
}

bool sameColumns(const MarchParameters& a, const MarchParameters& b, size_t light) {
  return same(a.lights[light].direction, b.lights[light].direction) &&
         same(a.lights[light].directionIndex, b.lights[light].directionIndex) &&
         same(a.cacheSteps, b.cacheSteps) && same(a.shadow.w, b.shadow.w) && same(a.cache.x, b.cache.x) &&
         same(a.cache.y, b.cache.y);
}

/// Everything but the camera, the lights, the view's steps, the seed and the stage; without a sky, openness
/// alone is kept, which knows no orders.
bool sameSky(MarchParameters a, MarchParameters b) {
  for (MarchParameters* p : {&a, &b}) {
    std::memset(static_cast<void*>(p), 0, offsetof(MarchParameters, worldFromIndexX));
    std::memset(static_cast<void*>(&p->stage), 0, sizeof *p - offsetof(MarchParameters, stage));
    std::memset(static_cast<void*>(p->lights), 0, sizeof p->lights);
    p->sigmaS.w = p->environment.w = 0.0f;
    p->shadow = glm::vec4(0.0f, 0.0f, 0.0f, p->shadow.w);
    p->walk = p->cache = glm::vec4(0.0f);
    p->counts.x = p->counts.w = p->brickCount.w = p->skySize.w = 0;
    if (static_cast<int>(p->skyUp.w) != shared::kSkyNone) continue;
    p->octaves = p->phase = p->skyOpen = glm::vec4(0.0f);
    p->counts.y = 0;
  }
  return same(a, b);
}

bool asksColumns(const MarchParameters& p) { return p.cache.x > 0.0f && p.counts.x > 0; }
bool asksSky(const MarchParameters& p) { return p.cacheShape.y > 0; }

}  // namespace

LightCache::LightCache(Filter filter, const std::vector<TextChange>& changes)
    : floats_(filter == Filter::exact), changes_(changes), cost_(makeBuffer()) {
  const std::array<uint32_t, 3> zeros{};
  glNamedBufferStorage(cost_.name(), sizeof zeros, zeros.data(), GL_DYNAMIC_STORAGE_BIT);
}

const GlProgram& LightCache::programFor(const MarchParameters& parameters) {
  const auto flag = [](const char* name, bool on) { return std::string(name) + (on ? " true" : " false"); };
  const std::vector<std::string> defines = {
      floats_ ? "NPH_FILTER_EXACT 1" : "NPH_FILTER_EXACT 0",
      floats_ ? "NPH_CACHE_FLOAT 1" : "NPH_CACHE_FLOAT 0",
      columnKind_ == shared::kColumnsInBytes ? "NPH_COLUMN_BYTES 1" : "NPH_COLUMN_BYTES 0",
      flag("NPH_SCALED", parameters.counts.z != 0),
      flag("NPH_LEVELS", parameters.cacheShape.w != 0),
      parameters.blockCount.w != 0 ? "NPH_CHECK 1" : "NPH_CHECK 0"};
  GlProgram& program = programs_[defines];
  if (program.name() == 0) program = buildComputeProgram("light_cache.comp", defines, changes_);
  return program;
}

uint64_t LightCache::blockBytes(Filter filter, const MarchParameters& parameters) {
  const bool floats = filter == Filter::exact;
  const auto cube = [](int samples) { return static_cast<uint64_t>(samples * samples * samples); };
  constexpr uint64_t kIndexBytes = sizeof(uint32_t) + sizeof(glm::ivec4);
  const uint64_t columns = parameters.cache.x > 0.0f
                               ? cube(parameters.cacheShape.x) * static_cast<uint64_t>(parameters.counts.x)
                               : 0;
  return kIndexBytes + columnFormat(floats, parameters.cache.x).bytes * columns +
         skyFormat(floats).bytes * cube(parameters.cacheShape.y) *
             static_cast<uint64_t>(parameters.skySize.z);
}

void LightCache::shape(const BrickAtlas& atlas, const MarchParameters& parameters) {
  const BrickLayout& layout = atlas.layout();
  gpuBytes_ = sizeof(std::array<uint32_t, 3>);
  blockTotal_ = static_cast<uint32_t>(layout.blocks.size());
  blockIndex_ = makeIndexTexture(layout.blockWords, 1, gpuBytes_);
  std::vector<glm::ivec4> blocks;
  for (const glm::ivec3& block : layout.blocks) blocks.emplace_back(block, 0);
  blocks_ = makeBuffer();
  const size_t listBytes = std::max<size_t>(1, blocks.size()) * sizeof(glm::ivec4);
  glNamedBufferStorage(blocks_.name(), static_cast<GLsizeiptr>(listBytes),
                       blocks.empty() ? nullptr : blocks.data(), 0);
  gpuBytes_ += listBytes;
  const auto make = [&](int samples, int layers, const TexelFormat& format, GLenum channels) {
    GlTexture texture = makeTexture(GL_TEXTURE_3D);
    const glm::ivec3 size = layout.blockPlaces * samples * glm::ivec3(1, 1, layers);
    glTextureStorage3D(texture.name(), 1, format.name, size.x, size.y, size.z);
    setVolumeFilter(texture.name(), atlas.filter());
    glClearTexImage(texture.name(), 0, channels, GL_FLOAT, nullptr);
    gpuBytes_ += format.bytes * static_cast<uint64_t>(size.x) * static_cast<uint64_t>(size.y) *
                 static_cast<uint64_t>(size.z);
    return texture;
  };
  constexpr int kUnused = 2;  // samples along the edge of what is bound and never read
  const bool columns = asksColumns(parameters);
  columnKind_ = columns ? parameters.cache.x : 0.0f;
  columns_ = make(columns ? parameters.cacheShape.x : kUnused, columns ? parameters.counts.x : 1,
                  columnFormat(floats_, columnKind_), GL_RED);
  const bool sky = asksSky(parameters);
  sky_ = make(sky ? parameters.cacheShape.y : kUnused, std::max(parameters.skySize.z, 1), skyFormat(floats_),
              GL_RGBA);
  checkGl("making the light cache");
}

void LightCache::findTasks(const MarchParameters& parameters) {
  const auto begin = [&](int light) {
    for (Task& task : tasks_) {
      if (task.light != light) continue;
      task.left = blockTotal_;
      return;
    }
    tasks_.push_back({light, blockTotal_, 0});
  };
  if (asksColumns(parameters)) {
    for (int i = 0; i < parameters.counts.x; ++i)
      if (!columnsOf_ || !sameColumns(*columnsOf_, parameters, static_cast<size_t>(i))) begin(i);
    columnsOf_ = parameters;
  }
  if (asksSky(parameters)) {
    if (!skyOf_ || !sameSky(*skyOf_, parameters)) begin(kSky);
    skyOf_ = parameters;
  }
}

void LightCache::fill(const BrickAtlas& atlas, Task& task, uint32_t blocks) {
  atlas.bind();
  if (known_->blockCount.w != 0) atlas.bindStored();
  glUseProgram(programFor(*known_).name());
  glBindTextureUnit(2, blockIndex_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBlocksBinding, blocks_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kCostBinding, cost_.name());
  glBindImageTexture(kColumnsImage, columns_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY,
                     columnFormat(floats_, columnKind_).name);
  glBindImageTexture(kSkyImage, sky_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, skyFormat(floats_).name);
  glUniform1ui(kFirstBlockLocation, task.nextBlock);
  glUniform1i(kLightLocation, task.light);
  const int samples = task.light == kSky ? known_->cacheShape.y : known_->cacheShape.x;
  const int perBlock = samples * samples * samples;
  glDispatchCompute(blocks, static_cast<GLuint>((perBlock + kGroupSize - 1) / kGroupSize), 1);
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
  task.left -= blocks;
  task.nextBlock = (task.nextBlock + blocks) % blockTotal_;
}

bool LightCache::plan(const BrickAtlas& atlas, const MarchParameters& parameters) {
  // What was asked for once stays: between moving and resting pictures the shape does not change.
  MarchParameters shaped = parameters;
  if (known_ && !asksSky(parameters)) {
    shaped.skySize.z = known_->skySize.z;
    shaped.cacheShape.y = known_->cacheShape.y;
  }
  const bool lacksColumns = asksColumns(parameters) && columnKind_ != parameters.cache.x;
  const bool anew = atlasSerial_ != atlas.serial() || !known_ || lacksColumns || !sameShape(*known_, shaped);
  if (anew) {
    tasks_.clear();
    shaped = parameters;
    shape(atlas, parameters);
    atlasSerial_ = atlas.serial();
  }
  if (std::exchange(atlasContents_, atlas.contents()) != atlas.contents() || anew) {
    columnsOf_.reset();
    skyOf_.reset();
  }
  findTasks(parameters);
  if (blockTotal_ == 0) tasks_.clear();
  known_ = shaped;
  return anew;
}

std::vector<LightCache::Task>::iterator LightCache::nextTask(const MarchParameters& parameters) {
  return std::find_if(tasks_.begin(), tasks_.end(), [&](const Task& task) {
    return task.light == kSky ? asksSky(parameters) : asksColumns(parameters);
  });
}

void LightCache::begin(const BrickAtlas& atlas, const MarchParameters& parameters) {
  bare_ = plan(atlas, parameters) || bare_;
  const auto task = nextTask(parameters);
  if (task == tasks_.end()) return;
  fill(atlas, *task, 1);
  finishGl("compiling the light cache");
  if (task->left == 0) tasks_.erase(task);
}

bool LightCache::update(const BrickAtlas& atlas, const MarchParameters& parameters, double seconds) {
  bare_ = plan(atlas, parameters) || bare_;
  if (bare_) seconds = std::numeric_limits<double>::infinity();  // nothing could be shown meanwhile
  const auto start = Clock::now();
  auto task = nextTask(parameters);
  while (task != tasks_.end()) {
    const uint32_t left = std::min(task->left, blockTotal_ - task->nextBlock);
    const auto pieceStart = Clock::now();
    const double wanted = std::min(kPieceSeconds, seconds) * blocksPerSecond_;
    const uint32_t blocks = std::min(left, std::max(kFirstPieceBlocks, static_cast<uint32_t>(wanted)));
    fill(atlas, *task, blocks);
    finishGl("filling the light cache");
    blocksPerSecond_ = blocks / std::max(secondsSince(pieceStart), 1e-6);  // 1e-6 s: a clock may stand still
    if (task->left == 0) {
      tasks_.erase(task);
      task = nextTask(parameters);
    }
    if (secondsSince(start) >= seconds) break;
  }
  const bool right = task == tasks_.end();
  bare_ = bare_ && !right;
  return right;
}

void LightCache::bind() const {
  glBindTextureUnit(2, blockIndex_.name());
  glBindTextureUnit(3, columns_.name());
  constexpr GLuint kSkyUnit = 5;
  glBindTextureUnit(kSkyUnit, sky_.name());
}

double LightCache::takeDensitiesRead() {
  uint32_t read = 0;
  glGetNamedBufferSubData(cost_.name(), 0, sizeof read, &read);
  const uint32_t zero = 0;
  glNamedBufferSubData(cost_.name(), 0, sizeof zero, &zero);
  return read;
}

SkipCheck LightCache::takeSkipCheck() { return nephele::takeSkipCheck(cost_, sizeof(uint32_t)); }

SkipCheck takeSkipCheck(const GlBuffer& counts, GLintptr offset) {
  std::array<uint32_t, 2> values{};
  glGetNamedBufferSubData(counts.name(), offset, sizeof values, values.data());
  const SkipCheck check{static_cast<double>(values[0]), static_cast<double>(values[1])};
  values = {};
  glNamedBufferSubData(counts.name(), offset, sizeof values, values.data());
  return check;
}

}  // namespace nephele
