// Looks and switches, the furnace value, presets, skies and their tables of directions.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/error.h"
#include "base/picture.h"
#include "scene/blackbody.h"
#include "scene/light_model.h"
#include "scene/presets.h"
#include "scene/sky.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

using glm::dvec3;
constexpr double kPi = std::numbers::pi;

LightModel modelOf(Look look, Switch silver, Switch powder, std::optional<int> count) {
  Scene scene;
  scene.look = look;
  scene.silverLining.on = silver;
  scene.powder.on = powder;
  scene.octaves.count = count;
  return lightModelOf(scene, Medium{});
}

TEST(LightModel, TheLookDecidesWhatTheSceneLeavesOpen) {
  const LightModel physical = modelOf(Look::physical, {}, {}, {});
  EXPECT_FALSE(physical.silverLining || physical.powder);
  EXPECT_EQ(physical.octaveCount, 0);
  EXPECT_EQ(physical.phase.first, Medium{}.g);
  EXPECT_EQ(physical.phase.share, 0.0);
  EXPECT_EQ(physical.oSa, 0.0);
  const LightModel report = modelOf(Look::report, {}, {}, {});
  EXPECT_TRUE(report.silverLining && report.powder);
  EXPECT_EQ(report.octaveCount, kReportOctaves);
  EXPECT_EQ(report.phase.first, SilverLining{}.inS);
  EXPECT_EQ(report.phase.second, -SilverLining{}.outS);
  EXPECT_EQ(report.phase.share, SilverLining{}.blend);
}

TEST(LightModel, TheSceneOverrulesTheLook) {
  const LightModel physical = modelOf(Look::physical, true, true, 3);
  EXPECT_TRUE(physical.silverLining && physical.powder);
  EXPECT_EQ(physical.octaveCount, 3);
  const LightModel report = modelOf(Look::report, false, false, 0);
  EXPECT_FALSE(report.silverLining || report.powder);
  EXPECT_EQ(report.octaveCount, 0);
}

TEST(LightModel, NamesWhatIsOnAndNotPhysical) {
  const auto unphysical = [](const LightModel& model) {
    int count = 0;
    for (const LightTerm& term : termsOf(model)) count += term.on && !term.physical ? 1 : 0;
    return count;
  };
  EXPECT_EQ(unphysical(modelOf(Look::physical, {}, {}, {})), 0);
  EXPECT_EQ(unphysical(modelOf(Look::physical, true, {}, {})), 0);
  EXPECT_EQ(unphysical(modelOf(Look::report, {}, {}, {})), 2);
}

TEST(Furnace, SingleScatteringAndTheTextsExample) {
  EXPECT_NEAR(furnaceValue(0, 0.5, 0.5), 0.5 * (1.0 - std::log(2.0)), 1e-15);
  EXPECT_NEAR(furnaceValue(8, 0.9, 0.9), 1.16, 5e-3);  // MODEL.md, section 2
  EXPECT_NEAR(furnaceValue(1, 0.0, 0.5), 0.5 * (1.0 - std::log(2.0)) + 0.25, 1e-12);
  EXPECT_NEAR(furnaceValue(16, 1e-30, 1.0), 0.5 * (1.0 - std::log(2.0)) + 8.0, 1e-9);
}

TEST(Furnace, IsTheIntegralOverDepthAndDirection) {
  // ∫ e^(−τ) ½ ∫ e^(−a τ/μ') dμ' dτ by brute force, for the order m = 1 with a = 0.3.
  const double a = 0.3;
  double sum = 0.0;
  constexpr int kNodes = 2000;
  for (int i = 0; i < kNodes; ++i) {
    const double mu = (i + 0.5) / kNodes;
    sum += 0.5 / (1.0 + a / mu) / kNodes;  // the depth's integral is closed
  }
  EXPECT_NEAR(furnaceValue(1, a, 1.0) - furnaceValue(0, a, 1.0), sum, 1e-6);
}

TEST(Furnace, OpennessTakesFromOrdersBeyondTheFirst) {
  // With a = 0 order 1 adds b ½ ∫ e^(−τ) (1 − d ½ E₂(τ)) dτ, and ∫ e^(−τ) E₂(τ) dτ = 1 − ln 2.
  for (const double d : {0.3, 1.0})
    EXPECT_NEAR(furnaceValue(1, 0.0, 0.8, d) - furnaceValue(0, 0.0, 0.8, d),
                0.8 * 0.5 * (1.0 - 0.5 * d * (1.0 - std::log(2.0))), 1e-5)
        << d;
  EXPECT_NEAR(furnaceValue(8, 0.9, 0.9, 1e-9), furnaceValue(8, 0.9, 0.9), 1e-5);
  EXPECT_LT(furnaceValue(8, 0.9, 0.9, 1.0), 0.9 * furnaceValue(8, 0.9, 0.9));
}

