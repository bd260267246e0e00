// The stage: floor, balls and cube. What a scene leaves open shows the value in use, and is given once it is
// changed. Depends on imgui and preview/stage_places.h.
#include <imgui.h>

#include <glm/geometric.hpp>

#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

/// For a value that is given: a button beside the widget before, which leaves it open again.
template <class Value>
bool openAgain(std::optional<Value>& value) {
  if (!value) return false;
  ImGui::SameLine();
  if (!ImGui::SmallButton("auto")) return false;
  value.reset();
  return true;
}

/// A dragged number that is at least `low`.
bool openNumber(const char* label, std::optional<double>& value, double inUse, double low, double speed) {
  const double high = 1e15;  // the scene's own bound
  ImGui::PushID(label);
  bool changed = ImGui::DragScalar(label, ImGuiDataType_Double, &inUse, static_cast<float>(speed), &low,
                                   &high, "%.3g", ImGuiSliderFlags_AlwaysClamp);
  if (changed) value = inUse;
  changed |= openAgain(value);
  ImGui::PopID();
  return changed;
}

/// `inUse`: where it stands now, and half of its size. `halves`: of the half in its size.
bool thingWidgets(const char* label, StageThing& thing, const StagePlace& inUse, const char* sizeLabel,
                  double halves, double speed) {
  bool changed = ImGui::Checkbox(label, &thing.on);
  if (!thing.on) return changed;
  ImGui::PushID(label);
  ImGui::Indent();
  glm::dvec3 centre = inUse.centre;
  if (widgets::position("centre", centre, speed)) {
    thing.center = centre;
    changed = true;
  }
  ImGui::PushID("centre");
  changed |= openAgain(thing.center);
  ImGui::PopID();
  changed |= openNumber(sizeLabel, thing.size, halves * inUse.half, speed, speed);
  ImGui::Unindent();
  ImGui::PopID();
  return changed;
}

}  // namespace

bool stageWidgets(Stage& stage, const StagePlaces& places) {
  bool changed = ImGui::Checkbox("stage", &stage.on);
  if (!stage.on) {
    ImGui::TextDisabled("floor and balls around the cloud");
    return changed;
  }
  constexpr double kSharpest = 64.0, kLowest = -1e15;  // the scene's own bound
  constexpr double kSpeed = 0.01;                      // of half the cloud a pixel, and the smallest size
  const double speed = kSpeed * places.size;
  changed |= ImGui::Checkbox("floor", &stage.floor);
  if (stage.floor) {
    ImGui::Indent();
    const double height = glm::dot(places.ground, places.axes.up);
    changed |= openNumber("height", stage.height, height, kLowest, speed);
    changed |= openNumber("squares", stage.checker, places.checker, speed, speed);
    ImGui::Unindent();
  }
  changed |= thingWidgets("chrome ball", stage.chrome, places.chrome, "radius", 1.0, speed);
  changed |= thingWidgets("grey ball", stage.grey, places.grey, "radius", 1.0, speed);
  changed |= thingWidgets("chrome cube", stage.cube, places.cube, "edge", 2.0, speed);
  changed |= ImGui::Checkbox("highlights", &stage.highlights);
  changed |= widgets::slider("shadow edge", stage.penumbra, 0.0, kSharpest, "%.1f");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("sharpness of the things' shadows; 0: hard");
  return changed;
}

}  // namespace nephele
