// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>

#include "daemon/monitor/estimates/session_estimates.h"

namespace framewatch::daemon {

/// The units of one report, which fit together: kN, mm and MN/m (kN per mm) for buildings; N, mm
/// and kN/m (N per mm) for models whose stiffest frame has less than 1 MN/m.
class ReportUnits {
 public:
  ReportUnits() = default;
  explicit ReportUnits(const parameter_table_t& table);

  /// Returns the factor from SI and the unit of a kind of parameter: 1e-6, "MN/m".
  std::pair<double, std::string> of(int kind) const;
  /// Returns the factor from N and the unit of forces.
  std::pair<double, std::string> of_force() const;

 private:
  bool building_ = true;
};

/// Returns true for stiffnesses of frames, of panels and against bending. kind: of a
/// parameter_table_t.
bool is_stiffness_kind(int kind);

}  // namespace framewatch::daemon
