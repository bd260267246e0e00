// Reading the screen back. Depends on gpu and base.
#include "preview/app/screenshot.h"

#include <filesystem>
#include <iomanip>
#include <sstream>

#include "base/picture.h"

namespace nephele {

std::string nextPictureName(const std::string& folder, const std::string& extension) {
  constexpr int kDigits = 4;
  for (int number = 1;; ++number) {
    std::ostringstream name;
    name << "nephele_" << std::setw(kDigits) << std::setfill('0') << number;
    const std::filesystem::path stem = std::filesystem::path(folder) / name.str();
    if (!std::filesystem::exists(stem.string() + ".png") && !std::filesystem::exists(stem.string() + ".exr"))
      return stem.string() + extension;
  }
}

void writeScreen(const std::string& path, Viewer& viewer, const Screen& screen,
                 const std::array<Shown, kSideCount>& shown) {
  // A target of its own: what lies under other windows is not defined in the window's.
  const GlTexture texture = makeTexture(GL_TEXTURE_2D);
  const GlFramebuffer framebuffer = makeFramebuffer();
  glTextureStorage2D(texture.name(), 1, GL_RGBA8, screen.width, screen.height);
  glNamedFramebufferTexture(framebuffer.name(), GL_COLOR_ATTACHMENT0, texture.name(), 0);
  Screen target = screen;
  target.framebuffer = framebuffer.name();
  viewer.show(target, shown);
  const size_t row = static_cast<size_t>(screen.width) * 3, rows = static_cast<size_t>(screen.height);
  std::vector<unsigned char> upward(row * rows), pixels(row * rows);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glReadPixels(0, 0, screen.width, screen.height, GL_RGB, GL_UNSIGNED_BYTE, upward.data());
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  checkGl("reading the screen back");
  // GL's first row is the lowest.
  for (size_t y = 0; y < rows; ++y)
    std::copy_n(upward.begin() + static_cast<std::ptrdiff_t>((rows - 1 - y) * row), row,
                pixels.begin() + static_cast<std::ptrdiff_t>(y * row));
  writePngBytes(path, screen.width, screen.height, pixels);
}

}  // namespace nephele
