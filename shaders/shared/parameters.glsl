// Everything the march is told, in rows of 16 bytes: std140 on the GPU, memcpy on the CPU. Index space here is voxels
// relative to the corner of the brick grid, so that no world coordinate enters a shader.

NPH_CONST int kMaxLights = 8;
NPH_CONST int kLightSun = 0;
NPH_CONST int kLightPoint = 1;
NPH_CONST int kBlackbodyNodes = 128;

// What the light cache keeps columns in, in params.cache.x; 0: none are asked for.
NPH_CONST float kColumnsInHalves = 1.0f;
NPH_CONST float kColumnsInBytes = 2.0f;

// Parts of what the light cache keeps of all directions: even light and its slope; openness as well.
NPH_CONST int kSkyParts = 2;
NPH_CONST int kOpenParts = 3;

// Kinds of environment, in params.skyUp.w.
NPH_CONST int kSkyNone = 0;
NPH_CONST int kSkyConstant = 1;
NPH_CONST int kSkyRamp = 2;
NPH_CONST int kSkyMap = 3;

struct LightParameters {
  vec4 direction;       // sun: unit vector to the light, world axes. w: kind
  vec4 directionIndex;  // sun: the same in voxels per world unit. Point: its place in index space
  vec4 power;           // sun: irradiance on a plane facing it. Point: intensity
};

struct MarchParameters {
  // Picture position (x, y) in pixels from the top left corner → a ray: the origin lies on a plane in front of the
  // medium, the direction has length 1 along the camera's axis. Each is corner + x · dx + y · dy.
  vec4 originCorner;  // index space. w: distance from the camera to that plane, world units along the axis
  vec4 originDx;
  vec4 originDy;
  vec4 directionCorner;  // voxels per world unit along the axis
  vec4 directionDx;
  vec4 directionDy;
  vec4 rayCorner;  // the same direction in world axes and units
  vec4 rayDx;
  vec4 rayDy;
  vec4 worldFromIndexX;  // world displacement of one voxel along x, y, z
  vec4 worldFromIndexY;
  vec4 worldFromIndexZ;
  vec4 indexFromWorldX;  // index displacement of one world unit along x, y, z
  vec4 indexFromWorldY;
  vec4 indexFromWorldZ;
  vec4 boxMin;       // support of the medium, index space
  vec4 boxMax;
  vec4 sigmaT;       // per unit density per world unit
  vec4 sigmaS;       // w: step, voxels
  vec4 octaves;      // a, b, c, d
  vec4 shadow;       // x: first step towards a light, voxels. y: growth from each step to the next, at least 1. z: voxels of the
                     // index that count as one at least, for the view's steps; w: the same, for the light cache
  vec4 phase;        // the phase function's lobes: x: g of the first, y: of the second, z: share of the second
  vec4 powder;       // x: strength, 0: off. y: 1 / largest density
  vec4 height;       // of an index position in the cloud, 0 at its base, 1 at its top: dot(xyz, position) + w
  vec4 chordCentre;  // of the ellipsoid inscribed in the active box, index space. w: mean active density
  vec4 chordRadii;   // w: 1 where light transmittance is by the chord, else 0
  vec4 environment;  // radiance, if constant; of the ramp's zenith; factors of a map. w: smallest transmittance worth following
  vec4 skyHorizon;   // of the ramp. w: its power above
  vec4 skyGround;    // of the ramp. w: its power below
  vec4 skyUp;        // unit, world axes. w: kind, see environment.glsl
  vec4 skyRight;     // axes of a map
  vec4 skyForward;   // w: 1 where the picture holds the environment behind the medium, else 0
  ivec4 skySize;     // x, y: texels of a map. z: parts of the light cache's samples of all directions: 0, kSkyParts or
                     // kOpenParts. w: 1 where the sky is taken from them
  vec4 skyOpen;      // what a place that nothing shades scatters of the sky, mean over directions, per unit density, before σ_s
  vec4 walk;         // x: way into the next brick, voxels, that rounding may take. y: no sample exceeds it. z, w: optical
                     // depth of a step, of its variation over the brick, below which steps grow; z = 0: fixed steps
  vec4 cache;        // x: kColumns… where columns come from the light cache, else 0. y: what one stands for there, density · world units.
                     // z, w: way marched towards a light before the cache is asked, voxels, and its steps
  vec4 cacheSteps;   // first step, voxels, and growth of those that fill the cache: x, y for columns, z, w for the sky
  ivec4 cacheShape;  // x: samples along a block's edge, columns. y: the same, of all directions; 0: none. z: texels along z a light.
                     // w: 1 where bricks are of several levels
  ivec4 blockCount;  // blocks of the light cache along each axis. w: 1 where skips are checked
  ivec4 counts;      // x: lights. y: octaves beyond the first. z: 1 where samples are kept as shares of their
                     // brick's bound. w: 1 where steps start at random, 0 midway
  ivec4 brickCount;  // bricks along each axis. w: seed
  LightParameters lights[kMaxLights];
  vec4 emission;   // x: factor, 0: off. y: kelvin per unit of the temperatures' grid
  vec4 heatX;      // from index space to that grid's: each coordinate is dot(xyz, position) + w
  vec4 heatY;
  vec4 heatZ;
  ivec4 heatCount; // bricks of that grid along each axis
  vec4 blackbody[kBlackbodyNodes];  // what Planck's law at 610 nm leaves of Rec.709 radiance: see emission.glsl
  // The stage's places are in world axes and units from the brick grid's corner: see stage_shapes.glsl.
  vec4 stage;        // x: radius of the ball about the floor's centre that holds all, 0: no stage. y: sharpness of shadows, 0:
                     // hard. z: 1 with highlights. w: half the cloud's longest side
  vec4 stageFloor;   // centre of its upper side. w: its radius, 0: no floor
  vec4 stageUp;      // unit. w: edge of a square
  vec4 stageAcross;  // unit, level
  vec4 stageChrome;  // centre. w: radius, 0: none; so the next
  vec4 stageGrey;
  vec4 stageCube;    // w: half an edge
};
