// The panel's parts, each a file. They build widgets between ImGui's NewFrame and Render. Depends on
// app/ui_state.h and preview/stage_places.h.
#pragma once

#include "preview/app/ui_state.h"
#include "preview/stage_places.h"

namespace nephele {

/// Presets, exposure, lights, environment, medium, orders of scattering and stage.
void lightParts(UiState& state, const UiFacts& facts, UiWishes& wishes);
/// `places`: where its things stand now. Returns whether anything was changed.
bool stageWidgets(Stage& stage, const StagePlaces& places);
/// March, view, split and goal at rest.
void viewParts(UiState& state, const UiFacts& facts, UiWishes& wishes);
/// Live particles and all their parameters; nothing where the file carries none.
void liveParts(UiState& state, const UiFacts& facts, UiWishes& wishes);
/// File, grid, undo, scene and pictures.
void fileParts(UiState& state, const UiFacts& facts, UiWishes& wishes);
/// The strip at the lower edge; nothing where there is no sequence, or while particles are moved live.
void timelineStrip(const UiFacts& facts, UiWishes& wishes);
/// The head-up line, warnings and notice at the upper right.
void headUpLine(const UiState& state, const UiFacts& facts);
/// The divider of the split, and the scale of the view's colours.
void pictureMarks(const UiState& state, const UiFacts& facts);
/// The list of keys.
void helpWindow(bool& open);

}  // namespace nephele
