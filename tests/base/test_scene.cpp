// Scenes: defaults of the contract, both ways through YAML, every refusal.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <numbers>

#include "base/error.h"
#include "scene/scene.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

Scene sceneOf(const std::string& text) {
  Diagnostics out;
  const yaml::NodePtr node = yaml::parse(text, "s");
  const Scene scene = readScene(*node, out);
  out.throwIfAny();
  return scene;
}

std::string complaintOf(const std::string& text) {
  try {
    sceneOf(text);
    return "";
  } catch (const InputError& error) {
    return error.what();
  }
}

TEST(Scene, DefaultsAreTheContracts) {
  const Scene scene = sceneOf("");
  EXPECT_FALSE(scene.camera || scene.medium);
  ASSERT_EQ(scene.lights.size(), 1u);
  const Sun sun = std::get<Sun>(scene.lights[0]);
  const glm::dvec3 expected = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));
  EXPECT_NEAR(glm::length(sun.toLight - expected), 0.0, 1e-15);
  EXPECT_NEAR(glm::length(sun.toLight), 1.0, 1e-15);
  EXPECT_EQ(scene.look, Look::physical);
  const Scene filled = sceneOf("camera: {}\nmedium: {}\n");
  EXPECT_EQ(filled.camera->fov, 35.0 * (std::numbers::pi / 180.0));
  EXPECT_EQ(filled.camera->fov, Camera{}.fov);
  EXPECT_FALSE(filled.cameraUpGiven);
  EXPECT_EQ(filled.medium->sigmaS, (Rgb{8.0, 8.0, 8.0}));
  EXPECT_TRUE(sceneOf("lights: []").lights.empty());
  EXPECT_EQ(scene.environment.kind, Environment::Kind::constant);
  EXPECT_EQ(scene.environment.constant, (Rgb{0.0, 0.0, 0.0}));
  EXPECT_FALSE(scene.silverLining.on || scene.powder.on || scene.emission.on || scene.octaves.count);
  EXPECT_FALSE(scene.backdrop);
  EXPECT_FALSE(scene.lightsFollowUp);
}

TEST(Scene, ReadsEveryKey) {
  const Scene scene = sceneOf(
      "camera: { position: [1, 2, 3], target: [4, 5, 6], up: [0, 1, 0], fov: 90 }\n"
      "medium: { sigma_s: 2, sigma_a: [0.1, 0.2, 0.3], g: -0.5 }\n"
      "octaves: { count: 3, a: 0.1, b: 0.2, c: 0.3, d: 0.4 }\n"
      "lights:\n  - sun: { to_light: [0, 0, 5], irradiance: 2 }\n"
      "  - point: { position: [7, 8, 9], intensity: [1, 2, 3] }\n"
      "environment: { constant: [0.5, 0.6, 0.7], show: true }\n"
      "background: { bottom: 0.25, top: [0.1, 0.2, 0.3] }\n"
      "phase: { silver_lining: { in_s: 0.9, out_s: 0.2, blend: 0.1 } }\npowder: { on: auto, o_sa: 2 }\n"
      "light_transmittance: chord\nemission: { on: false, scale: 3, temperature_scale: 2000, grid: heat }\n"
      "look: report\nmarch: { step: 0.25, shadow_step: 2, adaptive: false, cache: 3, cache_near_steps: 2 "
      "}\n");
  EXPECT_EQ(scene.camera->target, glm::dvec3(4, 5, 6));
  EXPECT_TRUE(scene.cameraUpGiven);
  EXPECT_NEAR(scene.camera->fov, std::numbers::pi / 2.0, 1e-15);
  EXPECT_EQ(scene.medium->sigmaS, (Rgb{2, 2, 2}));
  EXPECT_EQ(scene.medium->sigmaA, (Rgb{0.1, 0.2, 0.3}));
  EXPECT_EQ(scene.octaves.count, 3);
  EXPECT_EQ(scene.octaves.d, 0.4);
  EXPECT_EQ(std::get<Sun>(scene.lights[0]).toLight, glm::dvec3(0, 0, 1));
  EXPECT_EQ(std::get<PointLight>(scene.lights[1]).intensity, (Rgb{1, 2, 3}));
  EXPECT_TRUE(scene.environment.show);
  EXPECT_EQ(scene.backdrop->bottom, (Rgb{0.25, 0.25, 0.25}));
  EXPECT_EQ(scene.silverLining.on, Switch(true));
  EXPECT_EQ(scene.silverLining.inS, 0.9);
  EXPECT_EQ(scene.silverLining.outS, 0.2);
  EXPECT_EQ(scene.silverLining.blend, 0.1);
  EXPECT_EQ(scene.powder.on, Switch());
  EXPECT_EQ(scene.powder.oSa, 2.0);
  EXPECT_EQ(scene.lightTransmittance, LightTransmittance::chord);
  EXPECT_EQ(scene.emission.on, Switch(false));
  EXPECT_EQ(scene.emission.scale, 3.0);
  EXPECT_EQ(scene.emission.temperatureScale, 2000.0);
  EXPECT_EQ(scene.emission.grid, "heat");
  EXPECT_EQ(scene.look, Look::report);
  EXPECT_EQ(scene.march.stepVoxels, 0.25);
  EXPECT_EQ(scene.march.shadowStepVoxels, 2.0);
  EXPECT_FALSE(scene.march.adaptive);
  EXPECT_TRUE(scene.march.lightCache);
  EXPECT_EQ(scene.march.cacheVoxels, 3.0);
  EXPECT_EQ(scene.march.cacheNearSteps, 2);
}

