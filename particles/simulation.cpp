// Births, steps and deaths of particles. Depends on simulation.h, neighbour_grid.h, TBB.
#include "particles/simulation.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "base/hash.h"
#include "particles/neighbour_grid.h"

namespace nephele {
namespace {

using motion::vec3;

constexpr uint32_t kEmitterShift = 28;  // of an id
constexpr uint64_t kMostBirths = uint64_t(1) << kEmitterShift;
// Particles of one task: long enough to pay for its scheduling.
constexpr size_t kGrain = 1024;
// Cells of a noise or of neighbours stay inside 32 bits.
constexpr double kMostCells = 1073741824.0;
// A neighbour adds up to kNeighbourUnit to sums of 31 bits.
constexpr size_t kMostNeighbours = 131000;

template <class Body>
void inParallel(size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, count, kGrain),
                    [&](const tbb::blocked_range<size_t>& range) {
                      for (size_t n = range.begin(); n < range.end(); ++n) body(n);
                    });
}

vec3 placeOf(const ParticleArrays& p, size_t n) { return {p.x[n], p.y[n], p.z[n]}; }
vec3 velocityOf(const ParticleArrays& p, size_t n) { return {p.vx[n], p.vy[n], p.vz[n]}; }
void setPlace(ParticleArrays& p, size_t n, const vec3& v) { p.x[n] = v.x, p.y[n] = v.y, p.z[n] = v.z; }
void setVelocity(ParticleArrays& p, size_t n, const vec3& v) { p.vx[n] = v.x, p.vy[n] = v.y, p.vz[n] = v.z; }

}  // namespace

double farthestOf(const ParticleSystem& system) {
  const Forces& f = system.forces;
  double farthest = kMostCells;
  if (f.curlSpeed > 0.0)
    farthest = std::min(farthest, kMostCells * f.curlCellSize / double(int64_t(1) << f.curlOctaves));
  if (f.neighbourReach > 0.0) farthest = std::min(farthest, kMostCells * f.neighbourReach);
  return farthest;
}

void ParticleArrays::resize(size_t count) {
  forEachFloats([count](std::vector<float>& array) { array.resize(count); });
  id.resize(count);
}

Simulation::Simulation(ParticleSystem system, std::vector<SiteSourcePtr> sources,
                       const SimulationSettings& settings)
    : system_(std::move(system)),
      sources_(std::move(sources)),
      motion_{parametersOf(system_, settings.upAxis, settings.seed)},
      dt_(1.0 / (settings.fps * double(system_.substeps))),
      farthest_(farthestOf(system_)),
      born_(system_.emitters.size(), 0) {
  for (size_t n = 0; n < system_.emitters.size(); ++n)
    emitters_.push_back(parametersOf(system_.emitters[n], n, settings.seed));
  emit(0.0, 0.0, true);
}

void Simulation::emitOne(size_t emitter, uint64_t number, double rest, double now, size_t at) {
  const uint32_t id = uint32_t(emitter << kEmitterShift) | uint32_t(number);
  motion::EmitterParameters parameters = emitters_[emitter];
  Site site;
  if (const SiteSourcePtr& source = sources_[emitter]) {
    const uint64_t count = source->count();
    site = source->site(count > 0 ? number % count : number, uint32_t(parameters.kind.z));
    if (site.radius) parameters.born.x = *site.radius;
    if (site.density) parameters.size.w = *site.density;
    if (site.life) parameters.motion.z = *site.life;
    if (site.temperature) parameters.velocity.w = *site.temperature;
  }
  motion::Motion::Particle p = motion_.emitParticle(parameters, id, site.position, site.normal);
  p.velocity += site.velocity;
  if (rest > 0.0)
    motion_.moveParticle(p.position, p.velocity, 0.0f, p.temperature, {}, float(now - rest), float(rest));
  setPlace(particles_, at, p.position);
  setVelocity(particles_, at, p.velocity);
  particles_.age[at] = float(rest);
  particles_.life[at] = p.life;
  particles_.radius[at] = p.radius;
  particles_.mass[at] = p.mass;
  particles_.temperature[at] = p.temperature;
  particles_.id[at] = id;
}

