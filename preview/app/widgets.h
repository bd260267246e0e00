// Small widgets over Dear ImGui that take the project's types. Depends on imgui and scene.
#pragma once

#include <string>

#include "scene/scene.h"

namespace nephele::widgets {

/// So many heights of the font, in pixels.
float ems(float count);

/// Each returns whether the value was changed. Sliders do not leave their range; dragged numbers stay at
/// least 0 where they say so.
bool slider(const char* label, double& value, double low, double high, const char* format,
            bool logarithmic = false);
/// A number ≥ 0 without an upper end: it changes in proportion to itself.
bool amount(const char* label, double& value, const char* format = "%.4g");
/// Three such numbers.
bool amounts(const char* label, Rgb& value);
/// A light: how strong its strongest channel is, and its colour, shown as the screen shows it.
bool light(const char* label, Rgb& value);
bool position(const char* label, glm::dvec3& value, double speed);

/// Puts a small button of that label beside the item before, where it fits; else below.
void sameLineIfRoom(const char* label);

/// A term that is on, off, or as the look has it; `shown` is which it is now.
bool termSwitch(const char* label, Switch& value, bool shown);

/// Says, on the line of the widget before, that a term is none of physics'. `why` is shown on hover.
void notPhysical(const char* why);
/// A few words in the colour of warnings.
void warning(const std::string& text);

/// endGroup() follows beginGroup() whatever it returns: whether the group is unfolded.
bool beginGroup(const char* name, bool open);
void endGroup();

/// A group that folds, with an identity of its own for equal names in different groups.
template <class Body>
void group(const char* name, bool open, const Body& body) {
  if (beginGroup(name, open)) body();
  endGroup();
}

}  // namespace nephele::widgets
