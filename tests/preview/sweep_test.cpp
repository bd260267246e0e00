// Errors against noisy truth, Pareto fronts and knees on closed forms; charts' tables and scripts.
#include "preview/measure/sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>

#include "base/chart.h"
#include "base/figures.h"
#include "base/front.h"
#include "preview/truth/random.h"

namespace nephele {
namespace {

/// Truth of radiance 2 everywhere, in two halves that are off by `noise` times a normal number each, and a
/// picture that is off by `error` times another.
struct NoisyPair {
  NoisyPair(double error, double noise) {
    for (Picture* made : {&picture, &truth}) {
      made->width = made->height = 200;
      for (const char* name : {"R", "G", "B", "A"}) made->add(name);
      made->planes[3].assign(made->planes[3].size(), 1.0f);
    }
    for (const char* half : {"half1.", "half2."})
      for (const char* name : {"R", "G", "B"}) truth.add(std::string(half) + name);
    truth::Random random(1);
    const auto normal = [&] {  // Box and Muller
      const double r = std::sqrt(2.0 * double{random.exponential()});
      return r * std::cos(6.283185307179586 * double{random.uniform()});
    };
    for (size_t i = 0; i < picture.planes[0].size(); ++i)
      for (size_t c = 0; c < 3; ++c) {
        const double a = 2.0 + noise * normal(), b = 2.0 + noise * normal();
        truth.planes[4 + c][i] = static_cast<float>(a);
        truth.planes[7 + c][i] = static_cast<float>(b);
        truth.planes[c][i] = static_cast<float>(0.5 * (a + b));
        picture.planes[c][i] = static_cast<float>(2.0 + error * normal());
      }
  }
  Picture picture, truth;
};

TEST(CompareWithHalves, NoiseOfTheReferenceCancels) {
  const NoisyPair pair(0.02, 0.2);  // truth's own noise is ten times the error
  const NoisyError error = compareWithHalves(pair.picture, pair.truth);
  EXPECT_NEAR(error.relativeRmse, 0.01, 0.002);
  EXPECT_LT(error.low, 0.01);
  EXPECT_GT(error.high, 0.01);
  EXPECT_EQ(comparePictures(pair.picture, "a", pair.truth, "b").relativeRmse, error.relativeRmse);
  // Without halves the figure holds the noise of their mean, 0.2/√2 over 2.
  Picture mean = pair.truth;
  mean.names.resize(4);
  mean.planes.resize(4);
  EXPECT_GT(comparePictures(pair.picture, "a", mean, "b").relativeRmse, 0.05);
}

TEST(CompareWithHalves, WithoutNoiseItIsThePlainFigure) {
  const NoisyPair pair(0.1, 0.0);
  const Comparison plain = comparePictures(pair.picture, "a", pair.truth, "b");
  const NoisyError error = compareWithHalves(pair.picture, pair.truth);
  EXPECT_NEAR(error.relativeRmse, plain.relativeRmse, 1e-3 * plain.relativeRmse);
  EXPECT_EQ(error.bias, plain.bias);
}

Measured pointAt(double milliseconds, double error) {
  Measured m;
  m.milliseconds = milliseconds;
  m.error.relativeRmse = error;
  return m;
}

TEST(Pareto, FrontHoldsWhatNothingBeats) {
  const std::vector<Measured> points = {pointAt(10, 0.1), pointAt(1, 0.5),  pointAt(5, 0.2),
                                        pointAt(6, 0.3),  pointAt(10, 0.2), pointAt(100, 0.09)};
  EXPECT_EQ(paretoFront(points), (std::vector<size_t>{1, 2, 0, 5}));
}

TEST(Pareto, KneeIsFarthestBelowTheLine) {
  // On logarithmic axes: straight but for one point that bends towards the origin.
  const std::vector<Measured> points = {pointAt(1, 1.0), pointAt(10, 0.5), pointAt(100, 0.011),
                                        pointAt(1000, 0.01)};
  const std::vector<size_t> front = paretoFront(points);
  EXPECT_EQ(front[kneeOf(points, front)], 2u);
  const size_t knee = kneeOf(points, front);
  EXPECT_TRUE(isKnee(front, knee, 2));
  EXPECT_FALSE(isKnee(front, knee, front.back()));
  EXPECT_TRUE(onFront(front, front.back()));
  EXPECT_FALSE(onFront(front, points.size()));
  EXPECT_FALSE(isKnee({}, 0, 0));
  EXPECT_EQ(kneeOf(points, {0, 3}), 0u);
}

TEST(Sweep, TriesEveryKindOfSettingOnce) {
  Scene scene;
  scene.octaves.count = 2;
  const std::vector<Setting> settings = settingsFor({"march", "cube", "dda", "reference"}, scene);
  std::set<std::string> names;
  for (const Setting& setting : settings)
    EXPECT_TRUE(names.insert(setting.name).second) << setting.name << " twice";
  for (int octaves = 0; octaves <= 8; ++octaves)
    EXPECT_EQ(names.count("march step 1, light cached every 2, octaves " + std::to_string(octaves) +
                          ", voxels up to 0.25 px, 4 spp"),
              1u)
        << octaves;
  for (const char* part : {"light by the chord", "powder", "texels r8,", "texels r16f", "texels r32f",
                           "up to 4 px", "1/2 of the resolution", "1/4 of the resolution", "shadow step 8",
                           "cube step 1", "dda light cached", "dda shadow step", "reference, 256 spp"})
    EXPECT_TRUE(std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return name.find(part) != std::string::npos;
    })) << part;
  ViewedScene view;
  for (const Setting& setting : settings) {
    const Scene set = withSetting(view, setting).scene;
    EXPECT_EQ(set.lightTransmittance == LightTransmittance::chord, setting.chord);
    EXPECT_EQ(set.powder.on.value_or(false), setting.powder);
  }
}