void Simulation::emit(double from, double to, bool first) {
  for (size_t e = 0; e < emitters_.size(); ++e) {
    uint64_t until = bornUntil(system_.emitters[e], to);
    // A file of points gives each of them once where nothing else is said.
    const Emitter& emitter = system_.emitters[e];
    if (sources_[e] && sources_[e]->count() > 0 && emitter.rate.empty() && emitter.bursts.empty())
      until = sources_[e]->count();
    if (until >= kMostBirths)
      throw SimulationError("an emitter gave birth to more than " + std::to_string(kMostBirths - 1) +
                            " particles");
    const uint64_t since = born_[e], count = until - since;
    const size_t start = particles_.size();
    if (start + count > kMostParticles)
      throw SimulationError(std::to_string(start + count) + " particles are alive at a time; at most " +
                            std::to_string(kMostParticles) + " are moved");
    particles_.resize(start + count);
    const double seconds = to - from;
    inParallel(count, [&](size_t n) {
      // Births are spread over the step, so that a jet has no gaps.
      const double rest = first ? 0.0 : seconds * (1.0 - (double(n) + 0.5) / double(count));
      emitOne(e, since + n, rest, to, start + n);
    });
    for (size_t n = start; n < particles_.size(); ++n) ledger_.emitted += double(particles_.mass[n]);
    ledger_.countEmitted += count;
    born_[e] = until;
  }
}

void Simulation::findNeighbours() {
  neighbours_.assign(particles_.size(), {});
  const float reach = float(system_.forces.neighbourReach);
  const NeighbourGrid grid(particles_.x, particles_.y, particles_.z, reach);
  inParallel(particles_.size(), [&](size_t i) {
    size_t seen = 0;
    const vec3 own = placeOf(particles_, i);
    grid.around(i, [&](size_t j) {
      if (++seen > kMostNeighbours)
        throw SimulationError("more than " + std::to_string(kMostNeighbours) +
                              " particles lie within reach of one; use a smaller 'radius' of 'neighbours'");
      motion_.addNeighbour(placeOf(particles_, j) - own, neighbours_[i]);
    });
  });
}

void Simulation::refuseRunaways() const {
  for (size_t n = 0; n < particles_.size(); ++n) {
    const vec3 p = placeOf(particles_, n), v = velocityOf(particles_, n);
    const bool near = std::abs(double(p.x)) <= farthest_ && std::abs(double(p.y)) <= farthest_ &&
                      std::abs(double(p.z)) <= farthest_;
    if (near && std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) continue;
    char text[200];
    std::snprintf(
        text, sizeof text,
        "particle %u of emitter %u came to (%.3g, %.3g, %.3g) after %.3g s; places are kept within %.3g",
        particles_.id[n] & uint32_t(kMostBirths - 1), particles_.id[n] >> kEmitterShift, double(p.x),
        double(p.y), double(p.z), double(steps_) * dt_, farthest_);
    throw SimulationError(text);
  }
}

void Simulation::removeDead() {
  size_t kept = 0;
  for (size_t n = 0; n < particles_.size(); ++n) {
    if (particles_.age[n] >= particles_.life[n]) {
      ledger_.died += double(particles_.mass[n]);
      ++ledger_.countDied;
      continue;
    }
    if (kept != n) {
      particles_.forEachFloats([&](std::vector<float>& array) { array[kept] = array[n]; });
      particles_.id[kept] = particles_.id[n];
    }
    ++kept;
  }
  particles_.resize(kept);
}

void Simulation::step() {
  refuseRunaways();
  const double now = double(steps_) * dt_;
  const bool social = system_.forces.neighbourReach > 0.0;
  if (social) findNeighbours();
  inParallel(particles_.size(), [&](size_t n) {
    vec3 position = placeOf(particles_, n), velocity = velocityOf(particles_, n);
    motion_.moveParticle(position, velocity, particles_.age[n], particles_.temperature[n],
                         social ? neighbours_[n] : motion::Motion::NeighbourSums{}, float(now), float(dt_));
    setPlace(particles_, n, position);
    setVelocity(particles_, n, velocity);
    particles_.age[n] += float(dt_);
  });
  ++steps_;
  emit(now, double(steps_) * dt_, false);
  removeDead();
  refuseRunaways();
}

