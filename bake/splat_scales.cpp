// Sums of kernels, in parallel. Depends on splat_scales.h, splat_kernels.h, TBB.
#include "bake/splat_scales.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "bake/splat_kernels.h"

namespace nephele {
namespace {

struct Scaler {
  const SplatParticles& particles;
  const SplatSettings& settings;
  const SplatPlaces& places;
  const SplatSorter& sorter;
  SplatShaping& shaping;
  std::vector<float> scales;

  /// As if its kernel summed up to one.
  double densityOf(size_t n) const {
    return double(particles.mass[n]) / (settings.voxelSize * settings.voxelSize * settings.voxelSize);
  }
  bool isShaped(size_t n) const { return places.anyShaped() && places.frameOf(n).way == SplatWay::shaped; }

  void scaleShaped() {
    std::vector<double> own;
    std::vector<double>& sums = settings.measure ? settings.measure->sums : own;
    if (sums.empty()) findSums(sums);
    for (size_t n = 0; n < particles.size(); ++n) {
      if (!isShaped(n)) continue;
      // Where noise has eaten all of it, it is kept as a point.
      scales[n] = sums[n] > 0.0 ? float(densityOf(n) / sums[n]) : -float(densityOf(n));
    }
  }

  /// Of the kernels of particles that are stretched or eroded.
  void findSums(std::vector<double>& sums) {
    if (!settings.measure) shaping.makeRoom();
    sums.assign(particles.size(), 0.0);
    tbb::parallel_for(size_t(0), particles.size(), [&](size_t n) {
      if (!isShaped(n)) return;
      sums[n] = settings.measure ? shaping.sumOfFewer(n, places) : shaping.sum(n, places.frameOf(n));
    });
  }

  void scaleOthers() {
    constexpr size_t kAtOnce = 256;
    tbb::parallel_for(size_t(0), (particles.size() + kAtOnce - 1) / kAtOnce, [&](size_t block) {
      const size_t begin = block * kAtOnce, end = std::min(particles.size(), begin + kAtOnce);
      SplatRecord records[kAtOnce]{};
      size_t owner[kAtOnce], count = 0;
      double sums[kAtOnce];
      for (size_t n = begin; n < end; ++n) {
        if (isShaped(n)) continue;
        const SplatRecord record = places.placeOf(n);
        scales[n] = float(densityOf(n));
        if (record.radius <= 1.0f || sorter.isSmall(record.radius)) continue;
        owner[count] = n;
        records[count++] = record;
      }
      splatSums(settings.kernel, records, count, sums);
      for (size_t k = 0; k < count; ++k) scales[owner[k]] = float(densityOf(owner[k]) / sums[k]);
    });
  }
};

}  // namespace

std::vector<float> splatScales(const SplatParticles& particles, const SplatSettings& settings,
                               const SplatPlaces& places, const SplatSorter& sorter, SplatShaping& shaping) {
  if (sorter.allSmall()) return {};
  Scaler scaler{particles, settings, places, sorter, shaping, std::vector<float>(particles.size())};
  if (places.anyShaped()) scaler.scaleShaped();
  scaler.scaleOthers();
  return std::move(scaler.scales);
}

}  // namespace nephele
