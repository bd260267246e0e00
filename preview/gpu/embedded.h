// The shader texts that the build put into the program. Depends on nothing.
#pragma once

#include <span>
#include <string_view>

namespace nephele {

struct EmbeddedText {
  std::string_view name;  // the path under shaders/: "shared/march.glsl"
  std::string_view text;
};

/// All of them; valid for the program's whole life.
std::span<const EmbeddedText> embeddedShaders();

}  // namespace nephele
