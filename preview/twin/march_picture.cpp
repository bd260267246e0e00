// The brick arrays as the march's source of densities and cached light, read with explicit mixes in the order
// of the exact GPU filter. Depends on shaders/shared, the brick arrays and TBB.
#include "preview/twin/march_picture.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "base/blue_noise.h"
#include "volume/brick_layout.h"

namespace nephele {
namespace {

using namespace shared;

size_t flat(const ivec3& size, const ivec3& p) {
  return (static_cast<size_t>(p.z) * static_cast<size_t>(size.y) + static_cast<size_t>(p.y)) *
             static_cast<size_t>(size.x) +
         static_cast<size_t>(p.x);
}

/// Trilinear between `cell` and its neighbours, by f; `at` gives a sample.
template <class At>
auto mixed(const At& at, const ivec3& t, const vec3& f) {
  const auto y0 = mix(mix(at(t), at(t + ivec3(1, 0, 0)), f.x),
                      mix(at(t + ivec3(0, 1, 0)), at(t + ivec3(1, 1, 0)), f.x), f.y);
  const auto y1 = mix(mix(at(t + ivec3(0, 0, 1)), at(t + ivec3(1, 0, 1)), f.x),
                      mix(at(t + ivec3(0, 1, 1)), at(t + ivec3(1, 1, 1)), f.x), f.y);
  return mix(y0, y1, f.z);
}

/// A 3-D texture's texels.
template <class Texel>
struct Volume {
  ivec3 size{1};
  std::vector<Texel> texels;

  void make(const ivec3& of) {
    size = of;
    texels.assign(flat(of, ivec3(0, 0, of.z)), Texel(0.0f));
  }
  Texel& at(const ivec3& p) { return texels[flat(size, p)]; }
  Texel read(const vec3& texel) const {
    const ivec3 cell = min(ivec3(texel), size - 2);
    return mixed([this](const ivec3& p) { return texels[flat(size, p)]; }, cell, texel - vec3(cell));
  }
};

/// The atlas as the GPU would read it, without the bricks' scales.
Volume<float> atlasOf(const BrickLayout& layout) {
  Volume<float> atlas;
  atlas.make(layout.size);
  std::vector<std::byte> texels;
  float* to = atlas.texels.data();
  for (const AtlasSlab& slab : layout.slabs) {
    writeSlab(layout, slab, texels);
    const size_t count = texels.size() / bytesOf(layout.texel);
    readTexels(layout.texel, texels, to);
    to += count;
  }
  return atlas;
}

struct ArraySource {
  const BrickLayout* layout;
  const BrickLayout* heat;  // of the temperatures, or nullptr
  Volume<float> atlas, heatAtlas;
  Volume<float> columns;
  Volume<vec4> skies;
  int skyParts = 1;  // beside each other along z

  uvec2 word(ivec3 brick) const { return layout->words[flat(layout->frame.brickCount, brick)]; }
  uint block(ivec3 block) const { return layout->blockWords[flat(layout->blockCount, block)]; }
  float column(vec3 texel) const { return columns.read(texel); }
  vec4 sky(int part, vec3 texel) const {
    return skies.read(texel + vec3(0.0f, 0.0f, static_cast<float>(part * (skies.size.z / skyParts))));
  }

