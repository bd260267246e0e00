// Recipes: what is read, what is refused and where, what the recipe hash sees.
#include "bake/pipeline.h"

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>
#include <fstream>

#include "bake/field_examples.h"
#include "tests/scratch_folder.h"

namespace nephele::test {
namespace {

/// A recipe in a file that goes with the object.
class RecipeFile {
 public:
  explicit RecipeFile(const std::string& text)
      : path_(std::filesystem::temp_directory_path() /
              ("nephele_recipe_" +
               std::to_string(std::chrono::steady_clock::now().time_since_epoch().count()) + ".yaml")) {
    std::ofstream(path_) << text;
  }
  ~RecipeFile() { std::filesystem::remove(path_); }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

Pipeline load(const std::string& text) { return loadPipeline(RecipeFile(text).path()); }

/// A recipe whose only asset has this density, given in flow style.
std::string withDensity(const std::string& density) {
  return "assets:\n  puff:\n    voxel_size: 0.1\n    density: " + density + "\n";
}

/// All complaints about a recipe as "line:column: sentence; hint"; empty where it loads.
std::vector<std::string> complaints(const std::string& text) {
  try {
    load(text);
  } catch (const InputError& error) {
    std::vector<std::string> list;
    for (const Diagnostic& d : error.diagnostics())
      list.push_back(std::to_string(d.where.line) + ":" + std::to_string(d.where.column) + ": " + d.sentence +
                     (d.hint.empty() ? "" : "; " + d.hint));
    return list;
  }
  return {};
}

std::string onlyComplaint(const std::string& text) {
  const auto list = complaints(text);
  EXPECT_EQ(list.size(), 1u) << text;
  return list.empty() ? "" : list.front();
}

TEST(Pipeline, ReadsAnAssetWithDefaults) {
  const Pipeline pipeline = load("up_axis: y\n" + withDensity("{ sphere: { radius: 2 } }"));
  ASSERT_EQ(pipeline.assets.size(), 1u);
  const Asset& asset = pipeline.assets.front();
  EXPECT_EQ(pipeline.upAxis, 'y');
  EXPECT_EQ(asset.name, "puff");
  EXPECT_EQ(asset.precision, Precision::half);
  EXPECT_DOUBLE_EQ(asset.cutoff, 0.001);
  EXPECT_EQ(asset.densityStep, 0.0);
  EXPECT_EQ(asset.density->row->name, "sphere");
  EXPECT_DOUBLE_EQ(std::get<double>(asset.density->values.at("radius")), 2.0);
  EXPECT_DOUBLE_EQ(std::get<double>(asset.density->values.at("falloff")), 1.0);
}

TEST(Pipeline, NumbersNamesAndListsStandForFields) {
  const Pipeline pipeline =
      load("fields:\n  ball: { sphere: { radius: 3 } }\n" + withDensity("{ multiply: [ball, 0.5, fbm] }"));
  const auto& inputs = pipeline.assets.front().density->children.at("inputs");
  ASSERT_EQ(inputs.size(), 3u);
  EXPECT_DOUBLE_EQ(std::get<double>(inputs[0]->values.at("radius")), 3.0);
  EXPECT_EQ(inputs[1]->row->name, "constant");
  EXPECT_EQ(inputs[2]->row->name, "fbm");
}

TEST(Pipeline, ABareListLeavesOtherParametersAtTheirDefaults) {
  const Pipeline pipeline = load(withDensity("{ smooth_union: [sphere, 0.5] }"));
  EXPECT_DOUBLE_EQ(std::get<double>(pipeline.assets.front().density->values.at("blend")), 0.3);
}

struct Case {
  const char* density;
  const char* complaint;
};

TEST(Pipeline, RefusesBadFieldsWithPlaceAndSentence) {
  const Case cases[] = {
      {"{ perlim: { } }", "4:16: unknown field 'perlim'; did you mean 'perlin'?"},
      {"nowhere", "4:14: unknown field 'nowhere'"},
      {"{ sphere: { radius: -1 } }", "4:34: 'radius' of 'sphere' must be greater than 0"},
      {"{ sphere: { radius: big } }", "4:34: 'radius' of 'sphere' must be a number, found 'big'"},
      {"{ sphere: { radius: .nan } }", "4:34: 'radius' of 'sphere'"},
      {"{ sphere: { radios: 1 } }", "4:26: "},
      {"{ sphere: { center: [1, 2] } }", "4:34: 'center' of 'sphere'"},
      {"{ remap: { input: 1, from: [2, 2] } }", "4:35: both ends of 'from' are equal"},
      {"{ warp: { warp_scale: 1 } }", "4:16: 'warp' needs 'input'"},
      {"{ multiply: [] }", "4:26: 'multiply' takes a list of at least one field, not an empty list"},
      {"{ fbm: { octaves: 2.5 } }", "4:32: 'octaves' of 'fbm'"},
      {"{ fbm: { period: 4, lacunarity: 2.5 } }", "4:34: a noise with a period needs a whole lacunarity"},
      {"{ height_profile: { base: 1, top: 1 } }", "4:43: 'base' and 'top' are equal"},
      {"{ height_profile: { curve: [[1, 0], [0, 1]] } }",
       "4:50: the points of 'curve' of 'height_profile' must have growing"},
      {"{ capsule: { radius: 0 } }", "4:35: 'radius' of 'capsule' must be greater than 0"},
      {"{ ellipsoid: { radii: [1, 0, 1] } }", "4:40: 'radii' of 'ellipsoid' must be greater than 0"},
      {"{ ellipsoid: { radii: [1, 1e-40, 1] } }", "4:29: 'radii' must lie between 1e-15 and 1e15"},
      {"{ box: { size: [1, 2, 1], rounding: 0.6 } }", "4:40: 'rounding' must not exceed half"},
      {"{ torus: { minor: -.inf } }", "4:32: 'minor' of 'torus'"},
      {"{ plane: { normal: up } }", "4:33: 'normal' of 'plane'"},
      {"{ linear: { from: 2, to: 2 } }", "4:35: 'from' and 'to' are equal"},
      {"{ exponential: { scale_height: 0 } }",
       "4:45: 'scale_height' of 'exponential' must be greater than 0"},
      {"{ exponential: { below: nothin } }",
       "4:38: 'below' of 'exponential' has no choice 'nothin'; did you mean"},
      {"{ smooth_union: { inputs: [1], blend: -1 } }", "4:52: 'blend' of 'smooth_union'"},
      {"{ difference: [] }", "4:28: 'difference' takes a list of at least one field"},
      {"{ cauliflower: { count: 200 } }", "4:31: 'scales' and 'count' ask for 8040200 bubbles"},
      {"{ mesh: { } }", "4:16: 'mesh' needs 'file'"},
      {"{ mesh: { file: 7.obj } }", "4:30: 'file' of 'mesh' names no file: "},
      {"{ weather_map: { file: . } }", "4:37: 'file' of 'weather_map' names no file: "},
      {"{ sphere: {}, fbm: {} }", "4:14: 'density' must be one field"},
  };
  for (const Case& c : cases) {
    const std::string complaint = onlyComplaint(withDensity(c.density));
    EXPECT_EQ(complaint.rfind(c.complaint, 0), 0u)
        << c.density << "\n  said:     " << complaint << "\n  expected: " << c.complaint;
  }
}

TEST(Pipeline, TellsAllErrorsAtOnceInOrder) {
  const auto list = complaints(
      "assets:\n  a:\n    voxel_size: -1\n    density: { perlim: {} }\n    colour: red\n  b: {}\n");
  ASSERT_EQ(list.size(), 5u);
  EXPECT_EQ(list[0].rfind("3:17: ", 0), 0u) << list[0];
  EXPECT_EQ(list[1].rfind("4:16: unknown field 'perlim'", 0), 0u) << list[1];
  EXPECT_EQ(list[2].rfind("5:5: ", 0), 0u) << list[2];
  EXPECT_EQ(list[3].rfind("6:3: ", 0), 0u) << list[3];
}

TEST(Pipeline, RefusesWhatIsContradictoryOrNotBuilt) {
  EXPECT_NE(onlyComplaint("assets: { a: { voxel_size: 1, tolerance: 3%, density: 1 } }")
                .find("both 'voxel_size' and 'tolerance'"),
            std::string::npos);
  EXPECT_NE(onlyComplaint("assets: { a: { tolerance: 120%, density: 1 } }").find("between 0 and 100%"),
            std::string::npos);
  EXPECT_NE(
      onlyComplaint("assets: { a: { voxel_size: 1, particles: {} } }").find("at least one of 'emitters'"),
      std::string::npos);
  EXPECT_NE(onlyComplaint("assets: { cloud_9: { voxel_size: 1, density: 1 } }").find("no digit at the end"),
            std::string::npos);
  EXPECT_NE(onlyComplaint("assets: { a: { voxel_size: 1, density: 1, frames: 8-2 } }").find("A-B"),
            std::string::npos);
}

TEST(Pipeline, ADensityStepIsAPowerOfTwoOrNone) {
  const auto with = [](const std::string& keys) {
    return "assets: { a: { " + keys + ", density: sphere } }";
  };
  const Pipeline pipeline = load(with("voxel_size: 1, density_step: 0.0625"));
  const Asset& asset = pipeline.assets.front();
  EXPECT_EQ(asset.densityStep, 0.0625);
  const Pipeline none = load(with("voxel_size: 1"));
  EXPECT_NE(recipeHash(pipeline, asset), recipeHash(none, none.assets.front()));
  EXPECT_TRUE(load(with("tolerance: 3%, density_step: 0")).assets.front().densityStepGiven);
  const std::pair<const char*, const char*> cases[] = {
      {"voxel_size: 1, density_step: 0.05",
       "1:31: 'density_step' must be 0 or a power of two from 2^-24 to 2^15; for "
       "example 0.03125"},
      {"voxel_size: 1, density_step: 65536", "for example 32768"},
      {"voxel_size: 1, density_step: -1", "'density_step' must be at least 0, found -1"},
      {"tolerance: 3%, density_step: 0.5", "'tolerance' chooses 'density_step'"}};
  for (const auto& [keys, sentence] : cases)
    EXPECT_NE(onlyComplaint(with(keys)).find(sentence), std::string::npos) << onlyComplaint(with(keys));
}

TEST(Pipeline, ACycleIsAnErrorWithItsPath) {
  const auto list = complaints(
      "fields:\n  a: { add: [b, 1] }\n  b: { max: [c] }\n  c: { multiply: [a, 2] }\n" + withDensity("a"));
  ASSERT_EQ(list.size(), 1u);
  EXPECT_NE(list[0].find("a -> b -> c -> a"), std::string::npos) << list[0];
}

/// Named fields f00 to f`last`, each made by `line` of two of the one before.
std::string doubling(const char* line, int last) {
  std::string text;
  for (int n = 1; n <= last; ++n) {
    char filled[96];
    std::snprintf(filled, sizeof filled, line, n, n, n - 1, n - 1);
    text += filled;
  }
  return text;
}

TEST(Pipeline, AliasesOfAliasesAreCountedAndRefused) {
  // 2^40 fields if every path were walked, in sums and in mixes, by aliases and by names.
  const std::pair<const char*, const char*> bombs[] = {
      {"  f00: &f00 { add: [1, 1] }\n", "  f%02d: &f%02d { add: [*f%02d, *f%02d] }\n"},
      {"  f00: &f00 sphere\n", "  f%02d: &f%02d { mix: { a: *f%02d, b: *f%02d, t: 1 } }\n"},
      {"  f00: &f00 sphere\n", "  f%02d: &f%02d { add: [f%02d, f%02d] }\n"}};
  for (const auto& [first, line] : bombs) {
    const std::string fields = std::string("fields:\n") + first;
    const auto list = complaints(fields + doubling(line, 40) + withDensity("f40"));
    ASSERT_EQ(list.size(), 1u);
    EXPECT_NE(list[0].find("fields, counting each use of a name or an alias"), std::string::npos) << list[0];
    // 2^10 are legal, each built once.
    const Pipeline pipeline = load(fields + doubling(line, 10) + withDensity("f10"));
    EXPECT_NE(buildField(*pipeline.assets.front().density, {0.1, 2, 0, nullptr}), nullptr);
    EXPECT_EQ(recipeHash(pipeline, pipeline.assets.front()).size(), 32u);
  }
}

TEST(Pipeline, RefusesFieldsNestedTooDeepThroughNames) {
  // In either order of reading: from the top down, or each upon the last.
  for (const bool rising : {false, true}) {
    constexpr int kChain = 10000;
    std::string text = "fields:\n";
    for (int n = 0; n < kChain; ++n) {
      char line[64];
      const int name = rising ? kChain - n : n;
      std::snprintf(line, sizeof line, "  n%05d: { add: [n%05d, 1] }\n", name, rising ? name - 1 : name + 1);
      text += line;
    }
    text += rising ? "  n00000: sphere\n" : "  n10000: sphere\n";
    const auto list = complaints(text + withDensity(rising ? "n00001" : "n00000"));
    ASSERT_FALSE(list.empty());
    EXPECT_NE(list.front().find("nested deeper than 100 levels"), std::string::npos) << list.front();
    EXPECT_LT(list.size(), 300u);
  }
}

TEST(RecipeHash, SeesContentAndNotSpelling) {
  const auto hash = [](const std::string& text) {
    const Pipeline pipeline = load(text);
    return recipeHash(pipeline, pipeline.assets.front());
  };
  const std::string plain = hash(withDensity("{ multiply: [{ sphere: { radius: 1 } }, 0.5] }"));
  EXPECT_EQ(plain, hash("fields: { ball: { sphere: { falloff: 1.0 } } }\n" +
                        withDensity("{ multiply: { inputs: [ball, { constant: { value: 5e-1 } }] } }")));
  EXPECT_NE(plain, hash(withDensity("{ multiply: [{ sphere: { radius: 1.001 } }, 0.5] }")));
  EXPECT_NE(plain, hash(withDensity("{ multiply: [0.5, { sphere: { radius: 1 } }] }")));
  EXPECT_NE(plain, hash("seed: 1\n" + withDensity("{ multiply: [{ sphere: { radius: 1 } }, 0.5] }")));
}

/// A recipe beside a mesh; its name in the recipe is relative to it.
struct RecipeWithMesh {
  explicit RecipeWithMesh(const std::string& mesh) {
    std::filesystem::create_directory(folder.file("models"));
    folder.write("models/m.obj", mesh);
    recipe = folder.write("r.yaml", withDensity("{ mesh: { file: models/m.obj } }"));
  }
  ScratchFolder folder;
  std::string recipe;
};

TEST(Files, LieRelativeToTheRecipeAndTheirContentIsInItsHash) {
  const RecipeWithMesh cube(examples::cubeAsObj(0.5)), same(examples::cubeAsObj(0.5)),
      other(examples::cubeAsObj(0.6));
  const auto hash = [](const RecipeWithMesh& files) {
    const Pipeline pipeline = loadPipeline(files.recipe);
    return recipeHash(pipeline, pipeline.assets.front());
  };
  EXPECT_EQ(hash(cube), hash(same));
  EXPECT_NE(hash(cube), hash(other));
  const Pipeline pipeline = loadPipeline(cube.recipe);
  const FieldPtr field = buildField(*pipeline.assets.front().density, {0.1, 2, 0, nullptr});
  EXPECT_NEAR(field->support().high.x, 0.5, 1e-6);
}

TEST(Files, ComplaintsNameTheFileAndStandBesideThoseOfTheRecipe) {
  const RecipeWithMesh files("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  files.folder.write("r.yaml", withDensity("{ add: [{ mesh: { file: models/m.obj } }, perlim] }"));
  try {
    loadPipeline(files.recipe);
    ADD_FAILURE() << "accepted";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    const std::string all = error.what();
    EXPECT_NE(all.find("m.obj: error: is not closed: 3 open edges"), std::string::npos) << all;
    EXPECT_NE(all.find("unknown field 'perlim'"), std::string::npos) << all;
  }
}

std::string looped(const std::string& keys, const std::string& density) {
  return "assets:\n  puff:\n    voxel_size: 0.1\n" + keys + "    density: " + density + "\n";
}

TEST(Loop, MeansTheFrameRangeOrANumberOfFrames) {
  const auto framesOf = [](const std::string& loop) {
    return load(looped("    frames: 5-28\n    loop: " + loop + "\n", "sphere")).assets.front().loopFrames;
  };
  EXPECT_EQ(framesOf("true"), 24);
  EXPECT_EQ(framesOf("12"), 12);
  EXPECT_EQ(framesOf("false"), std::nullopt);
  EXPECT_EQ(onlyComplaint(looped("    loop: 12\n", "sphere")),
            "4:5: 'loop' needs 'frames', the range that is baked");
  EXPECT_NE(onlyComplaint(looped("    frames: 1-2\n    loop: often\n", "sphere")).find("5:11: 'loop'"),
            std::string::npos);
  EXPECT_NE(onlyComplaint(looped("    frames: 1-2\n    loop: 0\n", "sphere")).find("5:11: 'loop'"),
            std::string::npos);
}

TEST(Loop, RefusesWhatCannotCloseAndSaysWhatWould) {
  const std::string keys = "    frames: 1-24\n    loop: true\n";
  const auto complaint = [&](const std::string& density) { return onlyComplaint(looped(keys, density)); };
  EXPECT_NE(
      complaint("{ multiply: [sphere, { fbm: { scroll: [1, 0, 0] } }] }").find("6:44: 'scroll' moves a"),
      std::string::npos);
  EXPECT_NE(complaint("{ perlin: { period: 8, scroll: [0, 0.5, 0] } }").find("give 0, 8 or a multiple"),
            std::string::npos);
  EXPECT_NE(complaint("{ perlin: { evolve: 0.2 } }").find("6:26: 'evolve' of 0.2 does not make half a turn"),
            std::string::npos);
  EXPECT_EQ(complaints(looped(keys, "{ perlin: { period: 8, scroll: [0, 4.1, 0], evolve: -0.6 } }")),
            std::vector<std::string>{});
}

TEST(Transform, ReadsItsInputAtTheVoxelsOfItsOwnSpace) {
  // Cells of 1 shrunk to 0.1 along one axis are 1 voxel there, and 100 where they are stretched.
  const auto octaves = [](const std::string& scale) {
    const Pipeline pipeline = load("fields: { n: { fbm: { octaves: 1 } } }\n" +
                                   withDensity("{ transform: { input: n, scale: " + scale + " } }"));
    std::vector<BandLimitNote> notes;
    BuildContext context = contextOf(pipeline, pipeline.assets.front());
    context.notes = &notes;
    buildField(*pipeline.assets.front().density, context);
    return notes.empty() ? 1.0 : notes.front().weight;
  };
  EXPECT_EQ(octaves("[1, 1, 1]"), 1.0);
  EXPECT_EQ(octaves("[10, 1, 0.1]"), 0.0);
  EXPECT_EQ(octaves("[10, 10, 10]"), 1.0);
}

TEST(Transform, BombsOfTransformsAreRefused) {
  std::string text = "fields:\n  f00: &f00 { add: [sphere, 1] }\n";
  for (int n = 1; n <= 40; ++n) {
    char line[200];
    std::snprintf(
        line, sizeof line,
        "  f%02d: &f%02d { add: [{ transform: { input: *f%02d, scale: [1.%02d, 2, 2] } }, *f%02d] }\n", n, n,
        n - 1, n, n - 1);
    text += line;
  }
  EXPECT_THROW(load(text + withDensity("{ multiply: [sphere, *f40] }")), InputError);
}

TEST(Loop, RefusesATransformThatScrolls) {
  EXPECT_NE(onlyComplaint(looped("    frames: 1-24\n    loop: true\n",
                                 "{ transform: { input: sphere, scroll: [1, 0, 0] } }"))
                .find("'scroll' carries its input away"),
            std::string::npos);
}

TEST(Frames, ReadsRangesAndNothingElse) {
  ASSERT_TRUE(parseFrames("3-12"));
  EXPECT_EQ(parseFrames("3-12")->last, 12);
  EXPECT_EQ(parseFrames("7")->first, 7);
  for (const char* text : {"", "-", "3-", "-3", "12-3", "1-2-3", "1 - 2", "a-b", "99999999999"})
    EXPECT_FALSE(parseFrames(text)) << text;
}

}  // namespace
}  // namespace nephele::test