TEST(Scene, EnvironmentsOfEachKind) {
  const Environment ramp =
      sceneOf(
          "environment: { ramp: { ground: 0.1, horizon: [1, 2, 3], zenith: [0, 0, 1], cloudiness: 0.7, "
          "intensity: 2 } }")
          .environment;
  EXPECT_EQ(ramp.kind, Environment::Kind::ramp);
  EXPECT_EQ(ramp.ramp.ground, (Rgb{0.1, 0.1, 0.1}));
  EXPECT_EQ(ramp.ramp.horizon, (Rgb{1, 2, 3}));
  EXPECT_EQ(ramp.ramp.zenith, (Rgb{0, 0, 1}));
  EXPECT_EQ(ramp.ramp.cloudiness, 0.7);
  EXPECT_EQ(ramp.ramp.intensity, 2.0);
  const Environment exr =
      sceneOf("environment: { exr: { path: a/b.exr, rotation: 90, intensity: 3 } }").environment;
  EXPECT_EQ(exr.kind, Environment::Kind::exr);
  EXPECT_EQ(exr.exr.path, "a/b.exr");
  EXPECT_NEAR(exr.exr.rotation, std::numbers::pi / 2.0, 1e-15);
  EXPECT_EQ(exr.exr.intensity, 3.0);
  EXPECT_EQ(sceneOf("environment: { ramp: {} }").environment.kind, Environment::Kind::ramp);
  EXPECT_EQ(sceneOf("environment: { exr: sky.exr }").environment.exr.path, "sky.exr");
}

TEST(Scene, PathsAreRelativeToTheFileThatHoldsThem) {
  const ScratchFolder scratch;
  const std::string scene = scratch.write("s.yaml", "environment: { exr: sky.exr }\n");
  EXPECT_EQ(loadScene(scene).environment.exr.path, scratch.file("sky.exr"));
  const std::string text = writeScene(loadScene(scene), std::filesystem::path(scene).parent_path().string());
  EXPECT_NE(text.find("path: \"sky.exr\""), std::string::npos) << text;
  const std::string elsewhere = scratch.write("t.yaml", "environment: { exr: /far/sky.exr }\n");
  EXPECT_EQ(loadScene(elsewhere).environment.exr.path, "/far/sky.exr");
}

