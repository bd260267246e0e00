// A tile of blue noise: where steps start, so that neighbouring pixels differ as much as they can. Depends on
// nothing.
#pragma once

#include <vector>

namespace nephele {

/// `edge` × `edge` ranks as (rank + ½)/edge² in (0, 1), each once, x fastest, that tile the plane: void and
/// cluster [Ulichney 1993], the filter a Gaussian of deviation 1.5 cut at 6 pixels. The same on every machine
/// and in every call. edge ≥ 16.
std::vector<float> blueNoiseTile(int edge);

}  // namespace nephele
