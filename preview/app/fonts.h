// The font of everything that lies over the picture. Depends on imgui.
#pragma once

namespace nephele {

/// Gives the current context a font of 14 times `scale` pixels, and sizes of its style to go with
/// it: a font file of the system's where one of the usual ones is there, else the one that ImGui carries.
void chooseFont(float scale);

}  // namespace nephele