/// A method whose pictures rise evenly from left to right, whatever their size.
struct Slope : Method {
  void setVolume(const BrickVolume&) override {}
  Picture render(const ViewedScene&, const PictureRequest& request, PictureCost& cost) override {
    Picture picture;
    picture.width = request.width;
    picture.height = request.height;
    for (const char* name :
         {"R", "G", "B", "A", "half1.R", "half1.G", "half1.B", "half2.R", "half2.G", "half2.B"})
      picture.add(name);
    for (size_t plane = 0; plane < picture.planes.size(); ++plane)
      for (size_t i = 0; i < picture.planes[plane].size(); ++i)
        picture.planes[plane][i] = plane == 3
                                       ? 1.0f
                                       : (static_cast<float>(i % static_cast<size_t>(request.width)) + 0.5f) /
                                             static_cast<float>(request.width);
    cost.milliseconds = 1e-3 * request.width * request.height;
    return picture;
  }
};

TEST(Sweep, SmallerPicturesAreEnlargedAndHeldAgainstWhatTheyStandFor) {
  const auto make = [](const MethodOptions&) -> std::unique_ptr<Method> { return std::make_unique<Slope>(); };
  SweepOptions options;
  options.methods = {{"march", "", make}, {"reference", "", make}};
  options.quiet = true;
  options.width = 64;
  options.height = 32;
  const SweepResult result = sweep(BrickVolume{}, ViewedScene{}, options);
  EXPECT_TRUE(result.leftOut.empty());
  size_t smaller = 0;
  for (const Measured& m : result.all) {
    const int coarser = result.settings[m.setting].coarser;
    // Linear but for the outermost half pixels of the smaller picture, which are held.
    EXPECT_LE(m.error.relativeRmse, coarser == 1 ? 1e-6 : 0.01 * coarser);
    smaller += coarser > 1 ? 1 : 0;
  }
  EXPECT_EQ(smaller, 2u);
}

/// A method whose first picture of each camera takes long.
struct Cold : Slope {
  Picture render(const ViewedScene& view, const PictureRequest& request, PictureCost& cost) override {
    Picture picture = Slope::render(view, request, cost);
    cost.milliseconds = view.camera.position == last ? 1.0 : 1000.0;
    last = view.camera.position;
    return picture;
  }
  glm::dvec3 last{1e9};
};

TEST(Sweep, PicturesAreTimedWarm) {
  SweepOptions options;
  options.methods = {
      {"march", "", [](const MethodOptions&) -> std::unique_ptr<Method> { return std::make_unique<Cold>(); }},
      {"reference", "",
       [](const MethodOptions&) -> std::unique_ptr<Method> { return std::make_unique<Slope>(); }}};
  options.chartsTruth = false;
  options.quiet = true;
  const SweepResult result = sweep(BrickVolume{}, ViewedScene{}, options);
  ASSERT_FALSE(result.single.empty());
  for (const Measured& m : result.single) EXPECT_EQ(m.milliseconds, 1.0) << m.view;
}

TEST(Figures, HaveTheirDigits) {
  EXPECT_EQ(number(1.0 / 3.0), "0.33333");
  EXPECT_EQ(number(1.0 / 3.0, 2), "0.33");
  EXPECT_EQ(percent(0.0234567), "2.35%");
  EXPECT_EQ(percent(0.0), "0%");
}

TEST(Chart, CellsAreQuotedWhereCommasWouldSplitThem) {
  EXPECT_EQ(csvText({{"a", "b"}, {{"1,5", "say \"hi\""}, {"x", ""}}}),
            "a,b\n\"1,5\",\"say \"\"hi\"\"\"\nx,\n");
}

TEST(Chart, TitlesCannotEndTheScriptsText) {
  const std::string script =
      gnuplotScript({{"it's; system 'x'\n!", "x", "y", {{"s", {{1, 2, 1, 3}}, false}}}}, "svg", "o.svg");
  EXPECT_NE(script.find("set title 'it''s; system ''x'' !' noenhanced"), std::string::npos);
  EXPECT_NE(script.find("1 2 1 3"), std::string::npos);
}

TEST(Chart, PanelsStandTwoInARowWithTheirNotesBelowTheirTitles) {
  ChartPanel panel{"title", "x", "y", {{"s", {{1, 2, 1, 3}}, false}}, "it's a note"};
  const std::string script = gnuplotScript({panel, panel, panel}, "svg", "o.svg");
  EXPECT_NE(script.find("set title 'title'.\"\\n\".'it''s a note' noenhanced"), std::string::npos) << script;
  EXPECT_NE(script.find("size 1280,960"), std::string::npos) << script;
  EXPECT_NE(script.find("layout 2,2"), std::string::npos) << script;
}

}  // namespace
}  // namespace nephele
