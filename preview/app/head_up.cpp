// Figures, warnings and marks over the picture. Depends on imgui.
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <vector>

#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

constexpr float kMargin = 8.0f;
constexpr float kGround = 0.75f;  // opacity that white text needs over white pictures
constexpr ImGuiWindowFlags kOverlay = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoInputs |
                                      ImGuiWindowFlags_NoFocusOnAppearing | ImGuiWindowFlags_NoNav |
                                      ImGuiWindowFlags_NoBringToFrontOnFocus;

std::string figures(const UiFacts& facts) {
  constexpr double kMebibyte = 1048576.0, kPercent = 100.0;
  const LaneStats& s = facts.stats;
  std::array<char, 128> text{};  // the longest line takes 80
  int used = 0;
  const auto add = [&](const char* format, auto... values) {
    used += std::snprintf(text.data() + used, text.size() - static_cast<size_t>(used), format, values...);
  };
  if (s.samples == 0) {
    add("%.0f ms  %dx%d", s.quickMilliseconds, s.quickWidth, s.quickHeight);
    if (facts.framesPerSecond > 0.0) add("  %.0f fps", facts.framesPerSecond);
  } else {
    add("%.0f ms  %u", s.sampleMilliseconds, s.samples);
    if (s.noise > 0.0) add("/%u", s.samplesWanted);
    add("%s", " spp");
    if (s.noise > 0.0) add("  noise %.2f %%", kPercent * s.noise);
  }
  add("  %.1f MiB", static_cast<double>(facts.gpuBytes) / kMebibyte);
  return text.data();
}

/// sRGB colours of shaders/display.frag's scale.
const std::array<ImVec4, 6> kStops{{{0.02f, 0.02f, 0.10f, 1.0f},
                                    {0.27f, 0.07f, 0.44f, 1.0f},
                                    {0.60f, 0.16f, 0.46f, 1.0f},
                                    {0.90f, 0.32f, 0.34f, 1.0f},
                                    {0.99f, 0.64f, 0.38f, 1.0f},
                                    {0.99f, 0.98f, 0.76f, 1.0f}}};

void scaleBar(View view, double top) {
  constexpr float kWidth = 160.0f, kHeight = 8.0f;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({screen.x - kMargin, 0.5f * screen.y}, ImGuiCond_Always, {1.0f, 0.5f});
  ImGui::SetNextWindowBgAlpha(kGround);
  if (ImGui::Begin("Scale", nullptr, kOverlay | ImGuiWindowFlags_AlwaysAutoResize)) {
    ImGui::TextUnformatted(rowOf(view).name.data());
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float step = kWidth / static_cast<float>(kStops.size() - 1);
    for (size_t i = 0; i + 1 < kStops.size(); ++i) {
      const float x = at.x + static_cast<float>(i) * step;
      const ImU32 from = ImGui::GetColorU32(kStops[i]), to = ImGui::GetColorU32(kStops[i + 1]);
      ImGui::GetWindowDrawList()->AddRectFilledMultiColor({x, at.y}, {x + step, at.y + kHeight}, from, to, to,
                                                          from);
    }
    ImGui::Dummy({kWidth, kHeight});
    constexpr double kLarge = 1000.0;  // from here on three digits would want a power of ten
    ImGui::Text(top < kLarge ? "0 ... %.3g %s" : "0 ... %.0f %s", top, rowOf(view).unit.data());
  }
  ImGui::End();
}

}  // namespace

void headUpLine(const UiState& state, const UiFacts& facts) {
  constexpr float kWidest = 35.0f;  // in heights of the font
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  // As wide as the widest line needs, within half of the screen. Measured beforehand: a window that follows
  // its contents does so a frame later, and at rest no frame may come.
  const float wrap = std::min(widgets::ems(kWidest), 0.5f * screen.x);
  std::vector<std::string> lines{figures(facts)};
  lines.insert(lines.end(), facts.warnings.begin(), facts.warnings.end());
  if (!state.notice.empty()) lines.push_back(state.notice);
  const ImGuiStyle& style = ImGui::GetStyle();
  ImVec2 size(0.0f, -style.ItemSpacing.y);
  for (const std::string& line : lines) {
    const ImVec2 text = ImGui::CalcTextSize(line.c_str(), nullptr, false, wrap);
    size = {std::max(size.x, text.x), size.y + text.y + style.ItemSpacing.y};
  }
  ImGui::SetNextWindowSize({size.x + 2.0f * style.WindowPadding.x, size.y + 2.0f * style.WindowPadding.y});
  ImGui::SetNextWindowPos({screen.x - kMargin, kMargin}, ImGuiCond_Always, {1.0f, 0.0f});
  ImGui::SetNextWindowBgAlpha(kGround);
  if (ImGui::Begin("Figures", nullptr, kOverlay)) {
    ImGui::PushTextWrapPos(style.WindowPadding.x + wrap);
    for (size_t i = 0; i < lines.size(); ++i) {
      const bool isWarning = i > 0 && i <= facts.warnings.size();
      if (isWarning)
        widgets::warning(lines[i]);
      else
        ImGui::TextWrapped("%s", lines[i].c_str());
    }
    ImGui::PopTextWrapPos();
  }
  ImGui::End();
}

void pictureMarks(const UiState& state, const UiFacts& facts) {
  if (!rowOf(state.view).unit.empty()) scaleBar(state.view, facts.stats.scale);
  if (!state.kept) return;
  constexpr float kThick = 2.0f, kGrip = 14.0f;
  const ImVec2 screen = ImGui::GetIO().DisplaySize;
  const float x = static_cast<float>(state.divider) * screen.x;
  const ImU32 white = ImGui::GetColorU32(ImVec4(1.0f, 1.0f, 1.0f, 0.8f));
  ImDrawList* list = ImGui::GetBackgroundDrawList();
  list->AddLine({x, 0.0f}, {x, screen.y}, white, kThick);
  list->AddRectFilled({x - 3.0f, 0.5f * screen.y - kGrip}, {x + 3.0f, 0.5f * screen.y + kGrip}, white, 3.0f);
}

}  // namespace nephele
