// The grid that live particles are splatted into: a box of the file's own lattice of voxels.
layout(std140, binding = 3) uniform GridBlock {
  vec4 gridCorner;   // world place of its first voxel's centre; w: voxels for one world unit
  ivec4 gridSize;    // voxels
  vec4 gridUnits;    // whole units for a mass of 1; density of one unit; shutter in voxels for a speed of 1; time
  ivec4 gridOffset;  // of the first brick's first sample from the grid's first voxel; voxels
  ivec4 gridBricks;  // along each axis
  vec4 gridBound;    // no density exceeds it
};