  float density(uvec2 word, vec3 kept, ivec3 samples) const { return value(atlas, word, kept, samples); }
  float sample(uvec2 word, ivec3 kept) const {
    return atlas.texels[flat(atlas.size, brick_word::corner(word) + kept)];
  }
  float heatValue(uvec2 word, vec3 kept, ivec3 samples) const {
    return value(heatAtlas, word, kept, samples);
  }
  float value(const Volume<float>& in, uvec2 word, vec3 kept, ivec3 samples) const {
    const ivec3 cell = min(ivec3(kept), samples - 2), corner = brick_word::corner(word);
    return mixed([&](const ivec3& p) { return in.texels[flat(in.size, p)]; }, corner + cell,
                 kept - vec3(cell));
  }
  uvec2 heatWord(ivec3 brick) const { return heat->words[flat(heat->frame.brickCount, brick)]; }
};

/// What shaders/light_cache.comp fills for the exact filter.
void fillCache(ArraySource& source, const March<ArraySource>& march) {
  const BrickLayout& layout = *source.layout;
  const MarchParameters& p = march.params;
  const bool columns = p.cache.x > 0.0f && p.counts.x > 0;
  const bool sky = p.cacheShape.y > 0;
  if (columns) source.columns.make(layout.blockPlaces * p.cacheShape.x * ivec3(1, 1, p.counts.x));
  if (sky) {
    source.skyParts = p.skySize.z;
    source.skies.make(layout.blockPlaces * p.cacheShape.y * ivec3(1, 1, source.skyParts));
  }
  tbb::parallel_for(size_t{0}, layout.blocks.size(), [&](size_t number) {
    March<ArraySource> mine = march;
    const ivec3 block = layout.blocks[number];
    const int nx = layout.blockPlaces.x, ny = layout.blockPlaces.y, n = static_cast<int>(number);
    const ivec3 place(n % nx, n / nx % ny, n / (nx * ny));
    const auto each = [&](int samples, const auto& fill) {
      for (int i = 0; i < samples * samples * samples; ++i) {
        const ivec3 local(i % samples, i / samples % samples, i / (samples * samples));
        fill(place * samples + local, mine.cachePosition(block, local, samples),
             mine.skyTurn(block, local, samples));
      }
    };
    vec4 cost(0.0f);
    for (int light = 0; columns && light < p.counts.x; ++light)
      each(p.cacheShape.x, [&](const ivec3& texel, const vec3& position, const vec2&) {
        source.columns.at(texel + ivec3(0, 0, light * p.cacheShape.z)) =
            mine.columnToCache(light, position, cost);
      });
    if (!sky) return;
    each(p.cacheShape.y, [&](const ivec3& texel, const vec3& position, const vec2& turn) {
      vec4 parts[kOpenParts];
      mine.skyToCache(position, turn, parts[0], parts[1], parts[2], cost);
      for (int part = 0; part < source.skyParts; ++part)
        source.skies.at(texel + ivec3(0, 0, part * (source.skies.size.z / source.skyParts))) = parts[part];
    });
  });
}

}  // namespace

std::vector<TwinPixel> marchPicture(const BrickLayout& layout, const BrickLayout* heat,
                                    const MarchParameters& parameters, int width, int height,
                                    glm::vec2 subPixel, unsigned number, const SkyArrays& sky) {
  std::vector<TwinPixel> pixels(static_cast<size_t>(width) * static_cast<size_t>(height));
  if (layout.words.empty() && parameters.skyForward.w <= 0.0f && parameters.stage.x <= 0.0f) return pixels;
  ArraySource source{&layout, heat, atlasOf(layout), heat != nullptr ? atlasOf(*heat) : Volume<float>{},
                     {},      {}};
  March<ArraySource> whole{parameters, &source, sky};
  describeLayout(whole.params, layout);
  fillCache(source, whole);
  const std::vector<float> jitter = blueNoiseTile(kJitterTile);
  tbb::parallel_for(tbb::blocked_range<int>(0, height), [&](const tbb::blocked_range<int>& rows) {
    March<ArraySource> march = whole;
    for (int y = rows.begin(); y != rows.end(); ++y) {
      for (int x = 0; x < width; ++x) {
        const vec2 at = vec2(static_cast<float>(x), static_cast<float>(y)) + subPixel;
        const uint random = randomState(static_cast<uint>(x), static_cast<uint>(y), 0u,
                                        static_cast<uint>(parameters.brickCount.w));
        const float start = march.stepStart(
            jitter[static_cast<size_t>(y % kJitterTile * kJitterTile + x % kJitterTile)], number);
        const auto result = parameters.stage.x > 0.0f
                                ? march.stageAlong(march.rayThrough(at), start, random, number)
                                : march.marchRay(at, start, random, number);
        TwinPixel& pixel =
            pixels[static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)];
        pixel = {result.radiance + march.environmentBehind(at, result.opticalDepth),
                 exp(-result.opticalDepth), result.depth, result.depthWeight, result.cost.x};
      }
    }
  });
  return pixels;
}

std::vector<TwinPixel> marchPicture(const BrickVolume& bricks, const MarchParameters& parameters, int width,
                                    int height, glm::vec2 subPixel, unsigned number, const SkyArrays& sky,
                                    Texel texel) {
  const BrickLayout layout = layOut(bricks, {texel, kLeastTextureLimit, {}, 0, 0});
  const BrickLayout heat = bricks.temperature ? layOut(*bricks.temperature) : BrickLayout{};
  return marchPicture(layout, bricks.temperature ? &heat : nullptr, parameters, width, height, subPixel,
                      number, sky);
}

}  // namespace nephele
