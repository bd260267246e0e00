// Slots, births and steps on the GPU. Depends on gpu/live_motion.h.
#include "preview/gpu/live_motion.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace nephele {
namespace {

// As the shaders declare them.
enum Binding : GLuint { kSlots = 0, kStatus = 1, kNeighbours = 2, kBuckets = 3, kEntries = 4 };
enum Block : GLuint { kParameters = 1, kStep = 2 };
constexpr size_t kMostEmitters = 16;
constexpr uint32_t kGroup = 64;
constexpr int kNeighbourStages = 4;
// Bytes of a NeighbourSums and of a bucket.
constexpr uint64_t kSumsBytes = 32, kBucketBytes = 16;

struct LiveEmitter {
  motion::EmitterParameters emitter;
  glm::uvec4 ring;
};
struct StepBlock {
  LiveEmitter emitters[kMostEmitters];
  glm::ivec4 counts;
  glm::vec4 times;
};

GlBuffer storage(uint64_t bytes) {
  GlBuffer buffer = makeBuffer();
  glNamedBufferStorage(buffer.name(), static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_STORAGE_BIT);
  return buffer;
}

void clear(const GlBuffer& buffer) {
  glClearNamedBufferData(buffer.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
}

void dispatchOver(const GlProgram& program, uint32_t count) {
  glUseProgram(program.name());
  glDispatchCompute((count + kGroup - 1) / kGroup, 1, 1);
  glMemoryBarrier(GL_SHADER_STORAGE_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT);
}

}  // namespace

LiveMotion::LiveMotion(const ParticleSystem& system, const SimulationSettings& settings,
                       const std::vector<TextChange>& changes)
    : system_(system),
      settings_(settings),
      dt_(1.0 / (settings.fps * static_cast<double>(system.substeps))),
      rings_(slotRings(system, dt_)),
      move_(buildComputeProgram("particles_move.comp", {"NPH_NEIGHBOURS 0"}, changes)),
      moveAmong_(buildComputeProgram("particles_move.comp", {"NPH_NEIGHBOURS 1"}, changes)),
      status_(storage(sizeof(glm::uvec4))),
      parameters_(storage(sizeof(motion::ParticleParameters))),
      step_(storage(sizeof(StepBlock))) {
  for (int stage = 0; stage < kNeighbourStages; ++stage)
    neighbourStages_.push_back(
        buildComputeProgram("particles_neighbours.comp", {"NPH_STAGE " + std::to_string(stage)}, changes));
  reset();
}

bool LiveMotion::setSystem(const ParticleSystem& system) {
  const double dt = 1.0 / (settings_.fps * static_cast<double>(system.substeps));
  std::vector<SlotRing> rings = slotRings(system, dt);
  // Births so far must be those of the new rates too, or numbers would be left out or given twice.
  bool same = rings == rings_ && dt == dt_;
  for (size_t n = 0; same && n < rings.size(); ++n)
    same = bornUntil(system.emitters[n], seconds()) == born_[n];
  system_ = system;
  rings_ = std::move(rings);
  dt_ = dt;
  if (same)
    upload();
  else
    reset();
  return !same;
}

void LiveMotion::allocate() {
  slotCount_ = rings_.empty() ? 0 : rings_.back().first + rings_.back().count;
  const uint64_t slots = std::max<uint64_t>(slotCount_, 1);
  slots_ = storage(slots * sizeof(LiveParticle));
  bucketCount_ = seesNeighbours() ? std::bit_ceil(slotCount_ + 1) : 1;
  const uint64_t social = seesNeighbours() ? slots : 1;
  neighbours_ = storage(social * kSumsBytes);
  entries_ = storage(social * sizeof(uint32_t));
  buckets_ = storage((uint64_t{bucketCount_} + 1) * kBucketBytes);
  checkGl("making room for " + std::to_string(slotCount_) + " live particles");
}

void LiveMotion::upload() {
  const motion::ParticleParameters p = parametersOf(system_, settings_.upAxis, settings_.seed);
  glNamedBufferSubData(parameters_.name(), 0, sizeof p, &p);
  const bool room = bucketCount_ > 1;
  if (room != seesNeighbours()) allocate();
}

void LiveMotion::reset() {
  allocate();
  upload();
  clear(slots_);
  clear(status_);
  steps_ = 0;
  born_.assign(rings_.size(), 0);
  dispatch(0.0, 0.0, true);
}

void LiveMotion::dispatch(double from, double to, bool first) {
  StepBlock block{};
  for (size_t n = 0; n < rings_.size(); ++n) {
    const uint64_t until = bornUntil(system_.emitters[n], to);
    block.emitters[n] = {
        parametersOf(system_.emitters[n], n, settings_.seed),
        {rings_[n].first, rings_[n].count, static_cast<uint32_t>(born_[n]), static_cast<uint32_t>(until)}};
    born_[n] = until;
  }
  block.counts = {static_cast<int>(rings_.size()), static_cast<int>(slotCount_), first ? 1 : 0, 0};
  block.times = {static_cast<float>(from), static_cast<float>(to - from), static_cast<float>(to),
                 static_cast<float>(farthestOf(system_))};
  glNamedBufferSubData(step_.name(), 0, sizeof block, &block);
  bind();
  if (seesNeighbours() && !first) findNeighbours();
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kNeighbours, neighbours_.name());
  dispatchOver(seesNeighbours() && !first ? moveAmong_ : move_, slotCount_);
  checkGl("moving live particles");
}

