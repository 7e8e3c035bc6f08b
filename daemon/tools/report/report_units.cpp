// SPDX-License-Identifier: MIT
#include "daemon/tools/report/report_units.h"

#include <algorithm>

#include "estimator/structure/parameter_table.h"

namespace framewatch::daemon {
namespace {

constexpr double kStiffBuilding_npm = 1e6;

}  // namespace

ReportUnits::ReportUnits(const parameter_table_t& table) {
  double most = 0;
  for (std::size_t p = 0; p < table.kind.size(); ++p)
    if (table.kind[p] == static_cast<int>(estimator::ParameterKind::frame_stiffness))
      most = std::max(most, table.design[p]);
  building_ = !(most < kStiffBuilding_npm);
}

std::pair<double, std::string> ReportUnits::of(int kind) const {
  constexpr const char* kPer[] = {"/m", "/(rad*m)", "*s/m", "*s/(rad*m)", "*m/rad"};
  const bool stiffness = is_stiffness_kind(kind);
  const std::string per = kPer[std::clamp(kind, 0, 4)];
  if (building_) return stiffness ? std::pair(1e-6, "MN" + per) : std::pair(1e-3, "kN" + per);
  return stiffness ? std::pair(1e-3, "kN" + per) : std::pair(1.0, "N" + per);
}

std::pair<double, std::string> ReportUnits::of_force() const {
  return building_ ? std::pair(1e-3, std::string("kN")) : std::pair(1.0, std::string("N"));
}

bool is_stiffness_kind(int kind) {
  const auto k = static_cast<estimator::ParameterKind>(kind);
  return k == estimator::ParameterKind::frame_stiffness ||
         k == estimator::ParameterKind::panel_stiffness ||
         k == estimator::ParameterKind::bending_stiffness;
}

}  // namespace framewatch::daemon
