// One table of keys: what the window obeys and what F1 lists. Depends on GLFW's key codes.
#pragma once

#include <optional>
#include <span>

namespace nephele {

/// What a key or a button of the panel asks for.
enum class Action {
  quit,
  focus,
  frameAll,
  firstView,
  look,
  nextView,
  previousView,
  split,
  swapSides,
  undo,
  redo,
  play,
  stepBack,
  stepOn,
  liveParticles,
  resetParticles,
  bakeThis,
  saveScene,
  readScene,
  picturePng,
  pictureExr,
  panel,
  help,
};

/// A key as it was pressed.
struct KeyPress {
  int key = 0;
  bool control = false, shift = false;
  bool operator==(const KeyPress&) const = default;
};

/// One line of the list: how it is done and what it does. Drags have no key.
struct KeyRow {
  const char* how;
  const char* what;
  std::optional<Action> action;
  KeyPress press;
};

std::span<const KeyRow> keyRows();

/// The action of a key, or nullopt where it has none.
std::optional<Action> actionOf(const KeyPress& press);

/// The bookmark that a key means, 1 to 9, or 0 where it means none.
int bookmarkOf(const KeyPress& press);

}  // namespace nephele