TEST(Scene, WrittenAndReadIsTheSame) {
  for (const char* text :
       {"", "lights: []\n", "look: report\ncamera: { fov: 1e-3 }\n",
        "phase: { silver_lining: {} }\npowder: { on: auto, o_sa: 0.7 }\nlight_transmittance: chord\n",
        "phase: { silver_lining: { on: false, in_s: 0.1, out_s: 0, blend: 1 } }\npowder: { on: false }\n",
        "emission: { scale: 0.3, grid: 'a \"b\" \\c' }\noctaves: { count: auto, b: 0.1, d: 0.3 }\n",
        "environment: { ramp: { ground: 0.1, cloudiness: 0.3, intensity: 0.7 }, show: true }\n",
        "environment: { exr: { path: 'a: b.exr', rotation: 77.7, intensity: 2 } }\n",
        "stage: { floor: false, height: -0.3, checker: auto, penumbra: 0 }\n",
        "stage: { on: false, chrome_ball: { on: false }, grey_ball: { center: [1, 2, 3], radius: 0.1 },\n"
        "  chrome_cube: { center: auto, edge: 2 }, highlights: false, height: auto, checker: 0.1 }\n",
        "camera: { position: [0.1, -1e-9, 1e9], up: [1, 1, 0], fov: 77.7 }\nmedium: { sigma_s: 0.3, g: 0.999 "
        "}\n"
        "octaves: { count: 2, a: 0.3 }\n"
        "lights:\n  - sun: { to_light: [1, 2, 3], irradiance: [0.1, 0.2, 0.3] }\n"
        "  - sun: { to_light: [1e-200, 0, 3e-200] }\n  - point: { position: [1, 2, 3], intensity: 0.1 }\n"
        "environment: { constant: 0.7, show: true }\nbackground: { top: 0.1 }\nmarch: { step: 0.3, adaptive: "
        "false, precision: r8, level_pixels: 0.7, step_pixels: 0.3, check_skips: true, light_cache: false, "
        "cache: 3.5, "
        "sky_cache: 8, cache_near: "
        "2, "
        "cache_near_steps: 1, give_up: 0.01, cache_depth: 0.7 }\n"}) {
    const Scene scene = sceneOf(text);
    const std::string written = writeScene(scene);
    EXPECT_TRUE(sceneOf(written) == scene) << text << "\nwas written as\n" << written;
  }
}

TEST(Scene, EveryAngleOfAFileSurvivesWriting) {
  for (double fov = 0.1; fov < 180.0; fov += 0.37) {
    const Scene scene = sceneOf("camera: { fov: " + std::to_string(fov) + " }");
    EXPECT_EQ(sceneOf(writeScene(scene)).camera->fov, scene.camera->fov) << fov;
  }
}

