// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/groups/group_equations.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/regressors/unknown_past.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// Returns the oscillator sections of the rows, with every weight 1.
FloorRows group_rows(const EstimatorOptions& options, const GroupDesign& design,
                     const GroupEquations& equations, int unknowns);

/// Forms rows of groups of stories between measured floors. Part 0 of the tuning forms the
/// equations. The other parts push a unit impulse of each axis through them, which gives the noise
/// in the sums, (14) to (16), without algebra.
class GroupTuning : public RowTuning {
 public:
  /// Tunes part 0 only. config: of a building in groups. `config`, `options` and `layout` must
  /// outlive the object; `options` may be config's or have other corners. triple: of held_triple().
  GroupTuning(const PipelineConfig& config, const EstimatorOptions& options,
              const ParameterTable& table, const FloorLayout& layout, const GroupDesign& design,
              const DerivativeTriple& triple, const HighPass& high_pass);

  void set_theta0(const Eigen::VectorXd& theta0, const std::vector<double>& noise_density) override;
  int parts() const override;
  void tune(int part) override;

  const FloorRows& rows(int) const override { return rows_; }
  const Eigen::VectorXd& theta0() const override { return theta0_; }
  const std::vector<double>& noise_density() const override { return noise_density_; }
  int settle_rows(int least) const override;
  /// Returns how far theta is from theta0, where the rows are linearized.
  double detuning(int floor, const Eigen::VectorXd& theta) override;
  const std::vector<std::uint8_t>& axes() const override { return present_; }
  void set_axes(const std::vector<std::uint8_t>& present, const Known& ratios) override;
  const Known& ratios() const override { return ratios_; }
  std::unique_ptr<RowTuning> copy() const override { return std::make_unique<GroupTuning>(*this); }
  std::unique_ptr<RowFilter> make_filter(int settle) override;
  void save(StateWriter& state) override { members(state); }
  void load(StateReader& state) override { members(state); }

  /// Longest time that is waited for a mode between measured floors.
  static constexpr double kLongestSettle_s = 20;

  const FloorLayout& layout() const { return *layout_; }
  const PolePair& high_pass_poles() const { return high_pass_poles_; }
  const ReducedBuilding& building() const { return building_; }
  const GroupEquations& equations() const { return equations_; }

 private:
  void members(auto& a) {
    for (Eigen::Index i = 0; i < theta0_.size(); ++i)
      a.within(theta0_[i], std::numeric_limits<double>::min(), a.kMax);
    for (Eigen::Index i = 0; i < ratios_.theta.size(); ++i)
      a.within(ratios_.theta[i], std::numeric_limits<double>::min(), a.kMax);
    a.each_within(ratios_.std_error, 0, a.kMax);
    a.finite(noise_density_);
    a.each_within(present_, 0, 1);
    a.within(tuned_parts_, 0, a.kMaxCount);
    if (a.kReading) restore();
  }
  /// Recomputes everything that follows from the parameters, up to the tuned parts.
  void restore();
  void form();
  std::vector<double> share_error() const;
  void push_impulse(int from, int to);
  void finish_noise();
  int impulse_rows() const;
  int parts_per_axis() const;

  const PipelineConfig* config_;
  const EstimatorOptions* options_;
  const FloorLayout* layout_;
  PolePair high_pass_poles_;
  ParameterTable table_;
  const GroupDesign configured_;
  GroupDesign design_;  ///< as configured within a group; ratios_ scale the groups
  Known ratios_;
  Eigen::VectorXd designed_, theta0_;
  std::vector<double> noise_density_;
  std::vector<std::uint8_t> present_;
  PerturbedDesigns perturbed_;
  std::vector<std::vector<double>> impulse_;  ///< impulse response of every AxisMotion::Signal
  ReducedBuilding building_;
  GroupEquations equations_;
  FloorRows rows_;
  int tuned_parts_ = 0;

  // State of the noise summation.
  GroupChain chain_;
  FloorRows plain_;              ///< rows_ with every weight 1
  std::vector<double> moments_;  ///< rows x front x front
  std::vector<double> motion_, step_;
};

/// Forms the entering rows, or the leaving ones.
class GroupFilter : public RowFilter {
 public:
  GroupFilter(GroupTuning& tuning, int settle);

  void reset(int settle) override;
  void push(const DeformationSet& set) override;
  int count(int) const override { return settling_ > 0 || starting_ ? 0 : tuning_->rows(0).rows; }
  bool forms(int) const override { return settling_ == 0 && tuning_->rows(0).rows > 0; }
  const FloorRows& floor_rows(int) const override { return tuning_->rows(0); }
  std::uint8_t origin_of(int, const FloorRows* rows) const override { return rows != nullptr; }
  const FloorRows* floor_rows_from(int, std::uint8_t origin) const override {
    return origin != 0 ? &tuning_->rows(0) : nullptr;
  }
  void save(StateWriter& state) override { members(state); }
  void load(StateReader& state) override { members(state); }

 private:
  void members(auto& a) {
    a.within(settle_, 0, a.kMaxCount);
    a.within(settling_, 0, a.kMaxCount);
    a.finite(rows_);
    if (a.kReading) start();
    a(chain_, past_, starting_);
  }
  void start();

  GroupTuning* tuning_;
  int settle_, settling_ = 0;
  GroupChain chain_;
  UnknownPast past_;
  bool starting_ = false;  ///< too few rows since the start to determine the past
  std::vector<double> motion_;
};

}  // namespace framewatch::estimator
