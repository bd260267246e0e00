// ImGui's set-up and the layout of the parts. Depends on GLFW and imgui.
#include "preview/app/panel.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>
#include <imgui_impl_glfw.h>
#include <imgui_impl_opengl3.h>

#include <algorithm>

#include "preview/app/fonts.h"
#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

constexpr float kMargin = 8.0f;
constexpr float kRounding = 4.0f;

void setStyle() {
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  style.WindowRounding = style.FrameRounding = style.GrabRounding = kRounding;
  style.WindowBorderSize = 0.0f;
  style.ItemSpacing = {6.0f, 3.0f};
  style.WindowPadding = {8.0f, 6.0f};
  style.GrabMinSize = 6.0f;  // figures are read through it
  const ImVec4 kGround(0.07f, 0.08f, 0.10f, 0.86f);
  style.Colors[ImGuiCol_WindowBg] = kGround;
  style.Colors[ImGuiCol_Header] = {0.20f, 0.24f, 0.30f, 1.0f};
  style.Colors[ImGuiCol_FrameBg] = {0.17f, 0.20f, 0.25f, 1.0f};
  style.Colors[ImGuiCol_Button] = {0.20f, 0.28f, 0.38f, 1.0f};
  style.Colors[ImGuiCol_TitleBgActive] = style.Colors[ImGuiCol_TitleBg] = {0.12f, 0.15f, 0.20f, 1.0f};
  style.Colors[ImGuiCol_SliderGrab] = {0.36f, 0.55f, 0.80f, 1.0f};
}

/// Narrow and no higher than the window, so that the cloud has room.
void mainPanel(UiState& state, const UiFacts& facts, UiWishes& wishes) {
  constexpr float kNarrowest = 20.0f, kWidest = 23.0f;  // in heights of the font
  constexpr float kLabels = 8.5f;                       // likewise: what the longest label takes
  constexpr float kShare = 0.25f;
  constexpr float kSmallScreen = 800.0f;  // below, the panel would cover the cloud: it opens folded
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float width = std::clamp(kShare * screen.x, widgets::ems(kNarrowest), widgets::ems(kWidest));
  const float below =
      facts.document.timeline().frames() > 1 && !facts.live ? ImGui::GetFrameHeight() + 4.0f * kMargin : 0.0f;
  const float highest = std::max(screen.y - 2.0f * kMargin - below, 2.0f * kMargin);
  ImGui::SetNextWindowPos({kMargin, kMargin});
  ImGui::SetNextWindowCollapsed(screen.x < kSmallScreen, ImGuiCond_Once);
  ImGui::SetNextWindowSizeConstraints({width, 0.0f}, {width, highest});
  if (ImGui::Begin("Nephele", nullptr, ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoMove)) {
    ImGui::PushItemWidth(-widgets::ems(kLabels));
    fileParts(state, facts, wishes);
    lightParts(state, facts, wishes);
    liveParts(state, facts, wishes);
    viewParts(state, facts, wishes);
    ImGui::PopItemWidth();
  }
  ImGui::End();
}

/// Whether a list to choose from is unfolded.
bool listOpen() { return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel); }

}  // namespace

Panel::Panel(GLFWwindow* window) {
  IMGUI_CHECKVERSION();
  ImGui::CreateContext();
  ImGui::GetIO().IniFilename = nullptr;
  setStyle();
  float scale = 1.0f;
  glfwGetWindowContentScale(window, &scale, nullptr);
  chooseFont(scale);
  ImGui_ImplGlfw_InitForOpenGL(window, true);
  ImGui_ImplOpenGL3_Init("#version 450 core");
}

Panel::~Panel() {
  ImGui_ImplOpenGL3_Shutdown();
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
}

UiWishes Panel::build(UiState& state, const UiFacts& facts) {
  UiWishes wishes;
  ImGui_ImplOpenGL3_NewFrame();
  ImGui_ImplGlfw_NewFrame();
  ImGui::NewFrame();
  if (listOpen() && !state.listOpen) ImGui::SetWindowFocus(nullptr);  // which folds it
  pictureMarks(state, facts);
  if (state.visible) {
    mainPanel(state, facts, wishes);
    timelineStrip(facts, wishes);
    headUpLine(state, facts);
  }
  if (state.help) helpWindow(state.help);
  state.listOpen = listOpen();
  ImGui::Render();
  return wishes;
}

UiWishes Panel::draw(UiState& state, const UiFacts& facts) {
  UiWishes wishes = build(state, facts);
  ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
  return wishes;
}

bool Panel::wantsMouse() const { return ImGui::GetIO().WantCaptureMouse; }
bool Panel::wantsKeys() const { return ImGui::GetIO().WantTextInput; }
bool Panel::held() const { return ImGui::IsAnyItemActive(); }

}  // namespace nephele
