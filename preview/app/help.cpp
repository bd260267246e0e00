// The list of keys. Depends on imgui and app/keys.h.
#include <imgui.h>

#include "preview/app/keys.h"
#include "preview/app/panel_parts.h"

namespace nephele {

void helpWindow(bool& open) {
  const ImVec4 kKeyColour(0.62f, 0.80f, 1.0f, 1.0f);
  constexpr float kMargin = 16.0f;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * screen.x, 0.5f * screen.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({0.0f, 0.0f}, {screen.x - kMargin, screen.y - kMargin});
  if (ImGui::Begin("Keys", &open, ImGuiWindowFlags_AlwaysAutoResize) &&
      ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const KeyRow& row : keyRows()) {
      if (row.how[0] == '\0') continue;  // a further key of the line before
      ImGui::TableNextColumn();
      ImGui::TextColored(kKeyColour, "%s", row.how);
      ImGui::TableNextColumn();
      ImGui::TextUnformatted(row.what);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace nephele
