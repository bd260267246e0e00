// The table. Depends on GLFW's key codes.
#include "preview/app/keys.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

namespace nephele {
namespace {

constexpr KeyPress plain(int key) { return {key, false, false}; }
constexpr KeyPress shift(int key) { return {key, false, true}; }
constexpr KeyPress control(int key) { return {key, true, false}; }

constexpr KeyRow kRows[] = {
    {"left drag", "orbit", {}, {}},
    {"middle drag, shift + left drag", "pan", {}, {}},
    {"wheel", "zoom", {}, {}},
    {"right drag", "look around", {}, {}},
    {"W A S D Q E with right drag", "fly; the wheel changes the speed", {}, {}},
    {"ctrl + left drag", "turn the sun", {}, {}},
    {"double click", "focus on what is under the cursor", {}, {}},
    {"F", "the same", Action::focus, plain(GLFW_KEY_F)},
    {"Home", "frame the whole cloud", Action::frameAll, plain(GLFW_KEY_HOME)},
    {"R", "back to the first view", Action::firstView, plain(GLFW_KEY_R)},
    {"ctrl + 1 ... 9, 1 ... 9", "set a camera bookmark, go to it", {}, {}},
    {"L", "look: report or physical", Action::look, plain(GLFW_KEY_L)},
    {"V, shift + V", "next view, the one before", Action::nextView, plain(GLFW_KEY_V)},
    {"", "", Action::previousView, shift(GLFW_KEY_V)},
    {"C", "compare: split, these settings kept on the left", Action::split, plain(GLFW_KEY_C)},
    {"X", "swap the two sides of the split", Action::swapSides, plain(GLFW_KEY_X)},
    {"ctrl + Z, ctrl + shift + Z", "undo, redo", Action::undo, control(GLFW_KEY_Z)},
    {"", "", Action::redo, {GLFW_KEY_Z, true, true}},
    {"", "", Action::redo, control(GLFW_KEY_Y)},
    {"space", "play the sequence or live particles, or stop", Action::play, plain(GLFW_KEY_SPACE)},
    {"left, right", "one frame back, one on", Action::stepBack, plain(GLFW_KEY_LEFT)},
    {"", "", Action::stepOn, plain(GLFW_KEY_RIGHT)},
    {"P", "move the file's particles live, or back to the file", Action::liveParticles, plain(GLFW_KEY_P)},
    {"shift + P", "live particles: begin anew", Action::resetParticles, shift(GLFW_KEY_P)},
    {"B", "live particles: bake this (writes the recipe)", Action::bakeThis, plain(GLFW_KEY_B)},
    {"ctrl + S, ctrl + O", "save the scene, read it back", Action::saveScene, control(GLFW_KEY_S)},
    {"", "", Action::readScene, control(GLFW_KEY_O)},
    {"drop a .vdb or a .yaml", "open it, or take over its scene", {}, {}},
    {"F12, shift + F12", "picture to PNG, to EXR", Action::picturePng, plain(GLFW_KEY_F12)},
    {"", "", Action::pictureExr, shift(GLFW_KEY_F12)},
    {"H", "hide or show the panel", Action::panel, plain(GLFW_KEY_H)},
    {"F1", "hide or show this list", Action::help, plain(GLFW_KEY_F1)},
    {"Esc, ctrl + Q", "quit", Action::quit, plain(GLFW_KEY_ESCAPE)},
    {"", "", Action::quit, control(GLFW_KEY_Q)},
};

}  // namespace

std::span<const KeyRow> keyRows() { return kRows; }

std::optional<Action> actionOf(const KeyPress& press) {
  for (const KeyRow& row : kRows)
    if (row.action && row.press == press) return row.action;
  return std::nullopt;
}

int bookmarkOf(const KeyPress& press) {
  const bool digit = press.key >= GLFW_KEY_1 && press.key <= GLFW_KEY_9;
  return digit && !press.shift ? press.key - GLFW_KEY_0 : 0;
}

}  // namespace nephele
