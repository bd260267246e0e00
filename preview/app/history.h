// Undo and redo over whole values. Knows nothing of what they are. Depends on nothing.
#pragma once

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace nephele {

/// Steps back and forth through the states of one value, which its owner holds. A gesture, such as the drag
/// of a slider, is one step however many changes it makes: changes belong together until rest() is called.
template <class T>
class History {
 public:
  /// Keeps `most` steps at least 1; older ones are forgotten.
  explicit History(size_t most) : most_(most) {}

  /// Tell it of a change, with the value as it was before. What was undone can no longer be redone.
  void changed(const T& before) {
    redo_.clear();
    if (inGesture_) return;
    inGesture_ = true;
    undo_.push_back(before);
    if (undo_.size() > most_) undo_.pop_front();
  }
  /// The hand has let go: the next change begins a step of its own.
  void rest() { inGesture_ = false; }

  /// Whether the next change belongs to the last one's step.
  bool inGesture() const { return inGesture_; }

  /// The value one step back (or forth), for which `now` can be had again; nullopt where there is none.
  std::optional<T> undo(const T& now) { return move(undo_, redo_, now); }
  std::optional<T> redo(const T& now) { return move(redo_, undo_, now); }

  size_t undoSteps() const { return undo_.size(); }
  size_t redoSteps() const { return redo_.size(); }

 private:
  template <class From, class To>
  std::optional<T> move(From& from, To& to, const T& now) {
    inGesture_ = false;
    if (from.empty()) return std::nullopt;
    std::optional<T> value(std::move(from.back()));
    from.pop_back();
    to.push_back(now);
    return value;
  }

  size_t most_;
  std::deque<T> undo_;
  std::vector<T> redo_;
  bool inGesture_ = false;
};

}  // namespace nephele
