// The panel, built without a window and read as text: every key of a scene has a widget.
#include <gtest/gtest.h>
#include <imgui.h>

#include <map>
#include <set>

#include "base/yaml.h"
#include "preview/app/panel_parts.h"
#include "tests/scratch_folder.h"

namespace nephele {
namespace {

/// What stands beside the widget of each key that a scene may hold. `camera` is moved by hands.
const std::map<std::string, std::string> kLabels{
    {"medium.sigma_s", "scattering"},
    {"medium.sigma_a", "absorption"},
    {"medium.g", "g"},
    {"phase.silver_lining.on", "silver lining"},
    {"phase.silver_lining.in_s", "towards the light"},
    {"phase.silver_lining.out_s", "away from it"},
    {"phase.silver_lining.blend", "blend"},
    {"powder.on", "powder"},
    {"powder.o_sa", "strength"},
    {"light_transmittance", "shadows by the chord"},
    {"octaves.count", "orders"},
    {"octaves.a", "a extinction"},
    {"octaves.b", "b scattering"},
    {"octaves.c", "c asymmetry"},
    {"octaves.d", "d openness"},
    {"emission.on", "emission"},
    {"emission.scale", "scale"},
    {"emission.temperature_scale", "kelvin per unit"},
    {"emission.grid", "temperatures"},
    {"lights.sun.to_light", "azimuth"},
    {"lights.sun.irradiance", "irradiance"},
    {"lights.point.position", "position"},
    {"lights.point.intensity", "intensity"},
    {"environment.constant", "radiance"},
    {"environment.ramp.ground", "ground"},
    {"environment.ramp.horizon", "horizon"},
    {"environment.ramp.zenith", "zenith"},
    {"environment.ramp.cloudiness", "cloudiness"},
    {"environment.ramp.intensity", "intensity"},
    {"environment.exr.path", "sky.exr"},
    {"environment.exr.rotation", "rotation"},
    {"environment.exr.intensity", "intensity"},
    {"environment.show", "in every picture"},
    {"background.bottom", "bottom"},
    {"background.top", "top"},
    {"stage.on", "stage"},
    {"stage.floor", "floor"},
    {"stage.height", "height"},
    {"stage.checker", "squares"},
    {"stage.chrome_ball.on", "chrome ball"},
    {"stage.chrome_ball.center", "centre"},
    {"stage.chrome_ball.radius", "radius"},
    {"stage.grey_ball.on", "grey ball"},
    {"stage.grey_ball.center", "centre"},
    {"stage.grey_ball.radius", "radius"},
    {"stage.chrome_cube.on", "chrome cube"},
    {"stage.chrome_cube.center", "centre"},
    {"stage.chrome_cube.edge", "edge"},
    {"stage.highlights", "highlights"},
    {"stage.penumbra", "shadow edge"},
    {"look", "report"},
    {"march.step", "step"},
    {"march.shadow_step", "shadow step"},
    {"march.shadow_growth", "shadow growth"},
    {"march.adaptive", "adaptive steps"},
    {"march.light_cache", "light cache"},
    {"march.cache", "light every"},
    {"march.sky_cache", "sky every"},
    {"march.cache_near", "marched first"},
    {"march.cache_depth", "marched above"},
    {"march.cache_near_steps", "in steps"},
    {"march.give_up", "give up below"},
    {"march.check_skips", "check what is skipped"},
    {"march.precision", "precision"},
    {"march.level_pixels", "coarser below"},
    {"march.step_pixels", "steps as of"},
};

void collectKeys(const yaml::Node& node, const std::string& name, std::set<std::string>& keys) {
  bool inner = false;
  for (const yaml::Entry& entry : node.entries) {
    inner = true;
    collectKeys(*entry.value, name.empty() ? entry.key : name + "." + entry.key, keys);
  }
  for (const yaml::NodePtr& item : node.items) {
    if (item->kind == yaml::Kind::scalar) continue;
    inner = true;
    collectKeys(*item, name, keys);
  }
  if (!inner) keys.insert(name);
}

/// Everything on and nothing left open.
Scene fullScene(Environment::Kind kind) {
  Scene scene;
  scene.medium = Medium{};
  scene.silverLining.on = scene.powder.on = scene.emission.on = true;
  scene.octaves.count = 3;
  scene.octaves.factorsGiven = true;
  scene.lights = {Sun{}, PointLight{}};
  scene.environment.kind = kind;
  scene.environment.exr.path = "sky.exr";
  scene.backdrop = BackdropColours{};
  scene.stage.on = scene.stage.cube.on = true;
  return scene;
}

std::string clipboard;

/// All text of the unfolded panel for these settings.
std::string panelText(const Scene& scene) {
  const ScratchFolder folder;
  const VolumeKey key{folder.write("a.vdb", "no volume"), "", ""};
  const auto volume = std::make_shared<const BrickVolume>();
  ReadAhead reader([](const VolumeKey&) { return BrickVolume{}; }, [] {}, 0);
  const Document document(key, volume, std::nullopt, reader);
  UiState state;
  state.settings.scene = scene;
  const UiFacts facts{document, {}, 0, 0.0, 0, 0, {}, {}};
  UiWishes wishes;

  ImGui::CreateContext();
  ImGuiIO& io = ImGui::GetIO();
  io.IniFilename = nullptr;
  io.DisplaySize = {640.0f, 4000.0f};
  io.SetClipboardTextFn = [](void*, const char* text) { clipboard = text; };
  unsigned char* pixels = nullptr;
  int width = 0, height = 0;
  io.Fonts->GetTexDataAsAlpha8(&pixels, &width, &height);
  ImGui::NewFrame();
  ImGui::Begin("panel");
  for (const char* group :
       {"Lights", "Environment", "Medium", "Light in the cloud", "Stage", "View", "March"}) {
    ImGui::PushID(group);
    ImGui::GetStateStorage()->SetInt(ImGui::GetID(group), 1);
    ImGui::PopID();
  }
  ImGui::LogToClipboard();
  lightParts(state, facts, wishes);
  viewParts(state, facts, wishes);
  ImGui::LogFinish();
  ImGui::End();
  ImGui::EndFrame();
  ImGui::DestroyContext();
  return clipboard;
}

TEST(Panel, EveryKeyOfASceneHasAWidget) {
  using Kind = Environment::Kind;
  std::set<std::string> seen;
  for (const Kind kind : {Kind::constant, Kind::ramp, Kind::exr}) {
    const Scene scene = fullScene(kind);
    std::set<std::string> keys;
    collectKeys(*yaml::parse(writeScene(scene), "scene"), "", keys);
    const std::string text = panelText(scene);
    for (const std::string& key : keys) {
      const auto row = kLabels.find(key);
      ASSERT_NE(row, kLabels.end()) << "'" << key << "' has no row: give it a widget, and name it here";
      EXPECT_NE(text.find(row->second), std::string::npos) << "no '" << row->second << "' for " << key;
    }
    seen.insert(keys.begin(), keys.end());
  }
  EXPECT_EQ(seen.size(), kLabels.size()) << "rows of keys that no scene holds";
}

TEST(Panel, MarksWhatIsNotPhysicalAndLightThatIsMade) {
  Scene scene = fullScene(Environment::Kind::constant);
  scene.octaves.a = 0.3;
  scene.octaves.b = 0.9;  // light comes through that nothing took away
  const std::string marked = panelText(scene);
  EXPECT_NE(marked.find("not physical"), std::string::npos);
  EXPECT_NE(marked.find("makes light"), std::string::npos);
  scene.powder.on = scene.silverLining.on = false;
  scene.octaves.count = 0;
  const std::string plain = panelText(scene);
  EXPECT_EQ(plain.find("not physical"), std::string::npos);
  EXPECT_EQ(plain.find("makes light"), std::string::npos);
}

}  // namespace
}  // namespace nephele
