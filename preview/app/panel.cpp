// Widgets. Depends on imgui, scene and app/orbit_camera.h.
#include "preview/app/panel.h"

#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "preview/app/orbit_camera.h"
#include "scene/light_model.h"

namespace nephele {
namespace {

constexpr float kDegrees = static_cast<float>(180.0 / std::numbers::pi);
constexpr float kPanelWidth = 340.0f;
constexpr float kMargin = 12.0f;
constexpr ImGuiSliderFlags kLogarithmic = ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp;
constexpr ImGuiSliderFlags kLinear = ImGuiSliderFlags_AlwaysClamp;

bool slider(const char* label, double& value, float low, float high, const char* format,
            ImGuiSliderFlags flags) {
  float shown = static_cast<float>(value);
  if (!ImGui::SliderFloat(label, &shown, low, high, format, flags)) return false;
  value = double{shown};
  return true;
}

bool rgbSlider(const char* label, Rgb& value, float high) {
  float shown[3] = {static_cast<float>(value[0]), static_cast<float>(value[1]), static_cast<float>(value[2])};
  if (!ImGui::DragFloat3(label, shown, high * 1e-3f, 0.0f, high, "%.4g", kLinear)) return false;
  for (size_t c = 0; c < value.size(); ++c) value[c] = double{shown[c]};
  return true;
}

Sun* firstSun(Scene& scene) {
  for (Light& light : scene.lights)
    if (Sun* sun = std::get_if<Sun>(&light)) return sun;
  return nullptr;
}

bool sunWidgets(PanelState& state) {
  Sun* sun = firstSun(state.view.scene);
  if (sun == nullptr) {
    ImGui::TextUnformatted("The scene has no sun.");
    return false;
  }
  constexpr float kHalfTurn = 180.0f, kSteepest = 90.0f, kBrightest = 100.0f;
  const Angles angles = anglesOf(sun->toLight, state.up);
  float azimuth = static_cast<float>(angles.azimuth) * kDegrees;
  float elevation = static_cast<float>(angles.elevation) * kDegrees;
  const bool turned = ImGui::SliderFloat("azimuth", &azimuth, -kHalfTurn, kHalfTurn, "%.1f deg", kLinear);
  const bool raised = ImGui::SliderFloat("elevation", &elevation, -kSteepest, kSteepest, "%.1f deg", kLinear);
  if (turned || raised)
    sun->toLight = directionOf({double{azimuth / kDegrees}, double{elevation / kDegrees}}, state.up);
  return rgbSlider("irradiance", sun->irradiance, kBrightest) || turned || raised;
}

bool mediumWidgets(Medium& medium) {
  constexpr float kShare = 4.0f, kMostG = 0.99f;
  // Sliders reach a few times the value they open with.
  static thread_local float reach = 0.0f;
  if (reach == 0.0f)
    reach = kShare * static_cast<float>(std::max({medium.sigmaS[0], medium.sigmaA[0], 1e-6}));
  bool changed = rgbSlider("sigma_s", medium.sigmaS, reach);
  changed |= rgbSlider("sigma_a", medium.sigmaA, reach);
  changed |= slider("g", medium.g, -kMostG, kMostG, "%.3f", kLinear);
  return changed;
}

/// `shown`: the orders in use where the scene leaves them to the look.
bool octaveWidgets(Octaves& octaves, int shown) {
  constexpr int kMost = 8;
  int count = octaves.count.value_or(shown);
  bool changed = ImGui::SliderInt("count", &count, 0, std::max(kMost, count));
  if (changed) octaves.count = count;
  if (count == 0) return changed;
  changed |= slider("a extinction", octaves.a, 0.0f, 1.0f, "%.2f", kLinear);
  changed |= slider("b scattering", octaves.b, 0.0f, 1.0f, "%.2f", kLinear);
  changed |= slider("c asymmetry", octaves.c, 0.0f, 1.0f, "%.2f", kLinear);
  return changed;
}

bool marchWidgets(MarchSettings& march) {
  constexpr float kShortest = 0.05f, kLongest = 16.0f;
  bool changed = slider("step", march.stepVoxels, kShortest, kLongest, "%.2f voxels", kLogarithmic);
  changed |= slider("shadow step", march.shadowStepVoxels, kShortest, kLongest, "%.2f voxels", kLogarithmic);
  changed |= slider("shadow growth", march.shadowGrowth, 1.0f, 2.0f, "%.2f", 0);
  return changed;
}

void statsText(const PanelState& state, const ViewerStats& stats) {
  constexpr double kMebibyte = 1048576.0;
  ImGui::TextUnformatted(state.title.c_str());
  ImGui::Text("moving %.1f ms   at rest %.0f ms a sample", stats.quickMilliseconds, stats.sampleMilliseconds);
  ImGui::Text("%u of %u samples   %.0f densities a pixel", stats.samples, stats.samplesWanted,
              stats.densitySamplesPerPixel);
  ImGui::Text("%.1f MiB on the GPU", static_cast<double>(stats.gpuBytes) / kMebibyte);
  if (stats.raysCutShort > 0.0)
    ImGui::TextWrapped("the driver cut %.0f rays short and the picture is wrong: take longer steps",
                       stats.raysCutShort);
  if (!state.notice.empty()) ImGui::TextWrapped("%s", state.notice.c_str());
}

bool panelWindow(PanelState& state, const ViewerStats& stats) {
  ImGui::SetNextWindowPos({kMargin, kMargin}, ImGuiCond_FirstUseEver);
  ImGui::SetNextWindowSize({kPanelWidth, 0.0f}, ImGuiCond_FirstUseEver);
  bool changed = false;
  if (ImGui::Begin("Nephele")) {
    constexpr float kMostEv = 10.0f;
    ImGui::PushItemWidth(-0.38f * kPanelWidth);  // the rest is for labels
    statsText(state, stats);
    slider("exposure", state.exposureEv, -kMostEv, kMostEv, "%.2f EV", kLinear);
    constexpr ImGuiTreeNodeFlags kOpen = ImGuiTreeNodeFlags_DefaultOpen;
    // Equal names in different groups need identities of their own.
    const auto group = [&](const char* name, const auto& widgets) {
      ImGui::PushID(name);
      if (ImGui::CollapsingHeader(name, kOpen)) changed |= widgets();
      ImGui::PopID();
    };
    group("Sun", [&] { return sunWidgets(state); });
    group("Medium, per unit density per unit length", [&] { return mediumWidgets(state.view.medium); });
    group("Octaves beyond single scattering", [&] {
      return octaveWidgets(state.view.scene.octaves,
                           lightModelOf(state.view.scene, state.view.medium).octaveCount);
    });
    group("March", [&] { return marchWidgets(state.view.scene.march); });
    ImGui::TextDisabled("F1 lists the keys");
    ImGui::PopItemWidth();
  }
  ImGui::End();
  return changed;
}

void helpWindow(bool& open) {
  static constexpr const char* kRows[][2] = {
      {"left drag", "orbit"},
      {"middle drag, shift + left drag", "pan"},
      {"scroll", "zoom"},
      {"F", "frame the cloud"},
      {"R", "back to the first view"},
      {"L", "look: physical or report"},
      {"H", "hide or show the panel"},
      {"F1", "hide or show this list"},
      {"F12", "screenshot, nephele_0001.png and on"},
      {"Q, Esc", "quit"},
  };
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Appearing, {0.5f, 0.5f});
  if (ImGui::Begin("Keys", &open, ImGuiWindowFlags_AlwaysAutoResize) && ImGui::BeginTable("keys", 2)) {
    for (const auto& row : kRows) {
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row[0]);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row[1]);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace

Panel::Panel(GLFWwindow* window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  ImGui::StyleColorsDark();
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Panel::~Panel() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

bool Panel::draw(PanelState& state, const ViewerStats& stats) {
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  const bool changed = state.visible && panelWindow(state, stats);
  if (state.help) helpWindow(state.help);
  ImGui::Render();
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  return changed;
}

bool Panel::wantsMouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Panel::wantsKeys() const { return ImGui::GetIO().WantTextInput; }

}  // namespace nephele
