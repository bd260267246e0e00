// Bricks and light cache as textures, and how the shared walk reads them. Included after the parameters.
layout(binding = 0) uniform sampler3D atlas;       // bricks of 9³ samples, or half as many along an axis
layout(binding = 1) uniform usampler2D brickIndex; // words of volume/brick_layout.h, x fastest, in rows of the texture's width
layout(binding = 2) uniform usampler2D blockIndex; // of the light cache's blocks, likewise
layout(binding = 3) uniform sampler3D columnCache;
layout(binding = 5) uniform sampler3D skyCache;    // parts beside each other along z

// Whether bricks are of several levels.
#ifndef NPH_LEVELS
#define NPH_LEVELS false
#endif

// Whether the atlas's texels are shares of their brick's bound.
#ifndef NPH_SCALED
#define NPH_SCALED false
#endif

// Of walk.glsl.
ivec3 wordCorner(uvec2 word);
ivec3 wordSamples(uvec2 word);
vec3 keptPosition(uvec2 word, vec3 position);
float wordMaximum(uvec2 word);

uvec4 wordAt(usampler2D index, ivec3 count, ivec3 at) {
  int i = (at.z * count.y + at.y) * count.x + at.x;
  int width = textureSize(index, 0).x;  // a power of two
  return texelFetch(index, ivec2(i & (width - 1), i >> findMSB(width)), 0);
}

uvec2 brickWord(ivec3 brick) { return wordAt(brickIndex, params.brickCount.xyz, brick).rg; }
// Whether what is skipped is read after all: see walk.glsl.
#ifndef NPH_CHECK
#define NPH_CHECK 0
#endif
#if NPH_CHECK
layout(binding = 12) uniform usampler2D storedIndex;  // as brickIndex, of the bricks that are stored alone
uvec2 storedWord(ivec3 brick) { return wordAt(storedIndex, params.brickCount.xyz, brick).rg; }
#else
uvec2 storedWord(ivec3 brick) { return brickWord(brick); }
#endif
uint blockWord(ivec3 block) { return wordAt(blockIndex, params.blockCount.xyz, block).r; }

#if NPH_FILTER_EXACT
vec4 mixedFetch(sampler3D volume, ivec3 t, vec3 f) {
  vec4 s000 = texelFetch(volume, t, 0);
  vec4 s100 = texelFetch(volume, t + ivec3(1, 0, 0), 0);
  vec4 s010 = texelFetch(volume, t + ivec3(0, 1, 0), 0);
  vec4 s110 = texelFetch(volume, t + ivec3(1, 1, 0), 0);
  vec4 s001 = texelFetch(volume, t + ivec3(0, 0, 1), 0);
  vec4 s101 = texelFetch(volume, t + ivec3(1, 0, 1), 0);
  vec4 s011 = texelFetch(volume, t + ivec3(0, 1, 1), 0);
  vec4 s111 = texelFetch(volume, t + ivec3(1, 1, 1), 0);
  vec4 y0 = mix(mix(s000, s100, f.x), mix(s010, s110, f.x), f.y);
  vec4 y1 = mix(mix(s001, s101, f.x), mix(s011, s111, f.x), f.y);
  return mix(y0, y1, f.z);
}

float brickValue(sampler3D bricks, uvec2 word, vec3 position) {
  vec3 kept = keptPosition(word, position);
  ivec3 cell = min(ivec3(kept), wordSamples(word) - 2);
  return mixedFetch(bricks, wordCorner(word) + cell, kept - vec3(cell)).r;
}

vec4 cacheFetch(sampler3D cache, vec3 texel) {
  ivec3 cell = min(ivec3(texel), textureSize(cache, 0) - 2);
  return mixedFetch(cache, cell, texel - vec3(cell));
}
#else
float brickValue(sampler3D bricks, uvec2 word, vec3 position) {
  // A texel's centre lies at its index plus a half.
  vec3 texel = vec3(wordCorner(word)) + keptPosition(word, position) + 0.5;
  return textureLod(bricks, texel / vec3(textureSize(bricks, 0)), 0.0).r;
}

vec4 cacheFetch(sampler3D cache, vec3 texel) {
  return textureLod(cache, (texel + 0.5) / vec3(textureSize(cache, 0)), 0.0);
}
#endif

float wordScale(uvec2 word) { return NPH_SCALED ? wordMaximum(word) : 1.0; }

float brickDensity(uvec2 word, vec3 position) { return brickValue(atlas, word, position) * wordScale(word); }

float brickSample(uvec2 word, ivec3 place) {
  ivec3 kept = ivec3(keptPosition(word, vec3(place)));
  return texelFetch(atlas, wordCorner(word) + kept, 0).r * wordScale(word);
}

float cachedColumn(vec3 texel) { return cacheFetch(columnCache, texel).r; }

vec4 cachedSky(int part, vec3 texel) {
  return cacheFetch(skyCache, texel + vec3(0.0, 0.0, part * (textureSize(skyCache, 0).z / max(params.skySize.z, 1))));
}
