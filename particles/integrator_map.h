// Where the integrators of particle motion may be trusted: stiff forces at short and long steps, against
// closed forms or finely stepped runs: rows of docs/stability.md. Depends on simulation.h.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace nephele {

enum class IntegratorVerdict {
  trusted,  // errs by at most kTrustedIntegratorError
  bounded,  // finite and no farther away than these forces can bring it, but wrong
  refused,  // a SimulationError says so
  grows     // farther away, finite or not: a fault
};

inline constexpr double kTrustedIntegratorError = 0.01;

/// One force at one strength and one step.
struct IntegratorRow {
  std::string axis;  // the force, with its unit
  double strength = 0.0;
  double stepSeconds = 0.0;
  std::optional<double>
      error;  // distance from the true place over the farthest that truth is from the origin
  IntegratorVerdict verdict = IntegratorVerdict::grows;
  std::string sentence;  // of a refusal
};

/// Every row, by axis, strength and step: drag, vortices, springs, pushes and a runaway, at steps of 1/240 to
/// 1 second for four seconds. The same figures on any machine, but for the last digits of the library's exp.
std::vector<IntegratorRow> integratorMap();

}  // namespace nephele