void LiveMotion::findNeighbours() const {
  clear(buckets_);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kNeighbours, neighbours_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kBuckets, buckets_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kEntries, entries_.name());
  for (size_t stage = 0; stage < neighbourStages_.size(); ++stage)
    dispatchOver(neighbourStages_[stage], stage == 1 ? bucketCount_ : slotCount_);
}

void LiveMotion::step() {
  const double now = seconds();
  ++steps_;
  dispatch(now, seconds(), false);
}

void LiveMotion::bind() const {
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSlots, slots_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kStatus, status_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameters, parameters_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kStep, step_.name());
}

void LiveMotion::clearCount() const {
  const uint32_t zero = 0;
  glNamedBufferSubData(status_.name(), 0, sizeof zero, &zero);
}

uint64_t LiveMotion::gpuBytes() const {
  const uint64_t social = seesNeighbours() ? slotCount_ * (kSumsBytes + sizeof(uint32_t)) : 0;
  return slotCount_ * sizeof(LiveParticle) + social + (uint64_t{bucketCount_} + 1) * kBucketBytes +
         sizeof(StepBlock) + sizeof(motion::ParticleParameters) + sizeof(glm::uvec4);
}

LiveStatus LiveMotion::status() const {
  glm::uvec4 words{0};
  glGetNamedBufferSubData(status_.name(), 0, sizeof words, &words);
  return {words.x, words.y, words.z};
}

std::vector<LiveParticle> LiveMotion::read() const {
  std::vector<LiveParticle> particles(slotCount_);
  if (slotCount_ > 0)
    glGetNamedBufferSubData(slots_.name(), 0, static_cast<GLsizeiptr>(slotCount_ * sizeof(LiveParticle)),
                            particles.data());
  return particles;
}

std::optional<uint64_t> LiveMotion::birthOf(size_t emitter, uint32_t slot) const {
  const uint64_t at = slot - rings_[emitter].first, born = born_[emitter];
  if (born <= at) return std::nullopt;
  const uint64_t last = born - 1;
  return last - (last - at) % rings_[emitter].count;
}

void LiveMotion::place(const std::vector<LiveParticle>& particles) {
  NEPHELE_CHECK_LE(particles.size(), size_t{slotCount_});
  clear(slots_);
  glNamedBufferSubData(slots_.name(), 0, static_cast<GLsizeiptr>(particles.size() * sizeof(LiveParticle)),
                       particles.data());
}

}  // namespace nephele