TEST(Presets, EachIsASunUnderASky) {
  EXPECT_EQ(presets().size(), 5u);
  for (const Preset& preset : presets()) {
    EXPECT_EQ(findPreset(std::string(preset.name)).name, preset.name);
    Scene scene;
    applyPreset(preset, scene);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_NEAR(glm::length(std::get<Sun>(scene.lights[0]).toLight), 1.0, 1e-12);
    EXPECT_EQ(scene.environment.kind, Environment::Kind::ramp);
    EXPECT_TRUE(scene.lightsFollowUp);
  }
  EXPECT_EQ(defaultScene().look, Look::report);
  try {
    findPreset("sunst");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(), "error: unknown preset 'sunst'; did you mean 'sunset'?");
  }
}

/// CIE 1931 chromaticity of linear Rec.709.
std::array<double, 2> chromaticity(const std::array<double, 3>& c) {
  const double x = 0.4124564 * c[0] + 0.3575761 * c[1] + 0.1804375 * c[2];
  const double y = 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2];
  const double z = 0.0193339 * c[0] + 0.1191920 * c[1] + 0.9503041 * c[2];
  return {x / (x + y + z), y / (x + y + z)};
}

TEST(Blackbody, HasTheChromaticitiesOfThePlanckianLocus) {
  // CIE standard illuminant A is 2856 K; the others from the locus's table [Wyszecki and Stiles].
  const struct {
    double kelvin, x, y;
  } rows[] = {{2856.0, 0.4476, 0.4074},
              {4000.0, 0.3805, 0.3768},
              {6500.0, 0.3135, 0.3237},
              {10000.0, 0.2807, 0.2884}};
  constexpr double kFitTolerance = 3e-3;  // the observer is a fit
  for (const auto& row : rows) {
    const auto xy = chromaticity(blackbodyRadiance(row.kelvin));
    EXPECT_NEAR(xy[0], row.x, kFitTolerance) << row.kelvin;
    EXPECT_NEAR(xy[1], row.y, kFitTolerance) << row.kelvin;
  }
}

TEST(Blackbody, LuminanceIsOneAtTwoThousandKelvinAndFollowsWien) {
  const auto luminance = [](double kelvin) {
    const auto c = blackbodyRadiance(kelvin);
    return 0.2126729 * c[0] + 0.7151522 * c[1] + 0.0721750 * c[2];
  };
  EXPECT_NEAR(luminance(kBlackbodyUnitKelvin), 1.0, 2e-3);  // what Rec.709 cannot show is cut
  // Between near temperatures ln L changes as −c₂/λ · Δ(1/T), λ within what is seen.
  const double slope = std::log(luminance(3000.0) / luminance(2900.0)) / (1.0 / 2900.0 - 1.0 / 3000.0);
  EXPECT_GT(slope, 1.4388e4 / 0.62);
  EXPECT_LT(slope, 1.4388e4 / 0.55);
  EXPECT_EQ(luminance(500.0), 0.0);
  EXPECT_EQ(luminance(0.0), 0.0);
  EXPECT_EQ(luminance(-1.0), 0.0);
  for (size_t c = 0; c < 3; ++c) EXPECT_GE(blackbodyRadiance(800.0)[c], 0.0);
}

TEST(Sky, AxesOfBothUps) {
  const SkyAxes z = skyAxes(dvec3(0, 0, 1), 0.0);
  EXPECT_LT(glm::distance(z.forward, dvec3(0, 1, 0)), 1e-15);
  EXPECT_LT(glm::distance(z.right, dvec3(1, 0, 0)), 1e-15);
  const SkyAxes y = skyAxes(dvec3(0, 1, 0), 0.0);
  EXPECT_LT(glm::distance(y.forward, dvec3(0, 0, -1)), 1e-15);
  EXPECT_LT(glm::distance(y.right, dvec3(1, 0, 0)), 1e-15);
  // A quarter turn to the left: from +Y to −X where Z is up.
  EXPECT_LT(glm::distance(skyAxes(dvec3(0, 0, 1), kPi / 2.0).forward, dvec3(-1, 0, 0)), 1e-15);
}

TEST(Sky, RampIsBrownThenWhiteThenBlue) {
  Environment environment;
  environment.kind = Environment::Kind::ramp;
  environment.ramp.cloudiness = 0.0;
  const auto at = [&](double sine) {
    return skyRadiance(environment, nullptr, dvec3(0, 0, 1), {std::sqrt(1.0 - sine * sine), 0.0, sine});
  };
  const SkyRamp& ramp = environment.ramp;
  for (int c = 0; c < 3; ++c) {
    const size_t channel = static_cast<size_t>(c);
    EXPECT_NEAR(at(0.0)[c], ramp.horizon[channel], 1e-12);
    EXPECT_NEAR(at(1.0)[c], ramp.zenith[channel], 1e-12);
    EXPECT_NEAR(at(-1.0)[c], ramp.ground[channel], 1e-12);
  }
  environment.ramp.intensity = 3.0;
  EXPECT_NEAR(at(1.0).z, 3.0 * ramp.zenith[2], 1e-12);
  environment.ramp.cloudiness = 1.0;  // the ground is dimmed, the white rises
  EXPECT_LT(at(-1.0).x, 2.0 * ramp.ground[0]);
  environment.ramp.intensity = 1.0;
  const double cloudy = at(0.5).x;
  environment.ramp.cloudiness = 0.0;
  EXPECT_GT(cloudy, at(0.5).x);
}

