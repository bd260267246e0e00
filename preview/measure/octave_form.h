// How far octaves are from truth in one view, for any factors and any count, from some fifty pictures: each
// order is linear in light. Depends on preview/method.h, scene and preview/measure alone.
#pragma once

#include <vector>

#include "preview/method.h"
#include "scene/sun_factors.h"

namespace nephele {

/// The mean square of relative errors over views as a quadratic form of what orders weigh at nodes: at shares
/// of the extinction towards the light (1, ½, ¼ … and 0) times shares of the asymmetry (nodes of Chebyshev in
/// [0, 1]) times powers of 1 − openness (0, 1, 2 … 16). Between shares an order is interpolated, by cubics of
/// the logarithm and by the polynomial through all nodes.
class OctaveForm {
 public:
  OctaveForm();

  /// The form of one view: `march` draws an order at each node with `request`, and `truth` holds two
  /// independent halves of the same size. The view's octaves are not looked at. Throws what `march` throws.
  static OctaveForm of(Method& march, const ViewedScene& view, const PictureRequest& request,
                       const Picture& truth);

  /// Sums the squares of another view.
  void add(const OctaveForm& other);

  /// Σ over the views added of mean (x − r1)(x − r2)/mean r², as compareWithHalves has it: truth's noise
  /// cancels, so a perfect fit may come out a little below 0. `count` orders beyond the first.
  double at(const OctaveFactors& factors, int count) const;

 private:
  std::vector<double> squares_;  // node by node; symmetric, so the triangle m ≤ n alone
  std::vector<double> mixed_;    // −½ of what is linear in the weights
  double constant_ = 0.0;
};

}  // namespace nephele
