// Clouds of particles for tests of splatting, and what a splat holds once it is a file. Depends on splat,
// volume.
#pragma once

#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "bake/splat.h"
#include "volume/bricks.h"

namespace nephele::test {

inline constexpr SplatKernel kKernels[] = {SplatKernel::gaussian, SplatKernel::wendland,
                                           SplatKernel::smoothSphere};

struct Cloud {
  std::vector<float> x, y, z, radius, mass, vx, vy, vz, temperature, age;
  std::vector<uint32_t> id;

  void add(glm::vec3 p, float r, float m, glm::vec3 v = glm::vec3(0.0f)) {
    x.push_back(p.x), y.push_back(p.y), z.push_back(p.z), radius.push_back(r), mass.push_back(m);
    vx.push_back(v.x), vy.push_back(v.y), vz.push_back(v.z);
    temperature.push_back(float(id.size() % 7));
    age.push_back(0.25f);
    id.push_back(uint32_t(id.size()));
  }
  SplatParticles particles() const { return {x, y, z, radius, mass, vx, vy, vz, temperature, age, id}; }
  double total() const {
    double sum = 0.0;
    for (const float m : mass) sum += double(m);
    return sum;
  }
};

inline Cloud randomCloud(int count, float spread, float least, float most, uint32_t state = 11) {
  Cloud cloud;
  const auto next = [&] { return motion::nextUniform(state); };
  for (int n = 0; n < count; ++n) {
    const glm::vec3 p = spread * (2.0f * glm::vec3(next(), next(), next()) - 1.0f);
    cloud.add(p, least * std::pow(most / least, next()), 0.5f + next(),
              2.0f * glm::vec3(next(), next(), next()) - 1.0f);
  }
  return cloud;
}

inline SplatSettings plain(SplatKernel kernel = SplatKernel::wendland) {
  SplatSettings settings;
  settings.voxelSize = 1.0;
  settings.kernel = kernel;
  settings.cutoff = 0.0;
  settings.half = false;
  return settings;
}

inline BrickVolume stored(const Splatted& splatted) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("nephele_splat_test_" + std::to_string(::getpid()) + ".vdb"))
          .string();
  writeSplatted(path, splatted, Provenance{});
  BrickVolume bricks = loadBricks(path);
  std::filesystem::remove(path);
  return bricks;
}

}  // namespace nephele::test
