// Binding and drawing the march. Depends on what its header names.
#include "preview/gpu/march_pass.h"

#include <array>
#include <chrono>
#include <glm/geometric.hpp>
#include <limits>

#include "base/blue_noise.h"

namespace nephele {
namespace {

// Locations and bindings as shaders/march.frag and shaders/bricks.glsl declare them.
constexpr GLuint kParameterBinding = 0, kJitterUnit = 4, kSkipsBinding = 3;
constexpr GLint kSubPixelLocation = 0, kSampleNumberLocation = 1, kSliceLocation = 3,
                kPictureSizeLocation = 4;
constexpr int kTriangleCorners = 3, kCubeCorners = 36;
// NPH_METHOD of shaders/march.frag: the kinds of march_pass.h, and a sample without medium.
constexpr int kMethodCube = static_cast<int>(MarchKind::cube), kMethodNothing = 3;

/// What these parameters do not need is left out, since some drivers run the branches that no pixel takes.
std::vector<std::string> definesFor(Filter filter, MarchWrites writes, int method,
                                    const shared::MarchParameters& p) {
  const int sky = p.skyUp.w == 0.0f ? 0 : p.skySize.w != 0 ? 1 : 2;
  const auto flag = [](const char* name, bool on) { return std::string(name) + (on ? " true" : " false"); };
  bool points = false;
  for (int i = 0; i < p.counts.x; ++i)
    points = points || static_cast<int>(p.lights[i].direction.w) == shared::kLightPoint;
  return {filter == Filter::exact ? "NPH_FILTER_EXACT 1" : "NPH_FILTER_EXACT 0",
          "NPH_METHOD " + std::to_string(method),
          "NPH_VIEW " + std::to_string(static_cast<int>(writes)),
          flag("NPH_GREY", p.sigmaT.x == p.sigmaT.y && p.sigmaT.y == p.sigmaT.z),
          flag("NPH_CACHED", p.cache.x > 0.0f),
          flag("NPH_NEAR", p.cache.w > 0.0f),
          flag("NPH_POINTS", points),
          flag("NPH_POWDER", p.powder.x > 0.0f),
          flag("NPH_LOBES", p.phase.z > 0.0f),
          flag("NPH_SCALED", p.counts.z != 0),
          p.blockCount.w != 0 ? "NPH_CHECK 1" : "NPH_CHECK 0",
          flag("NPH_LEVELS", p.cacheShape.w != 0),
          flag("NPH_MAP", static_cast<int>(p.skyUp.w) == shared::kSkyMap),
          flag("NPH_SHOWN_SKY", p.skyForward.w > 0.0f),
          p.stage.x > 0.0f ? "NPH_STAGE 1" : "NPH_STAGE 0",
          p.emission.x > 0.0f ? "NPH_HEAT 1" : "NPH_HEAT 0",
          "NPH_SKY " + std::to_string(sky),
          flag("NPH_OPEN", p.skySize.z == shared::kOpenParts)};
}

/// Whether the way from the index to the world turns right hands into left ones.
bool mirrored(const shared::MarchParameters& p) {
  return glm::dot(glm::cross(glm::vec3(p.worldFromIndexX), glm::vec3(p.worldFromIndexY)),
                  glm::vec3(p.worldFromIndexZ)) < 0.0f;
}

GlTexture makeJitterTile() {
  GlTexture texture = makeTexture(GL_TEXTURE_2D);
  const std::vector<float> tile = blueNoiseTile(shared::kJitterTile);
  glTextureStorage2D(texture.name(), 1, GL_R32F, shared::kJitterTile, shared::kJitterTile);
  glTextureSubImage2D(texture.name(), 0, 0, 0, shared::kJitterTile, shared::kJitterTile, GL_RED, GL_FLOAT,
                      tile.data());
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, GL_NEAREST);
  return texture;
}

bool wantsCache(const shared::MarchParameters& p) { return p.cache.x > 0.0f || p.cacheShape.y > 0; }

}  // namespace

MarchPass::MarchPass(Filter filter, const std::vector<TextChange>& changes, MarchWrites writes,
                     MarchKind kind)
    : filter_(filter),
      writes_(writes),
      kind_(kind),
      changes_(changes),
      buffer_(makeBuffer()),
      skips_(makeBuffer()),
      jitter_(makeJitterTile()),
      noVertices_(makeVertexArray()) {
  glNamedBufferStorage(buffer_.name(), sizeof(shared::MarchParameters), nullptr, GL_DYNAMIC_STORAGE_BIT);
  const std::array<uint32_t, 2> zeros{};
  glNamedBufferStorage(skips_.name(), sizeof zeros, zeros.data(), GL_DYNAMIC_STORAGE_BIT);
  checkGl("making the parameter buffer");
}

const GlProgram& MarchPass::program(int method) {
  const std::vector<std::string> defines = definesFor(filter_, writes_, method, parameters_);
  GlProgram& built = programs_[defines];
  if (built.name() == 0)
    built =
        buildProgram(method == kMethodCube ? "cube.vert" : "screen.vert", "march.frag", defines, changes_);
  return built;
}

