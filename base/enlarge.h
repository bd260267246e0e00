// Pictures in another size. Depends on base/picture.h.
#pragma once

#include "base/picture.h"

namespace nephele {

/// Linear between pixel centres and held beyond the outermost, as a window shows a smaller picture. Width and
/// height ≥ 1.
Picture enlarged(const Picture& small, int width, int height);

}  // namespace nephele
