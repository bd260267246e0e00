// Pictures that the window writes. Depends on gpu and base.
#pragma once

#include <string>

#include "preview/app/viewer.h"

namespace nephele {

/// FOLDER/nephele_0001.png, or the next number for which there is neither a .png nor an .exr.
std::string nextPictureName(const std::string& folder, const std::string& extension);

/// What is on the screen without the panel, as 8-bit PNG. Throws WorldError.
void writeScreen(const std::string& path, Viewer& viewer, const Screen& screen,
                 const std::array<Shown, kSideCount>& shown);

}  // namespace nephele