/// Three by two texels, told apart by their values.
EnvironmentMap smallMap() {
  return makeEnvironmentMap("small", 3, 2,
                            {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {0, 1, 0}, {0, 2, 0}, {0, 3, 0}});
}

TEST(EnvironmentMap, CentreColumnLooksForwardAndRightIsRight) {
  const EnvironmentMap map = smallMap();
  Environment environment;
  environment.kind = Environment::Kind::exr;
  const auto at = [&](const dvec3& d) {
    return skyRadiance(environment, &map, dvec3(0, 0, 1), glm::normalize(d));
  };
  const double up = 1.0;  // tan of 45 degrees: the upper row's centre
  EXPECT_LT(glm::distance(at({0.0, 1.0, up}), dvec3(2, 0, 0)), 1e-9);
  EXPECT_LT(glm::distance(at({std::sin(2.0 * kPi / 3.0), std::cos(2.0 * kPi / 3.0), up}), dvec3(3, 0, 0)),
            1e-9);
  EXPECT_LT(glm::distance(at({0.0, 1.0, -up}), dvec3(0, 2, 0)), 1e-9);
  EXPECT_LT(glm::distance(at({0.0, -1.0, up}), dvec3(2, 0, 0)), 1e-9) << "half of 1 and half of 3, around";
  environment.exr.rotation = 2.0 * kPi / 3.0;  // to the left: ahead is now what was right
  EXPECT_LT(glm::distance(at({0.0, 1.0, up}), dvec3(3, 0, 0)), 1e-9);
  environment.exr.intensity = 2.0;
  EXPECT_LT(glm::distance(at({0.0, 1.0, up}), dvec3(6, 0, 0)), 1e-9);
}

TEST(EnvironmentMap, TheTableDrawsWhatItSaysAndFollowsBrightness) {
  std::vector<glm::vec3> texels(64 * 32, glm::vec3(0.1f));
  texels[5 * 64 + 40] = glm::vec3(50.0f);
  const EnvironmentMap map = makeEnvironmentMap("spot", 64, 32, texels);
  // What a cell is drawn with: its own share kept and what others pass on to it.
  std::vector<double> drawn(kEnvironmentCells, 0.0);
  double total = 0.0;
  for (int i = 0; i < kEnvironmentCells; ++i) {
    const glm::vec4& cell = map.cells[static_cast<size_t>(i)];
    drawn[static_cast<size_t>(i)] += double{cell.x} / kEnvironmentCells;
    drawn[static_cast<size_t>(cell.y)] += (1.0 - double{cell.x}) / kEnvironmentCells;
    total += double{cell.z} * 4.0 * kPi / kEnvironmentCells;
  }
  EXPECT_NEAR(total, 1.0, 1e-5);
  for (int i = 0; i < kEnvironmentCells; ++i)
    EXPECT_NEAR(drawn[static_cast<size_t>(i)],
                double{map.cells[static_cast<size_t>(i)].z} * 4.0 * kPi / kEnvironmentCells, 1e-7)
        << i;
  // The spot's own cells: four columns wide, row by the cosine of its angle from the top.
  const int row = static_cast<int>(0.5 * (1.0 - std::cos(kPi * 5.5 / 32.0)) * kEnvironmentCellsUp);
  const int column = static_cast<int>(40.5 / 64.0 * kEnvironmentCellsAround);
  EXPECT_GT(map.cells[static_cast<size_t>(row * kEnvironmentCellsAround + column)].z, 1.0f);
}

TEST(EnvironmentMap, ReadsWhatExrsHoldAndRefusesTheRest) {
  const ScratchFolder scratch;
  Picture picture;
  picture.width = 2;
  picture.height = 1;
  for (const char* name : {"R", "G", "B"}) picture.planes[picture.add(name)] = {0.5f, 1.0f};
  writeExr(scratch.file("good.exr"), picture);
  const auto map = loadEnvironmentMap(scratch.file("good.exr"));
  EXPECT_EQ(map->texels[1], glm::vec3(1.0f));
  picture.planes[1][0] = -1.0f;
  writeExr(scratch.file("negative.exr"), picture);
  EXPECT_THROW(loadEnvironmentMap(scratch.file("negative.exr")), InputError);
  Picture depth;
  depth.width = depth.height = 1;
  depth.add("depth");
  writeExr(scratch.file("depth.exr"), depth);
  EXPECT_THROW(loadEnvironmentMap(scratch.file("depth.exr")), InputError);
  EXPECT_THROW(loadEnvironmentMap(scratch.file("missing.exr")), InputError);
}

}  // namespace
}  // namespace nephele
