// What stands behind the medium in pictures for people: PNG and window. Depends on scene, base and gpu.
#pragma once

#include "base/picture.h"
#include "preview/viewed_scene.h"

namespace nephele {

/// `backdrop`: colours that are no light. `sky`: the environment. `nothing`: the render's radiance holds the
/// environment already. Numbered as shaders/display.frag names them.
enum class Behind : int { backdrop = 0, sky = 1, nothing = 2 };

/// nothing where the scene asks to show its environment; else its background where it gives one; else the
/// environment in the `report` look, and the default background in `physical`.
Behind behindOf(const Scene& scene);

/// Adds mean transmittance × the environment at the pixel's centre to R, G, B of a render with its eight
/// planes. Throws InputError for a camera without a direction.
void addSky(Picture& picture, const ViewedScene& view);

/// The colours for writePng: black but for Behind::backdrop. They are no light: exposure, which the writer
/// applies to all, is taken out of them.
Backdrop backdropOf(const Scene& scene, double exposureEv);

}  // namespace nephele
