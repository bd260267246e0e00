// How densities are read between samples. Depends on nothing.
#pragma once

namespace nephele {

/// `exact`: eight fetches and float mixes. `hardware`: the texture unit, whose weights have 8 bits on many
/// GPUs.
enum class Filter { exact, hardware };

}  // namespace nephele
