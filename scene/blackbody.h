// Thermal radiation as colour. Depends on nothing.
#pragma once

#include <array>

namespace nephele {

/// Where luminance is 1: the unit of Emission::scale.
inline constexpr double kBlackbodyUnitKelvin = 2000.0;
/// At and below, thermal radiation counts as invisible: its luminance is 1e-17 of that at 2000 K.
inline constexpr double kColdestKelvin = 500.0;

/// Radiance of a black body in linear Rec.709, in units of its luminance at 2000 K: Planck's law seen through
/// the CIE 1931 2° observer (multi-lobe fit of Wyman, Sloan and Shirley 2013, within 1% of its peak), summed
/// every nanometre from 360 to 830. Colours that Rec.709 cannot show (below 1900 K) lose their negative
/// parts. 0 at and below kColdestKelvin; any finite temperature.
std::array<double, 3> blackbodyRadiance(double kelvin);

}  // namespace nephele
