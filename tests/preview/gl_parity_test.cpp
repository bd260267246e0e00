// One text, two compilers: the march on the CPU and on the GPU give the same picture, and mutants do not.
#include <gtest/gtest.h>

#include <algorithm>

#include "preview/measure/compare.h"
#include "preview/twin/march_picture.h"
#include "tests/preview/gl_bench.h"

namespace nephele::testing_gl {
namespace {

constexpr int kWidth = 72, kHeight = 64;
constexpr double kGate = 1e-4;
constexpr glm::vec2 kSubPixel(0.37f, 0.61f);
constexpr unsigned kNumber = 3;
const TextChange kLitOneByOne{"shared/march.glsl", "kLitTogetherSteps = 8", "kLitTogetherSteps = 1"};

/// What lights the cloud: `plain`: marched light under a uniform sky; `report`: all terms of that look under
/// a ramp; `map`: light by the chord under a lat-long picture that is shown; `cached`, `cachedRamp`: light
/// from the cache under a uniform sky and under a ramp, where octaves ask how open a place is; `open`: as
/// `plain`, and they ask it there; `stage`: a cloud among floor, balls and cube.
enum class Lit { plain, report, map, cached, cachedRamp, stage, open };

std::shared_ptr<const EnvironmentMap> someMap() {
  constexpr int kColumns = 24, kRows = 12;
  std::vector<glm::vec3> texels;
  for (int i = 0; i < kColumns * kRows; ++i) {
    const float f = static_cast<float>(i);
    texels.push_back({0.6f + 0.5f * std::sin(0.7f * f), 0.6f + 0.5f * std::cos(0.31f * f), 0.4f});
  }
  texels[3 * kColumns + 15] = glm::vec3(25.0f, 22.0f, 18.0f);
  return std::make_shared<const EnvironmentMap>(makeEnvironmentMap("made", kColumns, kRows, texels));
}

/// A cloud under all that the march knows: a sun, a point, octaves, sky, colours, random starts, unequal
/// voxels.
struct ParityCase {
  BrickVolume bricks;
  ViewedScene view;
  shared::MarchParameters parameters;

