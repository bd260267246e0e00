// Widgets. Depends on imgui and scene.
#include "preview/app/widgets.h"

#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace nephele::widgets {
namespace {

const ImVec4 kWarningColour(1.0f, 0.72f, 0.30f, 1.0f);
constexpr double kStill = 1e-9;          // of a slider's range
constexpr double kLeastSpeed = 1e-4;     // of a drag, for values near 0
constexpr double kSpeedPerValue = 0.01;  // a hundred pixels double a value
// IEC 61966-2-1.
constexpr double kToe = 0.0031308, kToeSlope = 12.92, kScale = 1.055, kOffset = 0.055, kPower = 2.4;

double encoded(double x) { return x <= kToe ? kToeSlope * x : kScale * std::pow(x, 1.0 / kPower) - kOffset; }
double linear(double x) {
  return x <= kToe * kToeSlope ? x / kToeSlope : std::pow((x + kOffset) / kScale, kPower);
}

}  // namespace

float ems(float count) { return count * ImGui::GetFontSize(); }

bool slider(const char* label, double& value, double low, double high, const char* format, bool logarithmic) {
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (logarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None);
  const double before = value;
  if (!ImGui::SliderScalar(label, ImGuiDataType_Double, &value, &low, &high, format, flags)) return false;
  // A value that is kept in another unit comes back rounded: a slider held still must not begin pictures
  // anew.
  if (std::abs(value - before) > kStill * (high - low)) return true;
  value = before;
  return false;
}

bool amount(const char* label, double& value, const char* format) {
  const double low = 0.0, high = 1e15;  // the scene's own bounds
  const float speed = static_cast<float>(std::max(kSpeedPerValue * std::abs(value), kLeastSpeed));
  return ImGui::DragScalar(label, ImGuiDataType_Double, &value, speed, &low, &high, format,
                           ImGuiSliderFlags_AlwaysClamp);
}

bool amounts(const char* label, Rgb& value) {
  const double low = 0.0, high = 1e15;
  const double largest = std::max({value[0], value[1], value[2]});
  const float speed = static_cast<float>(std::max(kSpeedPerValue * largest, kLeastSpeed));
  return ImGui::DragScalarN(label, ImGuiDataType_Double, value.data(), static_cast<int>(value.size()), speed,
                            &low, &high, "%.3g", ImGuiSliderFlags_AlwaysClamp);
}

bool light(const char* label, Rgb& value) {
  ImGui::PushID(label);
  double strength = std::max({value[0], value[1], value[2]});
  Rgb colour{1.0, 1.0, 1.0};
  if (strength > 0.0)
    for (size_t c = 0; c < colour.size(); ++c) colour[c] = value[c] / strength;
  std::array<float, 3> shown{};
  for (size_t c = 0; c < shown.size(); ++c) shown[c] = static_cast<float>(encoded(colour[c]));
  bool changed = amount(label, strength);
  if (ImGui::ColorEdit3("colour", shown.data(), ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_Float)) {
    changed = true;
    for (size_t c = 0; c < colour.size(); ++c) colour[c] = linear(std::max(0.0, double{shown[c]}));
  }
  if (changed)
    for (size_t c = 0; c < colour.size(); ++c) value[c] = strength * colour[c];
  ImGui::PopID();
  return changed;
}

bool position(const char* label, glm::dvec3& value, double speed) {
  return ImGui::DragScalarN(label, ImGuiDataType_Double, &value.x, 3, static_cast<float>(speed), nullptr,
                            nullptr, "%.3g");
}

void sameLineIfRoom(const char* label) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float end = ImGui::GetItemRectMax().x + style.ItemSpacing.x + ImGui::CalcTextSize(label).x +
                    2.0f * style.FramePadding.x;
  if (end <= ImGui::GetWindowPos().x + ImGui::GetWindowContentRegionMax().x) ImGui::SameLine();
}

bool termSwitch(const char* label, Switch& value, bool shown) {
  bool changed = ImGui::Checkbox(label, &shown);
  if (changed) value = shown;
  if (!value) return changed;
  ImGui::PushID(label);
  ImGui::SameLine();
  if (ImGui::SmallButton("as the look has it")) {
    value.reset();
    changed = true;
  }
  ImGui::PopID();
  return changed;
}

void notPhysical(const char* why) {
  ImGui::SameLine();
  ImGui::TextColored(kWarningColour, "not physical");
  if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", why);
}

void warning(const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, kWarningColour);
  ImGui::TextWrapped("%s", text.c_str());
  ImGui::PopStyleColor();
}

bool beginGroup(const char* name, bool open) {
  ImGui::PushID(name);
  return ImGui::CollapsingHeader(name, open ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
}

void endGroup() { ImGui::PopID(); }

}  // namespace nephele::widgets
