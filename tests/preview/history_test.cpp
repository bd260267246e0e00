// Undo and redo.
#include "preview/app/history.h"

#include <gtest/gtest.h>

namespace nephele {
namespace {

/// A number with a history, as the window has settings with one.
struct Document {
  int value = 0;
  History<int> history{4};
  void set(int to) {
    history.changed(value);
    value = to;
  }
  bool undo() {
    const auto back = history.undo(value);
    if (back) value = *back;
    return back.has_value();
  }
  bool redo() {
    const auto forth = history.redo(value);
    if (forth) value = *forth;
    return forth.has_value();
  }
};

TEST(History, GoesBackAndForth) {
  Document d;
  for (const int v : {1, 2, 3}) {
    d.set(v);
    d.history.rest();
  }
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.value, 2);
  EXPECT_TRUE(d.undo());
  EXPECT_EQ(d.value, 1);
  EXPECT_TRUE(d.redo());
  EXPECT_TRUE(d.redo());
  EXPECT_EQ(d.value, 3);
  EXPECT_FALSE(d.redo());
}

TEST(History, ADragIsOneStep) {
  Document d;
  for (int v = 1; v <= 50; ++v) d.set(v);  // a slider on its way
  d.history.rest();
  d.set(60);
  d.history.rest();
  EXPECT_EQ(d.history.undoSteps(), 2u);
  d.undo();
  EXPECT_EQ(d.value, 50);
  d.undo();
  EXPECT_EQ(d.value, 0);
}

TEST(History, RestingTwiceMakesNoStep) {
  Document d;
  d.set(1);
  d.history.rest();
  d.history.rest();
  EXPECT_EQ(d.history.undoSteps(), 1u);
}

TEST(History, AChangeAfterUndoEndsWhatCouldBeRedone) {
  Document d;
  d.set(1);
  d.history.rest();
  d.set(2);
  d.history.rest();
  d.undo();
  d.set(7);
  EXPECT_FALSE(d.redo());
  d.undo();
  EXPECT_EQ(d.value, 1);
}

TEST(History, UndoWithinADragEndsIt) {
  Document d;
  d.set(1);
  d.set(2);
  d.undo();
  EXPECT_EQ(d.value, 0);
  d.set(5);  // the same drag goes on: a step of its own now
  EXPECT_EQ(d.history.undoSteps(), 1u);
  d.undo();
  EXPECT_EQ(d.value, 0);
}

TEST(History, ForgetsTheOldest) {
  Document d;
  for (int v = 1; v <= 10; ++v) {
    d.set(v);
    d.history.rest();
  }
  EXPECT_EQ(d.history.undoSteps(), 4u);
  while (d.undo()) {
  }
  EXPECT_EQ(d.value, 6);
}

TEST(History, NothingToUndoLeavesTheValue) {
  Document d;
  EXPECT_FALSE(d.undo());
  EXPECT_FALSE(d.redo());
  EXPECT_EQ(d.value, 0);
}

}  // namespace
}  // namespace nephele