TEST(Scene, Refusals) {
  const std::pair<const char*, const char*> cases[] = {
      {"camra: {}", "s:1:1: error: unknown key 'camra' in the scene; did you mean 'camera'?"},
      {"[1]", "s:1:1: error: the scene must be a map, found a list"},
      {"camera: { position: [1, 2, 3], target: [1, 2, 3] }",
       "s:1:11: error: the camera stands on its target; give 'position' and 'target' apart"},
      {"camera: { up: [0, 0, 0] }", "s:1:11: error: 'up' has no length"},
      {"camera: { position: [0, 0, 5], up: [0, 0, -2] }",
       "s:1:32: error: 'up' points along the view; give another axis, such as [0, 1, 0] or [1, 0, 0]"},
      {"camera: { fov: 180 }", "s:1:16: error: 'fov' must be greater than 0 and less than 180, found 180"},
      {"camera: { fov: 0 }", "s:1:16: error: 'fov' must be greater than 0 and less than 180, found 0"},
      {"camera: { position: [1e300, 0, 0] }",
       "s:1:22: error: 'position' must be -1e+15 to 1e+15, found 1e300"},
      {"camera: { position: [1, .nan, 0] }",
       "s:1:25: error: 'position' must be a finite number, found '.nan'"},
      {"medium: { sigma_s: -1 }", "s:1:20: error: 'sigma_s' (or a list of 3) must be 0 to 1e+15, found -1"},
      {"medium: { g: 1 }", "s:1:14: error: 'g' must be greater than -1 and less than 1, found 1"},
      {"octaves: { a: 1.5 }", "s:1:15: error: 'a' must be 0 to 1, found 1.5"},
      {"octaves: { count: 17 }", "s:1:19: error: 'count' must be 0 to 16, found 17"},
      {"lights: { sun: {} }", "s:1:9: error: 'lights' must be a list, found a map; write [] for no light"},
      {"lights:", "s:1:1: error: 'lights' must be a list, found nothing; write [] for no light"},
      {"lights: [sun]",
       "s:1:10: error: a light must be a map of one key, 'sun' or 'point'; such as: "
       "- sun: { to_light: [0, 0, 1] }"},
      {"lights: [{ son: {} }]", "s:1:12: error: unknown key 'son' in 'lights'; did you mean 'sun'?"},
      {"lights: [{ sun: { to_light: [0, 0, 0] } }]",
       "s:1:19: error: 'to_light' has no length; it points from the cloud to the sun"},
      {"lights: [sun: {}, sun: {}, sun: {}, sun: {}, sun: {}, sun: {}, sun: {}, sun: {}, sun: {}]",
       "s:1:82: error: at most 8 lights are rendered, found 9"},
      {"environment: { ramp: 1 }", "s:1:22: error: 'ramp' must be a map, found '1'"},
      {"environment: { ramp: { cloudyness: 1 } }",
       "s:1:24: error: unknown key 'cloudyness' in 'ramp'; did you mean 'cloudiness'?"},
      {"environment: { ramp: { cloudiness: 1.5 } }", "s:1:36: error: 'cloudiness' must be 0 to 1, found 1.5"},
      {"environment: { exr: {} }",
       "s:1:21: error: 'exr' names no file; write exr: sky.exr, or exr: { path: sky.exr, rotation: 90 }"},
      {"environment: { constant: 1, exr: a.exr }",
       "s:1:29: error: an environment is of one kind, and 'constant' is given already"},
      {"phase: { silver_lining: { in_s: 1 } }",
       "s:1:33: error: 'in_s' must be at least 0 and less than 1, found 1"},
      {"phase: { silver_linning: {} }",
       "s:1:10: error: unknown key 'silver_linning' in 'phase'; did you mean 'silver_lining'?"},
      {"powder: { on: maybe }",
       "s:1:15: error: 'on' must be true, false or auto, found text; auto leaves it to the look"},
      {"powder: { o_sa: -1 }", "s:1:17: error: 'o_sa' must be 0 to 100, found -1"},
      {"light_transmittance: cord",
       "s:1:22: error: 'light_transmittance' must be one of marched, chord, found 'cord'; did you mean "
       "'chord'?"},
      {"emission: { grid: '' }", "s:1:13: error: 'grid' names no grid"},
      {"octaves: { count: many }", "s:1:19: error: 'count' must be a whole number, found 'many'"},
      {"environment: { show: 1 }", "s:1:22: error: 'show' must be true or false, found '1'"},
      {"stage: { checker: 0 }", "s:1:19: error: 'checker' must be greater than 0 and at most 1e+15, found 0"},
      {"stage: { grey_ball: { edge: 1 } }", "s:1:23: error: unknown key 'edge' in 'grey_ball'"},
      {"look: pretty", "s:1:7: error: 'look' must be one of physical, report, found 'pretty'"},
      {"march: { step: 0 }", "s:1:16: error: 'step' must be 0.01 to 100, found 0"}};
  for (const auto& [text, sentence] : cases) EXPECT_EQ(complaintOf(text), sentence) << text;
}

TEST(Scene, AllErrorsOfOneFileAtOnce) {
  EXPECT_EQ(complaintOf("look: pretty\ncamera: { fov: 500 }\nmarch: { stp: 1 }\n"),
            "s:1:7: error: 'look' must be one of physical, report, found 'pretty'\n"
            "s:2:16: error: 'fov' must be greater than 0 and less than 180, found 500\n"
            "s:3:10: error: unknown key 'stp' in 'march'; did you mean 'step'?");
}

TEST(Scene, LoadsTheSceneOfAnyFileThatHasOne) {
  const ScratchFolder scratch;
  const std::string pipeline = scratch.write("p.yaml", "assets: { a: {} }\nscene: { look: report }\n");
  EXPECT_EQ(loadScene(pipeline).look, Look::report);
  EXPECT_EQ(loadScene(scratch.write("s.yaml", "look: report\n")).look, Look::report);
  EXPECT_EQ(loadScene(scratch.write("e.yaml", "scene:\n")).look, Look::physical);
  EXPECT_THROW(loadScene(scratch.write("w.yaml", "scene: { lok: report }\n")), InputError);
  EXPECT_THROW(loadScene(scratch.write("a.yaml", "assets: {}\n")), InputError);
  EXPECT_THROW(loadScene(scratch.file("missing.yaml")), InputError);
}

}  // namespace
}  // namespace nephele
