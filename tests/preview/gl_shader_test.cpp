// The parameter struct's layout against the driver's, errors that name their file, pieces that make up one
// picture.
#include <gtest/gtest.h>

#include <cstddef>
#include <string>

#include "preview/gpu/accumulator.h"
#include "preview/gpu/sub_pixels.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

using shared::LightParameters;
using shared::MarchParameters;

GLint driverOffset(const GlProgram& program, const std::string& name) {
  const char* text = name.c_str();
  GLuint index = GL_INVALID_INDEX;
  glGetUniformIndices(program.name(), 1, &text, &index);
  if (index == GL_INVALID_INDEX) return -1;
  GLint offset = -1;
  glGetActiveUniformsiv(program.name(), 1, &index, GL_UNIFORM_OFFSET, &offset);
  return offset;
}

TEST(GlShader, ParameterOffsetsAreTheDrivers) {
  needContext();
  const GlProgram program =
      buildProgram("screen.vert", "march.frag",
                   {"NPH_FILTER_EXACT 1", "NPH_METHOD 0", "NPH_STAGE 0", "NPH_GREY false", "NPH_MAP true",
                    "NPH_SHOWN_SKY true", "NPH_CACHED true", "NPH_SKY 2", "NPH_OPEN true", "NPH_NEAR true",
                    "NPH_POINTS true", "NPH_POWDER true", "NPH_LOBES true"});
#define OFFSET(member) \
  { #member, offsetof(MarchParameters, member) }
  const struct {
    const char* name;
    size_t offset;
  } members[] = {
      OFFSET(originCorner),    OFFSET(originDx),        OFFSET(originDy),        OFFSET(directionCorner),
      OFFSET(directionDx),     OFFSET(directionDy),     OFFSET(rayCorner),       OFFSET(rayDx),
      OFFSET(rayDy),           OFFSET(worldFromIndexX), OFFSET(worldFromIndexY), OFFSET(worldFromIndexZ),
      OFFSET(indexFromWorldX), OFFSET(indexFromWorldY), OFFSET(indexFromWorldZ), OFFSET(boxMin),
      OFFSET(boxMax),          OFFSET(sigmaT),          OFFSET(sigmaS),          OFFSET(octaves),
      OFFSET(shadow),          OFFSET(phase),           OFFSET(powder),          OFFSET(height),
      OFFSET(chordCentre),     OFFSET(chordRadii),      OFFSET(environment),     OFFSET(skyHorizon),
      OFFSET(skyGround),       OFFSET(skyUp),           OFFSET(skyRight),        OFFSET(skyForward),
      OFFSET(skySize),         OFFSET(counts),          OFFSET(brickCount),      OFFSET(emission),
      OFFSET(heatCount),       OFFSET(stage),           OFFSET(stageFloor),      OFFSET(stageUp),
      OFFSET(stageAcross),     OFFSET(stageChrome),     OFFSET(stageGrey),       OFFSET(stageCube)};
#undef OFFSET
  for (const auto& member : members)
    EXPECT_EQ(driverOffset(program, std::string("params.") + member.name), static_cast<GLint>(member.offset))
        << member.name;
  for (size_t i = 0; i < static_cast<size_t>(shared::kMaxLights); ++i) {
    const std::string light = "params.lights[" + std::to_string(i) + "].";
    const size_t base = offsetof(MarchParameters, lights) + i * sizeof(LightParameters);
    EXPECT_EQ(driverOffset(program, light + "direction"), static_cast<GLint>(base));
    EXPECT_EQ(driverOffset(program, light + "directionIndex"),
              static_cast<GLint>(base + offsetof(LightParameters, directionIndex)));
    EXPECT_EQ(driverOffset(program, light + "power"),
              static_cast<GLint>(base + offsetof(LightParameters, power)));
  }
  GLint size = 0;
  glGetActiveUniformBlockiv(program.name(), 0, GL_UNIFORM_BLOCK_DATA_SIZE, &size);
  EXPECT_EQ(size, static_cast<GLint>(sizeof(MarchParameters)));
}

TEST(GlShader, ErrorsNameFileAndLine) {
  needContext();
  const BrickVolume bricks =
      volumeOf(glm::ivec3(2), glm::ivec3(0), glm::dmat4(1.0), [](const glm::dvec3&) { return 1.0; });
  MarchPass pass(Filter::exact, {{"shared/phase.glsl", "return 0.25f / kPi;", "return notDeclared;"}});
  ViewedScene view;
  view.scene.march.lightCache = false;
  pass.setParameters(marchParameters(view, bricks, 1, 1, 0, false));
  try {
    marchOnGpu(pass, bricks, 1, 1, {0.5f, 0.5f}, 0);
    FAIL() << "a broken shader compiled";
  } catch (const WorldError& error) {
    EXPECT_NE(std::string(error.what()).find("shared/phase.glsl:8:"), std::string::npos) << error.what();
  }
}

TEST(GlShader, LogsOfOtherDriversNameFilesToo) {
  const std::vector<std::string> files{"march.frag", "shared/march.glsl"};
  EXPECT_EQ(nameFilesInLog("1(23) : error C0000: x", files).substr(0, 21), "shared/march.glsl:23:");
  EXPECT_EQ(nameFilesInLog("ERROR: 0:7: x", files).substr(0, 20), "ERROR: march.frag:7:");
  EXPECT_EQ(nameFilesInLog("9:7: x", files), "9:7: x\n");
}

TEST(GlShader, GlErrorsBecomeExceptions) {
  needContext();
  glBindTextureUnit(0, 987654321u);
  EXPECT_THROW(checkGl("binding"), WorldError);
  EXPECT_NO_THROW(checkGl("binding"));
}

TEST(GlAccumulator, PiecesMakeUpOneMeanOfSamples) {
  needContext();
  const BrickVolume bricks =
      volumeOf(glm::ivec3(24), glm::ivec3(0), glm::dmat4(1.0),
               [](const glm::dvec3& p) { return cloudDensity(p, glm::dvec3(12.0), 11.0); });
  constexpr int kWidth = 130, kHeight = 90;
  constexpr unsigned kSamples = 3, kSeed = 5;
  ViewedScene view;
  view.camera.target = glm::dvec3(12.0);
  view.camera.position = glm::dvec3(50.0, 20.0, 30.0);
  view.medium = {{0.3, 0.3, 0.3}, {0.0, 0.0, 0.0}, 0.5};
  MarchPass pass(Filter::exact);
  pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, kSeed, true));
  const BrickAtlas atlas(bricks, Filter::exact, Texel::r32f);
  const Film pieces(kWidth, kHeight), whole(kWidth, kHeight);
  Accumulator accumulator(kWidth, kHeight, kSamples, kSeed);
  while (accumulator.advance(pass, atlas, pieces, 0.0))
    EXPECT_LT(accumulator.pixelsDone(), accumulator.pixelsTotal());
  for (unsigned number = 0; number < kSamples; ++number)
    pass.draw(atlas, whole, subPixelOffset(number, kSeed), number, {0, 0, kWidth, kHeight});
  const FilmPicture a = pieces.read(), b = whole.read();
  EXPECT_EQ(a.picture.planes, b.picture.planes);
  EXPECT_EQ(a.densitySamples, b.densitySamples);
  EXPECT_GT(a.densitySamples, 0.0);
}

}  // namespace
}  // namespace nephele::testing_gl
