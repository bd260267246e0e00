// March, views, split, goal at rest. Depends on imgui and scene.
#include <imgui.h>

#include <algorithm>

#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

bool cacheWidgets(MarchSettings& march) {
  constexpr double kBlock = 16.0;  // voxels of a block of the cache: the scene's own bounds
  constexpr int kMostSteps = 16;
  bool changed = ImGui::Checkbox("light cache", &march.lightCache);
  if (!march.lightCache) return changed;
  changed |= widgets::slider("light every", march.cacheVoxels, 1.0, kBlock, "%.2f voxels");
  changed |= widgets::slider("sky every", march.skyCacheVoxels, 1.0, kBlock, "%.2f voxels");
  constexpr double kMostDepth = 10.0;
  changed |= widgets::slider("marched above", march.cacheDepth, 0.0, kMostDepth, "%.2f a voxel", true);
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("optical depth of a mean voxel above which light is marched for at rest");
  changed |= widgets::slider("marched first", march.cacheNearVoxels, 0.0, kBlock, "%.1f voxels");
  changed |=
      ImGui::SliderInt("in steps", &march.cacheNearSteps, 0, kMostSteps, "%d", ImGuiSliderFlags_AlwaysClamp);
  return changed;
}

bool marchWidgets(MarchSettings& march) {
  constexpr double kShortest = 0.05, kLongest = 16.0, kLeastGiveUp = 1e-6, kMostGiveUp = 0.1;
  bool changed = widgets::slider("step", march.stepVoxels, kShortest, kLongest, "%.2f voxels", true);
  changed |= widgets::slider("shadow step", march.shadowStepVoxels, kShortest, kLongest, "%.2f voxels", true);
  changed |= widgets::slider("shadow growth", march.shadowGrowth, 1.0, 2.0, "%.2f");
  changed |= ImGui::Checkbox("adaptive steps", &march.adaptive);
  changed |= widgets::slider("give up below", march.giveUp, kLeastGiveUp, kMostGiveUp, "%.0e", true);
  changed |= ImGui::Checkbox("check what is skipped", &march.checkSkips);
  constexpr double kMostLevelPixels = 8.0;
  changed |= widgets::slider("coarser below", march.levelPixels, 0.0, kMostLevelPixels, "%.2f pixels");
  changed |= widgets::slider("steps as of", march.stepPixels, 0.0, kMostLevelPixels, "voxels of %.2f pixels");
  constexpr const char* kPrecisions = "auto\0r8\0r16f\0r32f\0";  // in the enum's order
  int precision = static_cast<int>(march.precision);
  if (ImGui::Combo("precision", &precision, kPrecisions)) {
    march.precision = static_cast<AtlasPrecision>(precision);
    changed = true;
  }
  return cacheWidgets(march) || changed;
}

bool viewWidgets(UiState& state) {
  bool changed = false;
  if (ImGui::BeginCombo("shows", rowOf(state.view).name.data())) {
    for (int i = 0; i < kViewCount; ++i) {
      const View view = static_cast<View>(i);
      if (ImGui::Selectable(rowOf(view).name.data(), view == state.view)) {
        state.view = view;
        changed = true;
      }
    }
    ImGui::EndCombo();
  }
  if (state.view != View::slice) return changed;
  constexpr const char* kAxes = "x\0y\0z\0";
  changed |= ImGui::Combo("across", &state.slice.axis, kAxes);
  changed |= widgets::slider("at", state.slice.place, 0.0, 1.0, "%.3f of the box");
  return changed;
}

bool goalWidgets(RestGoal& goal) {
  constexpr double kPercent = 100.0, kLeast = 0.05, kMost = 5.0;
  double percent = goal.tolerance * kPercent;
  if (!widgets::slider("noise at rest", percent, kLeast, kMost, "%.2f %%", true)) return false;
  goal.tolerance = percent / kPercent;
  return true;
}

void splitWidgets(UiState& state, UiWishes& wishes) {
  if (ImGui::SmallButton(state.kept ? "end split" : "split")) wishes.actions.push_back(Action::split);
  if (!state.kept) return;
  ImGui::SameLine();
  if (ImGui::SmallButton("swap")) wishes.actions.push_back(Action::swapSides);
  ImGui::SameLine();
  ImGui::TextDisabled("left is kept");
}

}  // namespace

void viewParts(UiState& state, const UiFacts& facts, UiWishes& wishes) {
  widgets::group("View", false, [&] {
    wishes.picture |= viewWidgets(state);
    splitWidgets(state, wishes);
  });
  widgets::group("March", false, [&] {
    wishes.settings |= marchWidgets(state.settings.scene.march);
    wishes.picture |= goalWidgets(state.goal);
    ImGui::TextDisabled("%.0f densities a pixel and sample", facts.stats.densitySamplesPerPixel);
    if (state.settings.scene.march.checkSkips)
      ImGui::TextWrapped("%.3g densities checked, bounds wrong for %.0f", facts.stats.skips.checked,
                         facts.stats.skips.wrong);
  });
}

}  // namespace nephele
