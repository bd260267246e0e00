// Live particles: play, pause, reset, bake this, and every parameter of the system by the description that
// reads and writes it too. Depends on imgui and particles/describe.h.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "particles/describe.h"
#include "preview/app/live_session.h"
#include "preview/app/panel_parts.h"
#include "preview/app/widgets.h"

namespace nephele {
namespace {

constexpr double kLeastSpeed = 1e-3;     // of a drag, for values near 0
constexpr double kSpeedPerValue = 0.01;  // a hundred pixels double a value

/// Widgets for each key that describe() names. Values stay in the keys' ranges.
class ParameterWidgets {
 public:
  bool changed = false;

  bool given(bool value) {
    changed |= ImGui::Checkbox("on", &value);
    return value;
  }
  void number(const char* key, double& value, const Range& range, const char* unit) {
    const Bounds bounds = boundsOf(range, value);
    changed |= ImGui::DragScalar(key, ImGuiDataType_Double, &value, bounds.speed, &bounds.low, &bounds.high,
                                 "%.4g", ImGuiSliderFlags_AlwaysClamp);
    hint(unit, range);
  }
  void vector(const char* key, glm::dvec3& value, const Range& range, const char* unit) {
    const Bounds bounds =
        boundsOf(range, std::max({std::abs(value.x), std::abs(value.y), std::abs(value.z)}));
    changed |= ImGui::DragScalarN(key, ImGuiDataType_Double, &value.x, 3, bounds.speed, &bounds.low,
                                  &bounds.high, "%.3g", ImGuiSliderFlags_AlwaysClamp);
    hint(unit, range);
  }
  void integer(const char* key, int64_t& value, const Range& range) {
    const int64_t low = static_cast<int64_t>(range.low), high = static_cast<int64_t>(range.high);
    constexpr float kSpeed = 0.2f;
    changed |= ImGui::DragScalar(key, ImGuiDataType_S64, &value, kSpeed, &low, &high, nullptr,
                                 ImGuiSliderFlags_AlwaysClamp);
    hint("", range);
  }
  void flag(const char* key, bool& value) { changed |= ImGui::Checkbox(key, &value); }
  void text(const char* key, const std::string& value) {
    if (!value.empty()) ImGui::TextDisabled("%s: %s", key, value.c_str());
  }
  template <class E>
  void choice(const char* key, E& value, const std::vector<std::string>& names) {
    if (!ImGui::BeginCombo(key, names[static_cast<size_t>(value)].c_str())) return;
    for (size_t n = 0; n < names.size(); ++n)
      if (ImGui::Selectable(names[n].c_str(), n == static_cast<size_t>(value))) {
        changed |= n != static_cast<size_t>(value);
        value = static_cast<E>(n);
      }
    ImGui::EndCombo();
  }
  void curve(const char* key, ParticleCurve& value, const Range& range, const char* unit) {
    ImGui::PushID(key);
    ImGui::TextDisabled("%s", key);
    hint(unit, range);
    for (size_t n = 0; n < value.size(); ++n) curvePoint(value, n, range);
    ImGui::BeginDisabled(value.size() >= static_cast<size_t>(motion::kMaxCurvePoints));
    if (ImGui::SmallButton("add point")) {
      value.push_back(value.empty() ? std::array{0.0, 1.0}
                                    : std::array{value.back()[0] + 0.5, value.back()[1]});
      changed = true;
    }
    ImGui::EndDisabled();
    widgets::sameLineIfRoom("remove last");
    ImGui::BeginDisabled(value.empty());
    if (ImGui::SmallButton("remove last")) {
      value.pop_back();
      changed = true;
    }
    ImGui::EndDisabled();
    ImGui::PopID();
  }
  void words(const char* key, std::vector<std::string>& value, const std::vector<std::string>& known) {
    ImGui::TextDisabled("%s", key);
    for (const std::string& word : known) {
      const auto found = std::find(value.begin(), value.end(), word);
      bool on = found != value.end();
      ImGui::SameLine();
      if (!ImGui::Checkbox(word.c_str(), &on)) continue;
      changed = true;
      if (on)
        value.push_back(word);
      else
        value.erase(found);
    }
  }
  void node(const char* key, const yaml::NodePtr& value) {
    ImGui::TextDisabled("%s: %s", key, value ? "as in the recipe" : "none");
  }
  template <class Body>
  void map(const char* key, const Body& body) {
    widgets::group(key, false, [&] { body(*this); });
  }
  template <class T>
  void list(const char* key, std::vector<T>& items, size_t most) {
    std::optional<size_t> removed;
    for (size_t n = 0; n < items.size(); ++n) {
      const std::string name = std::string(key) + " " + std::to_string(n + 1);
      widgets::group(name.c_str(), false, [&] {
        describe(*this, items[n]);
        if (ImGui::SmallButton("remove")) removed = n;
      });
    }
    if (removed && items.size() > leastOf(items)) {
      items.erase(items.begin() + static_cast<std::ptrdiff_t>(*removed));
      changed = true;
    }
    const std::string label = std::string("add to ") + key;
    ImGui::BeginDisabled(items.size() >= most);
    if (ImGui::SmallButton(label.c_str())) {
      items.push_back(items.empty() ? T{} : items.back());
      changed = true;
    }
    ImGui::EndDisabled();
  }

