// Planck's law through the standard observer. Depends on nothing.
#include "scene/blackbody.h"

#include <algorithm>
#include <cmath>

namespace nephele {
namespace {

using Xyz = std::array<double, 3>;

/// A lobe with two widths, given as their inverses in 1/nm.
double lobe(double nanometres, double height, double centre, double below, double above) {
  const double t = (nanometres - centre) * (nanometres < centre ? below : above);
  return height * std::exp(-0.5 * t * t);
}

/// The observer's three sensitivities [Wyman, Sloan and Shirley 2013, table 1].
Xyz observer(double l) {
  return {lobe(l, 0.362, 442.0, 0.0624, 0.0374) + lobe(l, 1.056, 599.8, 0.0264, 0.0323) +
              lobe(l, -0.065, 501.1, 0.0490, 0.0382),
          lobe(l, 0.821, 568.8, 0.0213, 0.0247) + lobe(l, 0.286, 530.9, 0.0613, 0.0322),
          lobe(l, 1.217, 437.0, 0.0845, 0.0278) + lobe(l, 0.681, 459.0, 0.0385, 0.0725)};
}

Xyz observed(double kelvin) {
  constexpr int kFirst = 360, kLast = 830;
  constexpr double kSecondRadiation = 1.438776877e7;  // h c / k, nm K
  Xyz sum{0.0, 0.0, 0.0};
  for (int nanometres = kFirst; nanometres <= kLast; ++nanometres) {
    const double wavelength = nanometres * 1e-3;  // in µm, so that its fifth power stays near 1
    const double planck =
        1.0 / (std::pow(wavelength, 5.0) * std::expm1(kSecondRadiation / (nanometres * kelvin)));
    const Xyz seen = observer(nanometres);
    for (size_t c = 0; c < sum.size(); ++c) sum[c] += planck * seen[c];
  }
  return sum;
}

}  // namespace

std::array<double, 3> blackbodyRadiance(double kelvin) {
  if (!(kelvin > kColdestKelvin)) return {0.0, 0.0, 0.0};
  static const double unit = observed(kBlackbodyUnitKelvin)[1];
  const Xyz s = observed(kelvin);
  // XYZ to linear Rec.709 [ITU-R BT.709, white D65].
  const std::array<double, 3> rgb{3.2404542 * s[0] - 1.5371385 * s[1] - 0.4985314 * s[2],
                                  -0.9692660 * s[0] + 1.8760108 * s[1] + 0.0415560 * s[2],
                                  0.0556434 * s[0] - 0.2040259 * s[1] + 1.0572252 * s[2]};
  return {std::max(rgb[0], 0.0) / unit, std::max(rgb[1], 0.0) / unit, std::max(rgb[2], 0.0) / unit};
}

}  // namespace nephele
