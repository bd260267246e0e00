// The method `march` behind the method interface: headless, on the GPU. Depends on preview/method.h and gpu.
#pragma once

#include <memory>

#include "preview/method.h"

namespace nephele {

/// Starts the driver (EGL, no display) and compiles the march. Throws WorldError where there is no
/// OpenGL 4.5.
std::unique_ptr<Method> makeMarchMethod(const MethodOptions& options);

}  // namespace nephele
