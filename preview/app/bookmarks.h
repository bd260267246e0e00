// Nine places to look from. Depends on scene alone.
#pragma once

#include <array>
#include <optional>

#include "scene/scene.h"

namespace nephele {

/// Cameras under the numbers 1 to 9; they live as long as the window.
class Bookmarks {
 public:
  static constexpr int kCount = 9;
  /// `number` is in [1, 9], here and below.
  void set(int number, const Camera& camera) { at(number) = camera; }
  /// nullopt where none was set.
  std::optional<Camera> get(int number) const { return cameras_.at(static_cast<size_t>(number) - 1); }

 private:
  std::optional<Camera>& at(int number) { return cameras_.at(static_cast<size_t>(number) - 1); }
  std::array<std::optional<Camera>, kCount> cameras_;
};

}  // namespace nephele
