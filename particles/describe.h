// Every key of a particle system, once: reading, writing and a panel are visitors of these functions. A
// visitor has number, vector, integer, flag, text, choice, curve, words, map and list. Depends on
// particles.h.
#pragma once

#include "particles/particles.h"

namespace nephele {

// Ends of ranges. Times, sizes and speeds beyond them are typing errors, and keep every float finite.
inline constexpr double kLargestLength = 1e9;
inline constexpr Range kLengthRange{-kLargestLength, kLargestLength};
inline constexpr Range kPositiveLength{0.0, kLargestLength, true};
inline constexpr Range kFromZero{0.0, kLargestLength};
inline constexpr Range kTurnRange{-1e4, 1e4};  // radians per second
inline constexpr Range kSeedRange{-2147483648.0, 4294967295.0};

template <class Visitor>
void describe(Visitor& v, Emitter& e) {
  v.choice("shape", e.shape, {"point", "sphere", "box", "disc", "mesh", "points"});
  v.vector("center", e.center, kLengthRange, "world units");
  v.number("radius", e.radius, kPositiveLength, "world units, of sphere and disc");
  v.vector("half_size", e.halfSize, kPositiveLength, "world units, of the box");
  v.vector("axis", e.axis, kLengthRange, "of the disc");
  v.text("file", e.file);
  v.number("scale", e.scale, kPositiveLength, "world units for one unit of the file");
  v.flag("surface", e.surface);
  v.curve("rate", e.rate, kFromZero, "particles per second");
  v.curve("bursts", e.bursts, kFromZero, "time, count");
  v.vector("velocity", e.velocity, kLengthRange, "world units per second");
  v.number("outward", e.outward, kLengthRange, "world units per second");
  v.number("spread", e.spread, kFromZero, "world units per second");
  v.number("particle_radius", e.particleRadius, kPositiveLength, "world units");
  v.number("radius_variation", e.radiusVariation, kUnit, "");
  v.number("density", e.density, kFromZero, "mean over the particle's ball");
  v.number("density_variation", e.densityVariation, kUnit, "");
  v.number("life", e.life, kPositiveLength, "seconds");
  v.number("life_variation", e.lifeVariation, Range{0.0, 1.0, false, true}, "");
  v.number("temperature", e.temperature, kLengthRange, "");
  v.integer("seed", e.seed, kSeedRange);
}

template <class Visitor>
void describe(Visitor& v, Vortex& x) {
  v.vector("center", x.center, kLengthRange, "world units");
  v.vector("axis", x.axis, kLengthRange, "");
  v.number("rate", x.rate, kTurnRange, "radians per second");
  v.number("radius", x.radius, kPositiveLength, "world units");
}

template <class Visitor>
void describe(Visitor& v, Attractor& x) {
  v.vector("center", x.center, kLengthRange, "world units");
  v.number("strength", x.strength, kLengthRange, "1/s²");
  v.number("radius", x.radius, kPositiveLength, "world units");
}

template <class Visitor>
void describe(Visitor& v, Forces& f) {
  v.vector("gravity", f.gravity, kLengthRange, "world units per second²");
  v.vector("wind", f.wind, kLengthRange, "world units per second");
  v.number("drag", f.drag, kFromZero, "1/s");
  v.number("buoyancy", f.buoyancy, kLengthRange, "world units per second² and unit of temperature");
  v.number("cooling", f.cooling, kFromZero, "1/s");
  v.map("curl_noise", [&](auto& in) {
    in.number("speed", f.curlSpeed, kFromZero, "world units per second, root mean square");
    in.number("cell_size", f.curlCellSize, kPositiveLength, "world units");
    in.integer("octaves", f.curlOctaves, Range{1.0, 8.0});
    in.number("gain", f.curlGain, kUnit, "");
    in.vector("scroll", f.curlScroll, Range{-1e4, 1e4}, "cells per second");
    in.integer("seed", f.curlSeed, kSeedRange);
  });
  v.map("neighbours", [&](auto& in) {
    in.number("radius", f.neighbourReach, kFromZero, "world units");
    in.number("cohesion", f.cohesion, kFromZero, "1/s²");
    in.number("separation", f.separation, kFromZero, "world units per second²");
  });
  v.map("ground", [&](auto& in) {
    f.ground = in.given(f.ground);
    in.number("height", f.groundHeight, kLengthRange, "world units");
    in.number("bounce", f.bounce, kUnit, "share of the speed");
    in.number("friction", f.friction, kUnit, "share of the sliding speed");
  });
  v.list("vortices", f.vortices, size_t(motion::kMaxVortices));
  v.list("attractors", f.attractors, size_t(motion::kMaxAttractors));
}

template <class Visitor>
void describe(Visitor& v, ParticleSystem& s) {
  v.list("emitters", s.emitters, 16);  // an id keeps 4 bits for its emitter
  v.map("forces", [&](auto& in) { describe(in, s.forces); });
  v.curve("size_over_life", s.sizeOverLife, kPositiveLength, "share of the life, factor");
  v.curve("density_over_life", s.densityOverLife, kFromZero, "share of the life, factor");
  v.integer("substeps", s.substeps, Range{1.0, 1000.0});
  v.integer("prewarm", s.prewarm, Range{0.0, 1e6});
  v.choice("kernel", s.kernel, {"gaussian", "wendland", "smooth_sphere"});
  v.number("shutter", s.shutter, Range{0.0, 100.0}, "frames");
  v.map("erosion", [&](auto& in) {
    in.number("amount", s.erosion, kFromZero, "radii");
    in.node("field", s.erosionField);
  });
  v.words("grids", s.grids, {"vel", "temperature", "age"});
  v.words("write_points", s.writePoints, {"csv", "ply", "vdb"});
  v.number("mass_tolerance", s.massTolerance, kFromZero, "");
  v.map("box", [&](auto& in) {
    in.vector("min", s.boxMin, kLengthRange, "world units");
    in.vector("max", s.boxMax, kLengthRange, "world units");
  });
  v.flag("stable_box", s.stableBox);
  v.integer("checkpoint_every", s.checkpointEvery, Range{0.0, 1e6});
}

}  // namespace nephele
