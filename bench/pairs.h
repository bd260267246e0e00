// The parts of nephele_ratios, one function each. Depends on ratios.h.
#pragma once

#include "bench/ratios.h"

namespace nephele::bench {

/// Noise against FastNoise2, one thread, the same SIMD level on both sides. Only where FastNoise2 was given.
void compareNoise(Table& table);

/// A fog ball of radius 256 voxels: its filling, and whole bakes with the file written.
void compareFogBall(Table& table);

/// A domain whose cloud fills 1% of it against the same domain filled, and the peak memory of bakes by the
/// program at `bakeProgram`.
void compareSparseness(Table& table);
void measurePeakMemory(Table& table, const std::string& bakeProgram);

/// Splatting against OpenVDB's FrustumRasterizer; ten million particles; time and memory as particles grow in
/// number.
void compareSplat(Table& table);

}  // namespace nephele::bench