ParticleView Simulation::view() const {
  ParticleView view;
  const size_t count = particles_.size();
  view.x = particles_.x;
  view.y = particles_.y;
  view.z = particles_.z;
  view.age = particles_.age;
  for (auto* array : {&view.vx, &view.vy, &view.vz, &view.radius, &view.mass, &view.temperature})
    array->resize(count);
  motion::ParticleParameters& p = motion_.particles;
  const float now = float(double(steps_) * dt_);
  inParallel(count, [&](size_t n) {
    const float share = particles_.age[n] / particles_.life[n];
    view.radius[n] = particles_.radius[n] * motion_.curveAt(p.sizeCurve, p.flags.y, share);
    view.mass[n] = particles_.mass[n] * motion_.curveAt(p.densityCurve, p.flags.z, share);
    view.temperature[n] = motion_.temperatureAt(particles_.temperature[n], particles_.age[n]);
    const vec3 seen = motion_.seenVelocity(placeOf(particles_, n), velocityOf(particles_, n), now);
    view.vx[n] = seen.x;
    view.vy[n] = seen.y;
    view.vz[n] = seen.z;
  });
  return view;
}

namespace {

constexpr std::string_view kStateMagic = "nephele particles 1\n";

template <class T>
void append(std::string& out, const T* values, size_t count) {
  out.append(reinterpret_cast<const char*>(values), count * sizeof(T));
}

/// Takes `count` values off the front of `rest`; false where there are fewer.
template <class T>
bool take(std::string_view& rest, T* values, size_t count) {
  if (count > rest.size() / sizeof(T)) return false;
  std::memcpy(values, rest.data(), count * sizeof(T));
  rest.remove_prefix(count * sizeof(T));
  return true;
}

std::string digestOf(std::string_view bytes) {
  Hasher hasher;
  hasher.text(bytes);
  return hasher.hex();
}

}  // namespace

std::string Simulation::save() const {
  ParticleArrays copy = particles_;
  std::string body;
  const uint64_t counts[] = {steps_, particles_.size(), born_.size(), ledger_.countEmitted,
                             ledger_.countDied};
  append(body, counts, std::size(counts));
  const double sums[] = {ledger_.emitted, ledger_.died};
  append(body, sums, std::size(sums));
  append(body, born_.data(), born_.size());
  copy.forEachFloats([&](const std::vector<float>& array) { append(body, array.data(), array.size()); });
  append(body, copy.id.data(), copy.id.size());
  return std::string(kStateMagic) + digestOf(body) + body;
}

bool Simulation::load(std::string_view bytes) {
  if (!bytes.starts_with(kStateMagic)) return false;
  bytes.remove_prefix(kStateMagic.size());
  constexpr size_t kDigest = 32;
  if (bytes.size() < kDigest || digestOf(bytes.substr(kDigest)) != bytes.substr(0, kDigest)) return false;
  bytes.remove_prefix(kDigest);
  uint64_t counts[5];
  double sums[2];
  if (!take(bytes, counts, std::size(counts)) || !take(bytes, sums, std::size(sums))) return false;
  // Twelve words a particle.
  if (counts[2] != born_.size() || bytes.size() != counts[1] * 12 * 4 + counts[2] * 8) return false;
  std::vector<uint64_t> born(born_.size());
  ParticleArrays particles;
  particles.resize(counts[1]);
  bool whole = take(bytes, born.data(), born.size());
  particles.forEachFloats(
      [&](std::vector<float>& array) { whole = whole && take(bytes, array.data(), array.size()); });
  whole = whole && take(bytes, particles.id.data(), particles.id.size());
  if (!whole) return false;
  steps_ = counts[0];
  ledger_ = {sums[0], sums[1], counts[3], counts[4]};
  born_ = std::move(born);
  particles_ = std::move(particles);
  return true;
}

}  // namespace nephele
