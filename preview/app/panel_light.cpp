// Presets, lights, environment, medium, orders of scattering. Depends on imgui, scene, app/orbit_camera.h and
// preview/stage_places.h.
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <numbers>

#include "preview/app/orbit_camera.h"
#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"
#include "preview/resolve.h"
#include "preview/stage_places.h"
#include "scene/light_model.h"
#include "scene/presets.h"

namespace nephele {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

bool sunWidgets(Sun& sun, const glm::dvec3& up) {
  constexpr double kHalfTurn = 180.0, kSteepest = 90.0;
  Angles angles = anglesOf(sun.toLight, up);
  double azimuth = angles.azimuth * kDegrees, elevation = angles.elevation * kDegrees;
  bool turned = widgets::slider("azimuth", azimuth, -kHalfTurn, kHalfTurn, "%.1f deg");
  turned |= widgets::slider("elevation", elevation, -kSteepest, kSteepest, "%.1f deg");
  if (turned) sun.toLight = directionOf({azimuth / kDegrees, elevation / kDegrees}, up);
  return widgets::light("irradiance", sun.irradiance) || turned;
}

bool pointWidgets(PointLight& point) {
  constexpr double kSpeed = 0.01;  // world units a pixel
  const bool moved = widgets::position("position", point.position, kSpeed);
  return widgets::light("intensity", point.intensity) || moved;
}

bool lightWidgets(std::vector<Light>& lights, const glm::dvec3& up) {
  bool changed = false;
  std::optional<size_t> removed;
  for (size_t i = 0; i < lights.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    Sun* sun = std::get_if<Sun>(&lights[i]);
    ImGui::TextDisabled("%s %zu", sun != nullptr ? "sun" : "point", i + 1);
    ImGui::SameLine();
    if (ImGui::SmallButton("remove")) removed = i;
    changed |= sun != nullptr ? sunWidgets(*sun, up) : pointWidgets(std::get<PointLight>(lights[i]));
    ImGui::PopID();
  }
  if (removed) lights.erase(lights.begin() + static_cast<std::ptrdiff_t>(*removed));
  ImGui::BeginDisabled(lights.size() >= kMostLights);
  const bool addSun = ImGui::SmallButton("add sun");
  ImGui::SameLine();
  const bool addPoint = ImGui::SmallButton("add point");
  ImGui::EndDisabled();
  if (addSun) lights.emplace_back(Sun{});
  if (addPoint) lights.emplace_back(PointLight{});
  return changed || removed || addSun || addPoint;
}

bool rampWidgets(SkyRamp& ramp) {
  bool changed = widgets::light("zenith", ramp.zenith);
  changed |= widgets::light("horizon", ramp.horizon);
  changed |= widgets::light("ground", ramp.ground);
  changed |= widgets::slider("cloudiness", ramp.cloudiness, 0.0, 1.0, "%.2f");
  return widgets::amount("intensity", ramp.intensity) || changed;
}

bool latLongWidgets(LatLong& picture) {
  constexpr double kHalfTurn = 180.0;
  double rotation = picture.rotation * kDegrees;
  const bool turned = widgets::slider("rotation", rotation, -kHalfTurn, kHalfTurn, "%.1f deg");
  if (turned) picture.rotation = rotation / kDegrees;
  return widgets::amount("intensity", picture.intensity) || turned;
}

/// The picture's path, taken over by Enter; else one is dropped.
void latLongPath(const LatLong& picture, UiWishes& wishes) {
  std::string path = picture.path;
  if (ImGui::InputTextWithHint("picture", "path of an .exr, or drop one", &path,
                               ImGuiInputTextFlags_EnterReturnsTrue))
    wishes.environment = path;
}

bool environmentWidgets(Environment& environment, UiWishes& wishes) {
  using Kind = Environment::Kind;
  bool changed = false;
  if (ImGui::BeginCombo("kind", nameOf(environment.kind).c_str())) {
    for (const Kind kind : {Kind::constant, Kind::ramp, Kind::exr}) {
      const bool missing = kind == Kind::exr && environment.exr.path.empty();
      const std::string name = nameOf(kind) + (missing ? " (no picture yet)" : "");
      const ImGuiSelectableFlags flags = missing ? ImGuiSelectableFlags_Disabled : 0;
      if (!ImGui::Selectable(name.c_str(), kind == environment.kind, flags)) continue;
      environment.kind = kind;
      changed = true;
    }
    ImGui::EndCombo();
  }
  if (environment.kind == Kind::constant) changed |= widgets::light("radiance", environment.constant);
  if (environment.kind == Kind::ramp) changed |= rampWidgets(environment.ramp);
  latLongPath(environment.exr, wishes);
  if (environment.kind == Kind::exr) changed |= latLongWidgets(environment.exr);
  return ImGui::Checkbox("in every picture", &environment.show) || changed;
}

/// Behind window and PNG, in place of the environment.
bool backdropWidgets(std::optional<BackdropColours>& backdrop) {
  bool given = backdrop.has_value();
  bool changed = ImGui::Checkbox("plain background", &given);
  if (changed) backdrop = given ? std::optional(BackdropColours{}) : std::nullopt;
  if (!backdrop) return changed;
  changed |= widgets::light("bottom", backdrop->bottom);
  return widgets::light("top", backdrop->top) || changed;
}

bool mediumWidgets(Medium& medium) {
  constexpr double kMostG = 0.99;
  bool changed = widgets::amounts("scattering", medium.sigmaS);
  changed |= widgets::amounts("absorption", medium.sigmaA);
  changed |= widgets::slider("g", medium.g, -kMostG, kMostG, "%.3f");
  ImGui::TextDisabled("per unit density and length");
  return changed;
}

bool silverLiningWidgets(SilverLining& lining, const LightModel& model) {
  constexpr double kMostAsymmetry = 0.99;
  bool changed = widgets::termSwitch("silver lining", lining.on, model.silverLining);
  if (!model.silverLining) return changed;
  changed |= widgets::slider("towards the light", lining.inS, 0.0, kMostAsymmetry, "%.2f");
  changed |= widgets::slider("away from it", lining.outS, 0.0, kMostAsymmetry, "%.2f");
  return widgets::slider("blend", lining.blend, 0.0, 1.0, "%.2f") || changed;
}

bool powderWidgets(Powder& powder, const LightModel& model) {
  constexpr double kMostStrength = 100.0;
  bool changed = widgets::termSwitch("powder", powder.on, model.powder);
  if (!model.powder) return changed;
  return widgets::slider("strength", powder.oSa, 0.0, kMostStrength, "%.2f", true) || changed;
}

void furnaceText(const LightModel& model) {
  const double furnace = furnaceValue(model.octaveCount, model.a, model.b, model.d);
  const std::array<char, 64> text = [&] {
    std::array<char, 64> line{};  // "white furnace 1.159: makes light"
    std::snprintf(line.data(), line.size(), "white furnace %.3f%s", furnace,
                  furnace > 1.0 ? ": makes light" : "");
    return line;
  }();
  if (furnace > 1.0)
    widgets::warning(text.data());
  else
    ImGui::TextDisabled("%s", text.data());
}

bool octaveWidgets(Octaves& octaves, const LightModel& model) {
  constexpr int kMost = 16;
  int count = model.octaveCount;
  bool changed = ImGui::SliderInt("orders", &count, 0, kMost, "%d", ImGuiSliderFlags_AlwaysClamp);
  if (changed) octaves.count = count;
  if (octaves.count) {
    if (ImGui::SmallButton("as the look has it")) {
      octaves.count.reset();
      changed = true;
    }
  }
  if (count == 0) return changed;
  bool factors = widgets::slider("a extinction", octaves.a, 0.0, 1.0, "%.2f");
  factors |= widgets::slider("b scattering", octaves.b, 0.0, 1.0, "%.2f");
  factors |= widgets::slider("c asymmetry", octaves.c, 0.0, 1.0, "%.2f");
  factors |= widgets::slider("d openness", octaves.d, 0.0, 1.0, "%.2f");
  octaves.factorsGiven |= factors;
  furnaceText(model);
  return changed || factors;
}

bool emissionWidgets(Emission& emission, const Document& document) {
  constexpr const char* kStates = "where the file has it\0on\0off\0";
  int state = !emission.on ? 0 : *emission.on ? 1 : 2;
  bool changed = ImGui::Combo("emission", &state, kStates);
  if (changed) emission.on = state == 0 ? Switch{} : Switch{state == 1};
  if (emission.on == Switch{false}) return changed;
  if (ImGui::BeginCombo("temperatures", emission.grid.c_str())) {
    for (const GridChoice& grid : document.grids()) {
      if (!grid.isFloat || !ImGui::Selectable(grid.name.c_str(), grid.name == emission.grid)) continue;
      emission.grid = grid.name;
      changed = true;
    }
    ImGui::EndCombo();
  }
  changed |= widgets::amount("scale", emission.scale);
  return widgets::amount("kelvin per unit", emission.temperatureScale) || changed;
}

bool lookWidgets(Scene& scene) {
  bool changed = false;
  for (const Look look : {Look::report, Look::physical}) {
    if (look == Look::physical) ImGui::SameLine();
    if (!ImGui::RadioButton(nameOf(look).c_str(), scene.look == look)) continue;
    scene.look = look;
    changed = true;
  }
  return changed;
}

/// The terms that are on and are none of physics', by name, with the reason on hover.
void notPhysicalTerms(const LightModel& model) {
  for (const LightTerm& term : termsOf(model)) {
    if (!term.on || term.physical) continue;
    ImGui::TextDisabled("%s", std::string(term.name).c_str());
    widgets::notPhysical(std::string(term.sentence).c_str());
  }
}

bool termWidgets(Scene& scene, const Medium& medium, const Document& document) {
  bool changed = lookWidgets(scene);
  const LightModel model = lightModelOf(scene, medium);
  changed |= silverLiningWidgets(scene.silverLining, model);
  changed |= powderWidgets(scene.powder, model);
  changed |= octaveWidgets(scene.octaves, model);
  changed |= emissionWidgets(scene.emission, document);
  bool chord = scene.lightTransmittance == LightTransmittance::chord;
  if (ImGui::Checkbox("shadows by the chord", &chord)) {
    scene.lightTransmittance = chord ? LightTransmittance::chord : LightTransmittance::marched;
    changed = true;
  }
  notPhysicalTerms(model);
  return changed;
}

bool presetWidgets(Scene& scene, const glm::dvec3& up) {
  bool changed = false;
  for (const Preset& preset : presets()) {
    if (&preset != &presets().front()) widgets::sameLineIfRoom(preset.name.data());
    if (ImGui::SmallButton(preset.name.data())) {
      applyPreset(preset, scene);
      turnLights(scene, up);
      changed = true;
    }
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", preset.sentence.data());
  }
  return changed;
}

}  // namespace

void lightParts(UiState& state, const UiFacts& facts, UiWishes& wishes) {
  constexpr double kMostEv = 16.0;
  Scene& scene = state.settings.scene;
  bool changed = presetWidgets(scene, state.up);
  changed |= widgets::slider("exposure", state.settings.exposureEv, -kMostEv, kMostEv, "%.2f EV");
  widgets::group("Lights", true, [&] { changed |= lightWidgets(scene.lights, state.up); });
  widgets::group("Environment", false, [&] {
    changed |= environmentWidgets(scene.environment, wishes);
    changed |= backdropWidgets(scene.backdrop);
  });
  widgets::group("Medium", false, [&] { changed |= mediumWidgets(state.settings.medium); });
  widgets::group("Light in the cloud", false,
                 [&] { changed |= termWidgets(scene, state.settings.medium, facts.document); });
  widgets::group("Stage", false, [&] {
    changed |= stageWidgets(scene.stage, placesOf(scene.stage, state.up, facts.document.volume()));
  });
  wishes.settings |= changed;
}

}  // namespace nephele
