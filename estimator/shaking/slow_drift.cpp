#include "estimator/shaking/slow_drift.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kMisfitMemory_s = 60;  // longer than the quiet time that ends a strong motion

VectorXd frame_masses(const Structure& s) {
  VectorXd out(s.degrees_of_freedom());
  for (int story = 1; story <= s.stories; ++story)
    for (int f = 0; f < s.frames(); ++f) out[s.dof(story, f)] = s.frame_mass(story, f);
  return out;
}

/// Displacements of floors to drifts of stories, in place.
void subtract_floors_below(const Structure& s, MatrixXd& rows) {
  for (int story = s.stories; story > 1; --story)
    rows.middleRows(s.dof(story, 0), s.frames()) -=
        rows.middleRows(s.dof(story - 1, 0), s.frames());
}

/// -motion K^-1 motion' M, motion: of the frames by the coordinates of `stiffness`.
MatrixXd flexibility(const Structure& s, const MatrixXd& motion, const MatrixXd& stiffness) {
  const MatrixXd forces = -(motion.transpose() * frame_masses(s).asDiagonal());
  MatrixXd out = motion * Ldlt(stiffness).solve(forces);
  subtract_floors_below(s, out);
  return out;
}

MatrixXd flexibility_of_groups(const PipelineConfig& c, const ParameterTable& table,
                               const GroupDesign& design, const VectorXd& factor) {
  const ReducedBuilding b =
      reduced_building(c.structure, c.axes, table, design, identifying(c.axes), true);
  if (b.rows() == 0) return {};
  MatrixXd stiffness = b.constant_stiffness;
  for (std::size_t p = 0; p < b.parts.size(); ++p)
    if (b.damping[p] == 0 && b.parts[p].size() > 0) stiffness += factor[b.same_as[p]] * b.parts[p];
  const Index free = b.size() - b.inputs;
  return flexibility(c.structure,
                     b.frames.bottomRows(c.structure.degrees_of_freedom()).rightCols(free),
                     stiffness.bottomRightCorner(free, free));
}

VectorXd as_vector(const std::vector<double>& values) {
  return Eigen::Map<const VectorXd>(values.data(), static_cast<Index>(values.size()));
}

}  // namespace

SlowDrift::SlowDrift(const PipelineConfig& config)
    : config_(config),
      table_(config.parameters()),
      design_{config.design.size() > 0
                  ? config.design
                  : guessed_design(config.structure, ParameterTable(config.structure)),
              config.bending_nmprad},
      designed_(table_.grouped() ? group_parameters(config.structure, table_, design_)
                                 : design_.theta),
      driven_(has_force(config.axes)),
      theta_(designed_.begin(), designed_.end()),
      std_error_(theta_.size(), kNaN),
      identified_(theta_.size(), 0),
      static_before_(VectorXd::Zero(config.structure.degrees_of_freedom())),
      drift_(VectorXd::Constant(config.structure.degrees_of_freedom(), kNaN)) {}

void SlowDrift::follow_misfit(const WindowEstimate& e) {
  double strength = 0;
  for (const double amplitude : e.amplitude)
    if (std::isfinite(amplitude)) strength += amplitude * amplitude;
  const double passed_s = std::chrono::duration<double>(e.end - newest_).count();
  newest_ = e.end;
  strongest_m2_ *= std::exp(-std::max(0.0, passed_s) / kMisfitMemory_s);
  if (!std::isfinite(e.residual_ratio) || strength < strongest_m2_) return;
  strongest_m2_ = strength;
  misfit_ = std::abs(e.residual_ratio);
}

void SlowDrift::follow(const WindowEstimate& e) {
  if (e.window != 0 || e.status != WindowStatus::valid || e.value.size() != theta_.size()) return;
  follow_misfit(e);
  for (std::size_t p = 0; p < theta_.size(); ++p) {
    if (e.reason[p] != Observability::observable || !(e.value[p] > 0)) continue;
    theta_[p] = e.value[p];
    std_error_[p] = p < e.std_error.size() ? e.std_error[p] / e.value[p] : kNaN;
    identified_[p] = 1;
  }
  bool far = formed_.size() == 0;
  for (Index p = 0; p < formed_.size(); ++p) {
    const bool damping = p >= table_.elements() && p < 2 * table_.elements();
    const double now = theta_[static_cast<std::size_t>(p)];
    far = far || (!damping && std::abs(now - formed_[p]) > kFar * std::abs(formed_[p]));
  }
  if (far) form();
}

double SlowDrift::damping_lag_s() const {
  std::vector<double> ratios;
  for (int p = 0; p < table_.elements(); ++p) {
    const auto k = static_cast<std::size_t>(p), c = static_cast<std::size_t>(p + table_.elements());
    if (table_[p].kind == ParameterKind::frame_stiffness && identified_[c] != 0)
      ratios.push_back(theta_[c] / theta_[k]);
  }
  if (ratios.empty()) return 0;
  std::nth_element(ratios.begin(), ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2),
                   ratios.end());
  return ratios[ratios.size() / 2];
}

void SlowDrift::form() {
  formed_.resize(0);
  flexibility_.resize(0, 0);
  if (driven_) return;
  for (int p = 0; p < table_.elements(); ++p)
    if (table_[p].kind == ParameterKind::frame_stiffness &&
        identified_[static_cast<std::size_t>(p)] == 0)
      return;
  const Structure& s = config_.structure;
  const VectorXd theta = as_vector(theta_);
  if (table_.grouped()) {
    flexibility_ = flexibility_of_groups(config_, table_, design_, theta.cwiseQuotient(designed_));
  } else {
    const MatrixXd motion = floor_constraint(s);
    flexibility_ =
        flexibility(s, motion, motion.transpose() * assemble(s, table_, theta).stiffness * motion);
  }
  if (!flexibility_.allFinite()) flexibility_.resize(0, 0);
  lag_ = 2 * damping_lag_s() * config_.options.rate_hz;
  formed_ = theta;
}

const VectorXd& SlowDrift::push(const VectorXd& slow_accel) {
  if (!known() || !slow_accel.allFinite()) {
    static_before_.setZero();
    drift_.setConstant(static_before_.size(), kNaN);
    return drift_;
  }
  const VectorXd now = flexibility_ * slow_accel;
  if (!drift_.allFinite()) {
    drift_ = now;
  } else {
    // Damping takes its share of the force: drift + lag d(drift)/dt = now, trapezoidal.
    drift_ = (now + static_before_ + (lag_ - 1) * drift_) / (lag_ + 1);
  }
  static_before_ = now;
  return drift_;
}

DriftKnowledge SlowDrift::knowledge() const {
  DriftKnowledge out;
  out.theta = theta_;
  out.std_error = std_error_;
  for (std::size_t p = 0; p < theta_.size(); ++p)
    if (identified_[p] == 0) out.theta[p] = kNaN;
  out.misfit = misfit_;
  return out;
}

}  // namespace framewatch::estimator
