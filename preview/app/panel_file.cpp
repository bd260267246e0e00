// File, grids, undo, scene, pictures; the strip of the timeline. Depends on imgui.
#include <imgui.h>

#include <algorithm>
#include <filesystem>

#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

void button(const char* label, Action action, UiWishes& wishes, bool enabled = true) {
  ImGui::BeginDisabled(!enabled);
  if (ImGui::SmallButton(label)) wishes.actions.push_back(action);
  ImGui::EndDisabled();
}

void gridWidget(const Document& document, UiWishes& wishes) {
  const std::string& shown = document.volume().gridName;
  if (!ImGui::BeginCombo("grid", shown.c_str())) return;
  for (const GridChoice& grid : document.grids()) {
    const ImGuiSelectableFlags flags = grid.isFloat ? 0 : ImGuiSelectableFlags_Disabled;
    if (ImGui::Selectable(grid.name.c_str(), grid.name == shown, flags)) wishes.grid = grid.name;
  }
  ImGui::EndCombo();
}

}  // namespace

void fileParts(UiState& state, const UiFacts& facts, UiWishes& wishes) {
  const std::string file = std::filesystem::path(facts.document.volume().path).filename().string();
  ImGui::TextUnformatted(file.c_str());
  gridWidget(facts.document, wishes);
  button("undo", Action::undo, wishes, facts.undoSteps > 0);
  ImGui::SameLine();
  button("redo", Action::redo, wishes, facts.redoSteps > 0);
  ImGui::SameLine();
  button("save scene", Action::saveScene, wishes);
  ImGui::SameLine();
  button("read", Action::readScene, wishes, std::filesystem::exists(state.sceneFile));
  button("picture .png", Action::picturePng, wishes);
  ImGui::SameLine();
  button(".exr", Action::pictureExr, wishes);
  ImGui::SameLine();
  button("keys", Action::help, wishes);
}

void timelineStrip(const UiFacts& facts, UiWishes& wishes) {
  const Timeline& timeline = facts.document.timeline();
  if (timeline.frames() < 2 || facts.live) return;
  constexpr float kMargin = 8.0f, kHeightShare = 1.0f;
  const float fpsWidth = widgets::ems(5.0f);
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, screen.y - kMargin}, ImGuiCond_Always, {0.5f, kHeightShare});
  ImGui::SetNextWindowSize({screen.x - 2.0f * kMargin, 0.0f});
  if (ImGui::Begin("Timeline", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove)) {
    if (ImGui::Button(timeline.playing() ? "stop" : "play")) wishes.actions.push_back(Action::play);
    ImGui::SameLine();
    if (ImGui::Button("<")) wishes.actions.push_back(Action::stepBack);
    ImGui::SameLine();
    if (ImGui::Button(">")) wishes.actions.push_back(Action::stepOn);
    ImGui::SameLine();
    const size_t position = static_cast<size_t>(timeline.position());
    const SequenceFrame& frame = facts.document.frames()[position];
    // The slider moves over positions and names the frame there.
    const std::string label = "frame " + std::to_string(frame.number) + (timeline.waiting() ? " ..." : "");
    int wanted = timeline.position();
    ImGui::SetNextItemWidth(-fpsWidth - kMargin);
    if (ImGui::SliderInt("##frame", &wanted, 0, timeline.frames() - 1, label.c_str())) wishes.frame = wanted;
    ImGui::SameLine();
    constexpr double kSlowest = 1.0, kFastest = 60.0;
    double fps = timeline.fps();
    ImGui::SetNextItemWidth(fpsWidth);
    if (widgets::slider("##fps", fps, kSlowest, kFastest, "%.0f fps")) wishes.fps = fps;
  }
  ImGui::End();
}

}  // namespace nephele