 private:
  struct Bounds {
    double low, high;
    float speed;
  };
  /// A system without emitters is none.
  static size_t leastOf(const std::vector<Emitter>&) { return 1; }
  template <class T>
  static size_t leastOf(const std::vector<T>&) {
    return 0;
  }
  static Bounds boundsOf(const Range& range, double value) {
    // An open end is kept off by what no value of use is below.
    constexpr double kOpen = 1e-6;
    return {range.lowOpen ? range.low + kOpen : range.low, range.highOpen ? range.high - kOpen : range.high,
            static_cast<float>(std::max(kSpeedPerValue * std::abs(value), kLeastSpeed))};
  }
  static void hint(const char* unit, const Range& range) {
    if (!ImGui::IsItemHovered()) return;
    const std::string text = std::string(unit) + (*unit != '\0' ? "; " : "") + yaml::describe(range);
    ImGui::SetTooltip("%s", text.c_str());
  }
  /// x stays between those of its neighbours.
  void curvePoint(ParticleCurve& value, size_t n, const Range& range) {
    constexpr double kApart = 1e-3;
    ImGui::PushID(static_cast<int>(n));
    auto point = value[n];
    const Bounds y = boundsOf(range, point[1]);
    const float speed = static_cast<float>(kSpeedPerValue);
    ImGui::SetNextItemWidth(0.5f * ImGui::CalcItemWidth());
    changed |= ImGui::DragScalar("##x", ImGuiDataType_Double, &point[0], speed, nullptr, nullptr, "at %.3g");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(0.5f * ImGui::CalcItemWidth());
    changed |= ImGui::DragScalar("##y", ImGuiDataType_Double, &point[1], y.speed, &y.low, &y.high, "%.4g",
                                 ImGuiSliderFlags_AlwaysClamp);
    const double low = n > 0 ? value[n - 1][0] + kApart : 0.0;
    const double high = n + 1 < value.size() ? value[n + 1][0] - kApart : kLargestLength;
    if (low <= high) point[0] = std::clamp(point[0], low, high);
    value[n] = point;
    ImGui::PopID();
  }
};

/// An axis needs a length, or the recipe would be refused.
void keepAxes(ParticleSystem& system) {
  const auto keep = [](glm::dvec3& axis) {
    if (axis == glm::dvec3(0.0)) axis = {0.0, 0.0, 1.0};
  };
  for (Emitter& emitter : system.emitters) keep(emitter.axis);
  for (Vortex& vortex : system.forces.vortices) keep(vortex.axis);
}

void button(const char* label, Action action, UiWishes& wishes) {
  if (ImGui::SmallButton(label)) wishes.actions.push_back(action);
}

void runningWidgets(UiState& state, const LiveFacts& live, UiWishes& wishes) {
  button(live.playing ? "pause" : "play", Action::play, wishes);
  ImGui::SameLine();
  button("reset", Action::resetParticles, wishes);
  ImGui::SameLine();
  button("bake this", Action::bakeThis, wishes);
  widgets::sameLineIfRoom("back to the file");
  button("back to the file", Action::liveParticles, wishes);
  if (live.frame < 0)
    ImGui::TextDisabled("before the first frame: %lld", static_cast<long long>(-live.frame));
  else
    ImGui::TextDisabled("frame %lld, %u particles", static_cast<long long>(live.frame), live.alive);
  constexpr int kLeast = 16;
  if (ImGui::SliderInt("grid edge", &state.liveEdge, kLeast, kMostLiveEdge, "%d voxels",
                       ImGuiSliderFlags_AlwaysClamp))
    wishes.picture = true;
  for (const std::string& sentence : live.leftOut) widgets::warning(sentence);
}

}  // namespace

void liveParts(UiState& state, const UiFacts& facts, UiWishes& wishes) {
  if (!state.settings.particles) return;
  widgets::group("Particles", facts.live.has_value(), [&] {
    if (!facts.live) {
      button("move them live", Action::liveParticles, wishes);
      return;
    }
    runningWidgets(state, *facts.live, wishes);
    ParameterWidgets parameters;
    describe(parameters, *state.settings.particles);
    if (!parameters.changed) return;
    keepAxes(*state.settings.particles);
    wishes.settings = true;
  });
}

}  // namespace nephele
