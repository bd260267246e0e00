// Which bricks of which level a picture needs: the coarsest whose voxels it cannot tell apart. Depends on
// volume/brick_levels.h; no OpenVDB and no GL.
#pragma once

#include <optional>
#include <vector>

#include "volume/brick_levels.h"

namespace nephele {

/// How finely a picture tells voxels apart.
struct Resolution {
  glm::dvec3 eye{0.0};           // index space of the finest level
  double pixelsPerRadian = 0.0;  // a length l at distance d covers l/d times so many pixels
  double pixels = 1.0;           // voxels that cover at most so many need be no finer; 0: all may be seen
};

/// The part of space that an index covers, and the medium in it, in bricks and voxels of a level.
struct IndexFrame {
  int level = 0;  // voxels are 2^level of the finest's
  glm::ivec3 brickMin{0}, brickCount{0};
  glm::ivec3 boxMin{0}, boxMax{0};  // support of the medium, closed; equal where there is none
};
/// The frame of a volume's own index.
IndexFrame frameOf(const BrickVolume& volume, int level = 0);

/// How many voxels of the finest level, along their longest edge, `resolution.pixels` cover at the nearest
/// point of a box, which is given in such voxels; 0 where the eye is inside.
double voxelsAcross(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& low,
                    const glm::dvec3& high);

/// The coarsest level whose voxels cover at most `resolution.pixels` there. 0 where even that level's cover
/// more.
int levelFor(const Resolution& resolution, const glm::dmat4& worldFromIndex, const glm::dvec3& low,
             const glm::dvec3& high);

/// One brick of a cut: it stands for 2^rise bricks of the frame's level along each axis.
struct CutBrick {
  int rise = 0;
  glm::ivec3 brick{0};             // in bricks of its own level
  const float* samples = nullptr;  // its 729
};

/// Bricks of several levels that together cover the medium once.
struct Cut {
  IndexFrame frame;
  std::vector<CutBrick> bricks;
  int mostRise = 0;
};

/// Cuts a volume so that no brick is finer than the resolution asks for; without one, at level 0. The frame
/// is at the level of the finest brick, its corner a multiple of the coarsest one.
Cut cutFor(const BrickLevels& levels, const std::optional<Resolution>& resolution);

}  // namespace nephele
