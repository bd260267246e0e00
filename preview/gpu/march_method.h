// The method `march` behind the method interface: headless, on the GPU. Depends on preview/method.h and gpu.
#pragma once

#include <memory>

#include "preview/method.h"

namespace nephele {

/// Starts the driver (EGL, no display) and compiles the march. Throws WorldError where there is no
/// OpenGL 4.5.
std::unique_ptr<Method> makeMarchMethod(const MethodOptions& options);

/// The same with other ways along the ray: `cube` draws the medium's bounding cube and takes rays from its
/// interpolated face coordinates, with the two defects that are known of it (faces nearly along the view are
/// coarse; with the camera inside nothing is drawn); pixels beside the cube hold no sample. `dda` walks the
/// voxels, each of one density.
std::unique_ptr<Method> makeCubeMethod(const MethodOptions& options);
std::unique_ptr<Method> makeDdaMethod(const MethodOptions& options);

}  // namespace nephele