void MarchPass::setParameters(const shared::MarchParameters& parameters) {
  parameters_ = parameters;
  preparedFor_ = 0;
}

LightCache* MarchPass::uploadParameters(const BrickAtlas& atlas) {
  shared::describeLayout(parameters_, atlas.layout());
  glNamedBufferSubData(buffer_.name(), 0, sizeof parameters_, &parameters_);
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameterBinding, buffer_.name());
  preparedFor_ = atlas.serial();
  if (writes_ != MarchWrites::radiance || !wantsCache(parameters_)) return nullptr;
  std::optional<LightCache>& cache = caches_[which_];
  if (!cache) cache.emplace(filter_, changes_);
  sky_.bind();
  return &*cache;
}

bool MarchPass::prepare(const BrickAtlas& atlas, double seconds) {
  LightCache* cache = uploadParameters(atlas);
  return cache == nullptr || cache->update(atlas, parameters_, seconds);
}

double MarchPass::compile(const BrickAtlas& atlas) {
  const auto start = std::chrono::steady_clock::now();
  if (LightCache* cache = uploadParameters(atlas)) cache->begin(atlas, parameters_);
  // Some drivers compile what a draw needs at the draw.
  const Film pixel(1, 1);
  draw(atlas, pixel, glm::vec2(0.5f, 0.5f), 0, {0, 0, 1, 1});
  finishGl("compiling the march");
  preparedFor_ = 0;  // the light cache is not filled yet
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

void MarchPass::useCache(size_t which) {
  NEPHELE_CHECK_LT(which, kCaches);
  if (which != which_) preparedFor_ = 0;
  which_ = which;
}

double MarchPass::takeCacheDensities() {
  std::optional<LightCache>& cache = caches_[which_];
  return cache ? cache->takeDensitiesRead() : 0.0;
}

SkipCheck MarchPass::takeSkipCheck() {
  SkipCheck check;
  if (parameters_.blockCount.w == 0) return check;
  glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
  check = nephele::takeSkipCheck(skips_, 0);
  if (std::optional<LightCache>& cache = caches_[which_]) {
    const SkipCheck filled = cache->takeSkipCheck();
    check.checked += filled.checked;
    check.wrong += filled.wrong;
  }
  return check;
}

void MarchPass::setSlice(int axis, float place) { slice_ = glm::vec2(static_cast<float>(axis), place); }

void MarchPass::draw(const BrickAtlas& atlas, const Film& film, glm::vec2 subPixel, unsigned number,
                     const PixelRectangle& where) {
  if (preparedFor_ != atlas.serial()) prepare(atlas, std::numeric_limits<double>::infinity());
  film.bindAsTarget();
  atlas.bind();
  if (parameters_.blockCount.w != 0) atlas.bindStored();
  sky_.bind();
  if (caches_[which_]) caches_[which_]->bind();
  glBindTextureUnit(kJitterUnit, jitter_.name());
  glBindVertexArray(noVertices_.name());
  glBindBufferBase(GL_UNIFORM_BUFFER, kParameterBinding, buffer_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kSkipsBinding, skips_.name());
  glEnable(GL_SCISSOR_TEST);
  glScissor(where.x, where.y, where.width, where.height);
  const auto useProgram = [&](int method) {
    glUseProgram(program(method).name());
    glUniform2f(kSubPixelLocation, subPixel.x, subPixel.y);
    glUniform1ui(kSampleNumberLocation, number);
  };
  if (kind_ == MarchKind::cube) {
    useProgram(kMethodNothing);
    glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
    useProgram(kMethodCube);
    glUniform2f(kPictureSizeLocation, static_cast<float>(film.width()), static_cast<float>(film.height()));
    glEnable(GL_CULL_FACE);
    glFrontFace(mirrored(parameters_) ? GL_CCW : GL_CW);
    glDrawArrays(GL_TRIANGLES, 0, kCubeCorners);
    glDisable(GL_CULL_FACE);
  } else {
    useProgram(static_cast<int>(kind_));
    if (writes_ == MarchWrites::slice) glUniform2f(kSliceLocation, slice_.x, slice_.y);
    glDrawArrays(GL_TRIANGLES, 0, kTriangleCorners);
  }
  glDisable(GL_SCISSOR_TEST);
  glDisable(GL_BLEND);
}

uint64_t MarchPass::gpuBytes() const {
  constexpr uint64_t kTileBytes = uint64_t{shared::kJitterTile} * shared::kJitterTile * sizeof(float);
  uint64_t bytes = sizeof(shared::MarchParameters) + kTileBytes + sky_.gpuBytes();
  for (const std::optional<LightCache>& cache : caches_) bytes += cache ? cache->gpuBytes() : 0;
  return bytes;
}

}  // namespace nephele
