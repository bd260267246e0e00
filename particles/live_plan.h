// What a live simulation must know before it begins: slots that particles live in, the most mass there can
// be, the box that they move through, and what of a system is not simulated live. Depends on particles.h and
// simulation.h; no GL.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "particles/particles.h"
#include "particles/simulation.h"

namespace nephele {

/// More particles than this at a time are not simulated live.
inline constexpr uint64_t kMostLiveParticles = 1u << 20;

/// Slots that an emitter's particles take in turn.
struct SlotRing {
  uint32_t first = 0, count = 1;
  bool operator==(const SlotRing&) const = default;
};

/// One ring an emitter, so long that no particle's slot is needed again before it has died; `stepSeconds` is
/// a step's length. Throws SimulationError where that takes more than kMostLiveParticles in all, or an
/// emitter needs a file (meshes and points are read by the bake alone).
std::vector<SlotRing> slotRings(const ParticleSystem& system, double stepSeconds);

/// Mass, density · world units³, that all slots together cannot exceed at any age.
double mostMass(const ParticleSystem& system, const std::vector<SlotRing>& rings);

/// Sentences on what the system asks for and a live simulation leaves out; empty where there is nothing.
std::vector<std::string> leftOutLive(const ParticleSystem& system);

/// The box, world units, that some hundred of the particles came through in `frames` frames from `first` on,
/// grown by their radii; nullopt where none was alive. The system's own box where it has one. Throws
/// SimulationError as the simulation does.
struct MotionBox {
  glm::dvec3 low, high;
};
std::optional<MotionBox> motionBox(const ParticleSystem& system, const SimulationSettings& settings,
                                   int64_t frames);

}  // namespace nephele