  explicit ParityCase(Lit lit) {
    glm::dmat4 worldFromIndex(1.0);
    worldFromIndex[0] = glm::dvec4(0.04, 0.01, 0.0, 0.0);
    worldFromIndex[1] = glm::dvec4(-0.01, 0.05, 0.005, 0.0);
    worldFromIndex[2] = glm::dvec4(0.0, 0.0, 0.045, 0.0);
    bricks = volumeOf(glm::ivec3(72), glm::ivec3(-13, 5, 40), worldFromIndex, [](const glm::dvec3& p) {
      return cloudDensity(p, glm::dvec3(23.0, 41.0, 76.0), 34.0);
    });
    const glm::dvec3 centre(worldFromIndex * glm::dvec4(23.0, 41.0, 76.0, 1.0));
    view.camera.target = centre;
    view.camera.position = centre + glm::dvec3(2.4, -4.0, 1.5);
    view.medium = {{4.0, 5.0, 6.0}, {0.2, 0.4, 0.1}, 0.6};
    view.scene.octaves = {3, 0.6, 0.4, 0.7};
    view.scene.environment.constant = {0.2, 0.3, 0.5};
    view.scene.lights = {Sun{glm::normalize(glm::dvec3(0.3, 0.8, 0.5)), {3.0, 2.8, 2.5}},
                         PointLight{centre + glm::dvec3(-1.0, 0.3, 1.2), {2.0, 1.0, 0.5}}};
    Environment& environment = view.scene.environment;
    if (lit == Lit::report) {
      view.scene.look = Look::report;
      view.up = glm::normalize(glm::dvec3(0.1, 0.2, 1.0));
      environment.kind = Environment::Kind::ramp;
      // Temperatures on a coarser grid, turned against the density's.
      glm::dmat4 hotPlace = worldFromIndex * 1.7;
      hotPlace[0][2] += 0.01;
      hotPlace[3] = glm::dvec4(centre, 1.0);
      bricks.temperature = std::make_shared<const BrickVolume>(
          volumeOf(glm::ivec3(36), glm::ivec3(-18), hotPlace, [](const glm::dvec3& p) {
            return 1400.0 + 900.0 * std::sin(0.4 * p.x + 0.1 * p.z) * std::cos(0.3 * p.y);
          }));
    } else if (lit == Lit::map) {
      view.scene.lightTransmittance = LightTransmittance::chord;
      environment.kind = Environment::Kind::exr;
      environment.exr = {"made", 0.6, 0.8};
      environment.show = true;
      view.environmentMap = someMap();
    }
    view.scene.march.lightCache = lit == Lit::cached || lit == Lit::cachedRamp;
    if (lit == Lit::stage) {
      view.scene.stage.on = view.scene.stage.cube.on = true;
      view.scene.stage.penumbra = 2.0;
      view.camera.position = centre + glm::dvec3(1.5, -8.5, 2.5);
    }
    if (lit == Lit::cachedRamp) environment.kind = Environment::Kind::ramp;
    if (lit == Lit::cachedRamp || lit == Lit::open) view.scene.octaves.d = 0.7;
    parameters = marchParameters(view, bricks, kWidth, kHeight, 7, true);
  }
};

const ParityCase& parityCase(Lit lit) {
  static const ParityCase cases[] = {
      ParityCase(Lit::plain),      ParityCase(Lit::report), ParityCase(Lit::map), ParityCase(Lit::cached),
      ParityCase(Lit::cachedRamp), ParityCase(Lit::stage),  ParityCase(Lit::open)};
  return cases[static_cast<size_t>(lit)];
}

std::vector<TwinPixel> marchOnCpu(const ParityCase& on, unsigned number, Texel texel = Texel::r32f) {
  shared::SkyArrays sky;
  if (on.view.environmentMap)
    sky = {on.view.environmentMap->texels.data(), on.view.environmentMap->cells.data()};
  return marchPicture(on.bricks, on.parameters, kWidth, kHeight, kSubPixel, number, sky, texel);
}

const std::vector<TwinPixel>& twinPicture(Lit lit) {
  static const std::vector<TwinPixel> pictures[] = {
      marchOnCpu(parityCase(Lit::plain), kNumber),      marchOnCpu(parityCase(Lit::report), kNumber),
      marchOnCpu(parityCase(Lit::map), kNumber),        marchOnCpu(parityCase(Lit::cached), kNumber),
      marchOnCpu(parityCase(Lit::cachedRamp), kNumber), marchOnCpu(parityCase(Lit::stage), kNumber),
      marchOnCpu(parityCase(Lit::open), kNumber)};
  return pictures[static_cast<size_t>(lit)];
}

/// 99th percentile of |a − b|/max(|a|, |b|, 1e-3 of the picture's maximum).
double p99(const std::vector<double>& a, const std::vector<double>& b) {
  const double floor = 1e-3 * *std::max_element(a.begin(), a.end());
  std::vector<double> errors;
  for (size_t i = 0; i < a.size(); ++i)
    errors.push_back(std::abs(a[i] - b[i]) / std::max({std::abs(a[i]), std::abs(b[i]), floor}));
  std::sort(errors.begin(), errors.end());
  return errors[static_cast<size_t>(0.99 * static_cast<double>(errors.size() - 1))];
}

struct ParityError {
  double radiance, transmittance;
};

/// Over the pixels that see the medium on either side: empty ones agree trivially.
ParityError parityOf(Lit lit, const std::vector<TextChange>& changes, Texel texel = Texel::r32f) {
  needContext();
  MarchPass pass(Filter::exact, changes);
  pass.setParameters(parityCase(lit).parameters);
  pass.setEnvironment(parityCase(lit).view.environmentMap);
  const Picture gpu =
      marchOnGpu(pass, parityCase(lit).bricks, kWidth, kHeight, kSubPixel, kNumber, texel).picture;
  const std::vector<TwinPixel> twins =
      texel == Texel::r32f ? twinPicture(lit) : marchOnCpu(parityCase(lit), kNumber, texel);
  std::vector<double> a[2], b[2];
  for (size_t i = 0; i < twins.size(); ++i) {
    const TwinPixel& twin = twins[i];
    if (twin.transmittance.x == 1.0f && gpu.planes[4][i] == 1.0f) continue;
    for (int c = 0; c < 3; ++c) {
      const size_t plane = static_cast<size_t>(c);
      a[0].push_back(double{twin.radiance[c]});
      b[0].push_back(double{gpu.planes[plane][i]});
      a[1].push_back(double{twin.transmittance[c]});
      b[1].push_back(double{gpu.planes[4 + plane][i]});
    }
  }
  EXPECT_GT(a[0].size(), 3000u);
  return {p99(a[0], b[0]), p99(a[1], b[1])};
}

TEST(GlParity, CpuAndGpuAgree) {
  for (Lit lit : {Lit::plain, Lit::report, Lit::map, Lit::cached, Lit::cachedRamp, Lit::stage, Lit::open}) {
    const ParityError error = parityOf(lit, {});
    std::printf("parity, light %d: p99 of radiance %.3g, of transmittance %.3g\n", static_cast<int>(lit),
                error.radiance, error.transmittance);
    EXPECT_LE(error.radiance, kGate);
    EXPECT_LE(error.transmittance, kGate);
  }
}

TEST(GlParity, CpuAndGpuAgreeOnWhatSmallerTexelsHold) {
  for (const Texel texel : {Texel::r8, Texel::r16f})
    for (const Lit lit : {Lit::plain, Lit::cached}) {
      const ParityError error = parityOf(lit, {}, texel);
      EXPECT_LE(std::max(error.radiance, error.transmittance), kGate) << nameOf(texel);
    }
  // A picture of floats is not one of bytes, and a brick's bound is what its bytes are shares of.
  const TextChange unscaled{"bricks.glsl", "NPH_SCALED ? wordMaximum(word) : 1.0",
                            "NPH_SCALED ? params.walk.y : 1.0"};
  EXPECT_GT(parityOf(Lit::plain, {unscaled}, Texel::r8).transmittance, kGate);
}

TEST(GlParity, SmallerTexelsErrByNoMoreThanTheyPromise) {
  needContext();
  const ParityCase& on = parityCase(Lit::cached);
  // Other densities draw other places of those lit together, which says nothing of their errors.
  MarchPass pass(Filter::exact, {kLitOneByOne});
  ViewedScene view = on.view;
  view.scene.march.adaptive = false;  // steps follow bounds, which smaller texels change as well
  pass.setParameters(marchParameters(view, on.bricks, kWidth, kHeight, 7, true));
  const auto render = [&](Texel texel) {
    return marchOnGpu(pass, on.bricks, kWidth, kHeight, kSubPixel, kNumber, texel).picture;
  };
  const Picture floats = render(Texel::r32f);
  double deepest = 0.0;
  constexpr size_t kTransmittance = 4;
  for (const float t : floats.planes[kTransmittance]) deepest = std::max(deepest, -std::log(double{t}));
  for (const Texel texel : {Texel::r8, Texel::r16f}) {
    const Picture picture = render(texel);
    const Comparison error = comparePictures(picture, "kept", floats, "floats");
    double worst = 0.0;
    for (size_t i = 0; i < floats.planes[kTransmittance].size(); ++i)
      worst = std::max(worst, std::abs(std::log(double{floats.planes[kTransmittance][i]} /
                                                double{picture.planes[kTransmittance][i]})));
    const double bound = texelError(on.bricks, texel);
    std::printf(
        "%s: relative RMSE %.3g to floats; optical depth errs by %.3g of the deepest, the bound is %.3g\n",
        std::string(nameOf(texel)).c_str(), error.relativeRmse, worst / deepest, bound);
    EXPECT_LT(worst, bound * deepest);
    EXPECT_GT(worst, 0.0);
    EXPECT_LT(error.relativeRmse, texel == Texel::r8 ? 5e-3 : 1e-3);
  }
}

TEST(GlParity, EachMutantBreaksTheGate) {
  const char* march = "shared/march.glsl";
  const char* walk = "shared/walk.glsl";
  const char* light = "shared/light.glsl";
  const char* phase = "shared/phase.glsl";
  const char* emission = "shared/emission.glsl";
  const char* powder = "shared/powder.glsl";
  const char* sky = "shared/environment.glsl";
  const char* cache = "shared/light_cache.glsl";
  const char* stage = "shared/stage.glsl";
  const char* fill = "shared/light_cache_fill.glsl";
  const struct {
    const char* name;
    TextChange change;
    Lit lit = Lit::plain;
  } mutants[] = {
      {"albedo x 1.001", {march, "light = vec3(params.sigmaS)", "light = 1.001f * vec3(params.sigmaS)"}},
      {"extinction x 1.001",
       {march, "(rho * s.dt) * vec3(params.sigmaT)", "(rho * s.dt) * 1.001f * vec3(params.sigmaT)"}},
      {"g's sign", {phase, "toLight - forward * ray", "toLight + forward * ray"}},
      {"step 1% longer",
       {march, "stepIn(s.word, fine, coarse, left)", "(1.01f * stepIn(s.word, fine, coarse, left))"}},
      {"1/12 for 1/(4 pi)", {phase, "(4.0f * kPi * base * sqrt(base))", "(12.0f * base * sqrt(base))"}},
      {"first shadow step dropped",
       {walk, "float dt = steps.x / length(direction);",
        "float dt = steps.x / length(direction); tNear += dt;"}},
      {"octaves' b is a", {light, "scattering *= again", "scattering *= params.octaves.x"}},
      {"octaves' c left out", {light, "lobes.x *= params.octaves.z", "lobes.x *= 1.0f"}},
      {"octaves' d left out", {light, "params.octaves.w * openness", "0.0f * openness"}, Lit::open},
      {"the sky's light in place of openness",
       {cache, "cachedSky(2, texel)", "cachedSky(0, texel)"},
       Lit::open},
      {"openness of one direction less",
       {fill, "openness += lessened", "openness += (i == 0 ? 0.0f : 1.0f) * lessened"},
       Lit::open},
      {"the cached sky's orders know no openness",
       {fill, "NPH_OPEN ? scatteredAgain(openness)", "false ? scatteredAgain(openness)"},
       Lit::cachedRamp},
      {"octaves' c left out of the second lobe",
       {light, "lobes.y *= params.octaves.z", "lobes.y *= 1.0f"},
       Lit::report},
      {"lobes the wrong way round",
       {phase, "lobes.z * phaseHenyeyGreenstein(toLight, ray, lobes.y)",
        "lobes.z * phaseHenyeyGreenstein(toLight, ray, -lobes.y)"},
       Lit::report},
      {"powder's 0.9 is 0.91", {powder, "0.3f, 0.9f, 0.5f", "0.3f, 0.91f, 0.5f"}, Lit::report},
      {"powder's height left out", {light, "+ params.height.w", "+ 0.0f"}, Lit::report},
      {"powder also in transmittance",
       {march, "* vec3(params.sigmaT);", "* vec3(params.sigmaT) * powderAt(position, rho);"},
       Lit::report},
      {"the ramp's power off by 1%",
       {sky, "above ? params.skyHorizon.w", "above ? 1.01f * params.skyHorizon.w"},
       Lit::report},
      {"the ramp upside down", {sky, "bool above = sine >= 0.0f", "bool above = sine <= 0.0f"}, Lit::report},
      {"emission from scattering",
       {emission, "vec3(params.sigmaT) - vec3(params.sigmaS)", "vec3(params.sigmaS)"},
       Lit::report},
      {"temperatures a tenth of a voxel off",
       {emission, "+ params.heatY.w", "+ params.heatY.w + 0.1f"},
       Lit::report},
      {"the table a node off",
       {emission, "params.blackbody[node]", "params.blackbody[node + 1]"},
       Lit::report},
      {"the chord's square root left out",
       {"shared/chord.glsl", "sqrt(inside / dd)", "inside / dd"},
       Lit::map},
      {"the chord through the whole ellipsoid",
       {"shared/chord.glsl", "max(middle - extent, 0.0f)", "(middle - extent)"},
       Lit::map},
      {"the map mirrored",
       {sky, "dot(direction, vec3(params.skyRight))", "-dot(direction, vec3(params.skyRight))"},
       Lit::map},
      {"the map half a texel off", {sky, "* float(size.x) - 0.5f", "* float(size.x)"}, Lit::map},
      {"the map's density left out",
       {light, "0.5f * density + 0.5f * mapDensity(l.toLight)", "density"},
       Lit::map},
      {"the environment not seen through the medium", {sky, "exp(-opticalDepth) *", "1.0f *"}, Lit::map},
      {"point light without falloff",
       {light, "l.irradiance /= l.reach * l.reach", "l.irradiance /= l.reach"}},
      {"sky twice",
       {light, "environmentRadiance(l.toLight) / density",
        "2.0f * environmentRadiance(l.toLight) / density"}},
      {"series x/2 -> 0.4 x", {"shared/step_integral.glsl", "x * (0.5f -", "x * (0.4f -"}},
      {"a hundredth of a voxel off",
       {"bricks.glsl", "wordCorner(word) + cell, kept - vec3(cell)",
        "wordCorner(word) + cell, kept - vec3(cell) + 0.01"}},
      {"a brick's bound half as large", {walk, "+ 0x30000000u", "+ 0x2f800000u"}},
      {"steps start alike", {march, "number * 2654435769u", "0u"}},
      {"cached columns 1% longer",
       {fill, "1.0f + params.cache.y *", "1.0f + 1.01f * params.cache.y *"},
       Lit::cached},
      {"another light's columns",
       {cache, "float(light * params.cacheShape.z)", "float((1 - light) * params.cacheShape.z)"},
       Lit::cached},
      {"cached light a hundredth of a voxel off",
       {cache, "(position - vec3(block) * kBlockEdge)", "(position + 0.01f - vec3(block) * kBlockEdge)"},
       Lit::cached},
      {"near steps left out",
       {cache, "column += ds * densityAndExit", "column += 0.0f * densityAndExit"},
       Lit::cached},
      {"the cached sky's slope left out",
       {cache, "1.0f + dot(slopeFromKept(vec3(cachedSky(1, texel))), ray)", "1.0f"},
       Lit::cachedRamp},
      {"neighbouring samples of the cached sky look the same way",
       {fill, "skyDirection(i, turn)", "skyDirection(i, vec2(0.5f, 0.0f))"},
       Lit::cachedRamp},
      {"the cached sky kept in a hundredth more",
       {cache, "kSkyMixedBy * log", "1.01f * kSkyMixedBy * log"},
       Lit::cachedRamp},
      {"the cached sky's slope turned round", {fill, "* toSkies[i];", "* -toSkies[i];"}, Lit::cachedRamp},
      {"one direction of the cached sky left out",
       {fill, "vec3 light = scattering", "vec3 light = (i == 0 ? 0.0f : 1.0f) * scattering"},
       Lit::cached},
      {"penumbra 10% sharper",
       {"shared/stage_shapes.glsl", "sharpness * d / t", "1.1f * sharpness * d / t"},
       Lit::stage},
      {"mirrors reflect 0.1% more", {stage, "left *= s.mirror", "left *= 1.001f * s.mirror"}, Lit::stage},
      {"no shadow of the cloud on the stage",
       {stage, "lessened(column * vec3(params.sigmaT))", "vec3(1.0f)"},
       Lit::stage},
      {"the stage not hidden by the cloud",
       {stage, "left *= lessened(m.opticalDepth)", "left *= 1.0f"},
       Lit::stage},
      {"highlights half as wide", {stage, "s.shininess = 40.0f", "s.shininess = 80.0f"}, Lit::stage},
      {"squares 1% larger",
       {stage, "float edge = params.stageUp.w", "float edge = 1.01f * params.stageUp.w"},
       Lit::stage},
  };
  for (const auto& mutant : mutants) {
    const ParityError error = parityOf(mutant.lit, {mutant.change});
    std::printf("mutant '%s': p99 of radiance %.3g, of transmittance %.3g\n", mutant.name, error.radiance,
                error.transmittance);
    EXPECT_GT(std::max(error.radiance, error.transmittance), kGate) << mutant.name;
  }
}

TEST(GlParity, LightingStepsTogetherIsRightOnTheMean) {
  needContext();
  const auto render = [&](const std::vector<TextChange>& changes) {
    MarchPass pass(Filter::exact, changes);
    ViewedScene view = parityCase(Lit::plain).view;
    view.scene.environment.constant = {0.0, 0.0,
                                       0.0};  // its directions are random and would drown the difference
    view.scene.march.lightCache = false;
    pass.setParameters(marchParameters(view, parityCase(Lit::plain).bricks, kWidth, kHeight, 7, true));
    const BrickAtlas atlas(parityCase(Lit::plain).bricks, pass.filter(), Texel::r32f);
    const Film film(kWidth, kHeight);
    constexpr unsigned kSamples = 256;
    for (unsigned number = 0; number < kSamples; ++number)
      pass.draw(atlas, film, kSubPixel, number, {0, 0, kWidth, kHeight});
    return film.read();
  };
  const FilmPicture each = render({kLitOneByOne});
  const auto errorOf = [&](const FilmPicture& picture) {
    const Comparison error = comparePictures(picture.picture, "together", each.picture, "each");
    std::printf("steps lit together: %.3g times fewer densities, relative RMSE %.3g, bias %.3g\n",
                each.densitySamples / picture.densitySamples, error.relativeRmse, error.bias);
    return error;
  };
  const FilmPicture together = render({});
  const Comparison error = errorOf(together);
  EXPECT_LT(error.relativeRmse, 1e-2);
  EXPECT_LT(std::abs(error.bias), 5e-4);
  EXPECT_GT(each.densitySamples, 2.0 * together.densitySamples);
  // A step that is not drawn by its share is a wrong one.
  for (const char* drawn : {"bool drawn = true", "bool drawn = g.steps == 1"})
    EXPECT_GT(std::abs(errorOf(render({{"shared/march.glsl", "bool drawn = g.draw < chance", drawn}})).bias),
              2e-3)
        << drawn;
}

TEST(GlParity, SkippingEmptyBricksChangesNothing) {
  needContext();
  // Two balls far apart: most bricks between them are empty.
  const BrickVolume bricks =
      volumeOf({120, 60, 60}, glm::ivec3(-7), glm::dmat4(1.0), [](const glm::dvec3& p) {
        return cloudDensity(p, glm::dvec3(13.0, 20.0, 20.0), 16.0) +
               cloudDensity(p, glm::dvec3(92.0, 31.0, 28.0), 14.0);
      });
  ViewedScene view;
  view.camera.target = glm::dvec3(50.0, 25.0, 25.0);
  view.camera.position = glm::dvec3(190.0, 60.0, 60.0);
  view.medium = {{0.3, 0.3, 0.3}, {0.0, 0.0, 0.0}, 0.5};
  view.scene.environment.constant = {0.5, 0.5, 0.5};
  view.scene.lights = {Sun{glm::normalize(glm::dvec3(-1.0, -0.1, -0.05)), {3.0, 3.0, 3.0}}};
  view.scene.march.lightCache = false;
  const auto render = [&](const std::vector<TextChange>& changes) {
    MarchPass pass(Filter::exact, changes);
    pass.setParameters(marchParameters(view, bricks, kWidth, kHeight, 1, true));
    return marchOnGpu(pass, bricks, kWidth, kHeight, kSubPixel, kNumber);
  };
  const FilmPicture skipping = render({});
  const FilmPicture full =
      render({{"shared/walk.glsl", "while (t + start * dt < end) {", "while (false) {"}});
  EXPECT_LT(skipping.densitySamples, 0.9 * full.densitySamples) << "nothing was skipped";
  double worst = 0.0;
  for (size_t plane = 0; plane < full.picture.planes.size(); ++plane)
    for (size_t i = 0; i < full.picture.planes[plane].size(); ++i)
      worst = std::max(
          worst, std::abs(double{full.picture.planes[plane][i]} - double{skipping.picture.planes[plane][i]}));
  std::printf("skipping: %.0f of %.0f densities read, largest difference %.3g\n", skipping.densitySamples,
              full.densitySamples, worst);
  EXPECT_EQ(worst, 0.0);
}

}  // namespace
}  // namespace nephele::testing_gl
