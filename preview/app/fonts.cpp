// Looks for a font file in the places where systems keep them. Depends on imgui.
#include "preview/app/fonts.h"

#include <imgui.h>

#include <array>
#include <filesystem>

namespace nephele {
namespace {

constexpr float kFontPixels = 14.0f;
constexpr float kOwnFontPixels = 13.0f;  // ImGui's bitmap is drawn for that

/// DejaVu Sans first, which scripts/packages installs, as Debian, Fedora and Arch place it; then its likes.
constexpr std::array kFontFiles{
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/truetype/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/noto/NotoSans-Regular.ttf",
    "/usr/share/fonts/truetype/roboto/unhinted/RobotoTTF/Roboto-Regular.ttf",
    "/usr/share/fonts/truetype/liberation/LiberationSans-Regular.ttf",
};

}  // namespace

void chooseFont(float scale) {
  ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
  ImGui::GetStyle().ScaleAllSizes(scale);
  for (const char* file : kFontFiles) {
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) continue;
    if (fonts.AddFontFromFileTTF(file, kFontPixels * scale) != nullptr) return;
  }
  ImFontConfig own;
  own.SizePixels = kOwnFontPixels * scale;
  fonts.AddFontDefault(&own);
}

}  // namespace nephele
