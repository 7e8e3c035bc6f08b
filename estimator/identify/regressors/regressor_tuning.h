// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/elements/guessed_design.h"
#include "estimator/identify/noise/floor_noise.h"
#include "estimator/identify/regressors/floor_rows.h"
#include "estimator/identify/regressors/row_tuning.h"
#include "estimator/identify/regressors/unknown_past.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/numeric/eigenvalues.h"
#include "estimator/numeric/kernels.h"
#include "estimator/setup/pipeline_config.h"

namespace framewatch::estimator {

/// Forms the rows of every floor: projection, oscillator sections and weights for given parameters
/// theta0. At first theta0 is the design, later it is identified. docs/equations.md, matched rows.
/// Allocates only in the constructor.
class RegressorTuning : public RowTuning {
 public:
  /// The arguments from `structure` to `high_pass` must outlive the object. theta0: > 0, theta
  /// order. noise_density: of every axis, m/s^2/sqrt(Hz), > 0; empty: the configured ones.
  RegressorTuning(const Structure& structure, const FloorLayout& layout,
                  const Deformations& deformations, const EstimatorOptions& options,
                  const DerivativeTriple& triple, const HighPass& high_pass,
                  const Eigen::VectorXd& theta0, std::vector<double> noise_density = {});

  void set_theta0(const Eigen::VectorXd& theta0, const std::vector<double>& noise_density) override;
  /// Each floor is one part.
  int parts() const override { return layout_->floors(); }
  void tune(int floor) override;

  /// Returns the rows of a floor if every motion is known.
  const FloorRows& rows(int floor) const override { return rows_[static_cast<std::size_t>(floor)]; }
  /// Writes the rows of a floor for partly known motion into `out`, which must be a copy of
  /// rows(floor). known: (floors + 1) x frames flags of DeformationSet. Equations that need an
  /// unknown motion are left out; the others are projected on their own eigenvectors.
  void rows(int floor, const std::vector<std::uint8_t>& known, FloorRows& out);

  const Eigen::VectorXd& theta0() const override { return theta0_; }
  const std::vector<double>& noise_density() const override { return noise_density_; }
  /// Returns 3 / (zeta w) of the slowest section, in instants, and at least `least`.
  int settle_rows(int least) const override;
  /// Returns the settling time in the paper's variant, whose filters must settle; otherwise 0.
  int start_rows() const override;
  bool removes_past() const { return options_->variant != Variant::paper; }
  const PolePair& high_pass_poles() const { return high_pass_poles_; }
  /// Returns the largest relative change of the corner frequencies of a floor's sections.
  double detuning(int floor, const Eigen::VectorXd& theta) override;
  std::unique_ptr<RowTuning> copy() const override {
    return std::make_unique<RegressorTuning>(*this);
  }
  std::unique_ptr<RowFilter> make_filter(int settle) override;
  void save(StateWriter& state) override { archive(state); }
  void load(StateReader& state) override { archive(state); }

  void archive(auto& a) {
    a.finite(theta0_, noise_density_);
    a(noise_, rows_);
    for (int floor = 0; floor < layout_->floors(); ++floor)
      if (!rows(floor).fits(*layout_, floor)) a.refuse();
  }

 private:
  void form(int floor, FloorRows& out);
  void weigh(int floor, int r, const OscillatorSection& section, FloorRows& out);
  void pack_noise(int floor, FloorRows& out) const;
  double damping() const;
  void take_all_equations();
  void take_usable_equations(int floor, const std::vector<std::uint8_t>& known);
  int floor_modes(int floor, const Eigen::VectorXd& theta);
  void floor_stiffness(int floor, const Eigen::VectorXd& theta);
  double theta0_at(int floor, int position) const {
    return theta0_[layout_->parameter(floor, position)];
  }
  double mass(int floor, int f) const {
    return mass_[static_cast<std::size_t>(floor * layout_->frames() + f)];
  }

  const FloorLayout* layout_;
  const EstimatorOptions* options_;
  PolePair high_pass_poles_;
  NoiseFilter noise_filter_;
  Eigen::VectorXd theta0_;
  std::vector<double> noise_density_;
  std::vector<double> mass_;    ///< floors x frames
  Eigen::MatrixXd constraint_;  ///< constraint of rigid floors; empty if floors are flexible
  PerturbedDesigns perturbed_;
  std::vector<FloorNoise> noise_;
  std::vector<FloorRows> rows_;

  // Buffers of single calls, kept to avoid allocations.
  std::vector<int> equations_;
  Eigen::MatrixXd basis_, modes_, stiffness_;  ///< frames x rows, frames x rows, frames x frames
  std::vector<double> projected_;
  Eigen::VectorXd frequency_hz_, force_, inertia_, common_;
  JacobiEigen eigen_;
};

/// Forms the regression rows of every floor from p, p' and p'' of the element deformations. Each
/// row passes its oscillator section, the last part of the drift-controlled integrator
/// (docs/equations.md (12)), and is weighted (13).
class RegressorFilter : public RowFilter {
 public:
  /// settle: instants that a floor's filters run before its rows count, after a start or when other
  /// motions become known. The tuning must outlive the filter.
  RegressorFilter(RegressorTuning& tuning, const FloorLayout& layout, int settle);

  void reset(int settle) override;
  void push(const DeformationSet& set) override;

  int count(int floor) const override {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.settling > 0 || f.starting ? 0 : f.rows->rows;
  }
  bool forms(int floor) const override {
    const Floor& f = floor_[static_cast<std::size_t>(floor)];
    return f.settling == 0 && f.rows->rows > 0;
  }
  const FloorRows& floor_rows(int floor) const override {
    return *floor_[static_cast<std::size_t>(floor)].rows;
  }

  std::uint8_t origin_of(int floor, const FloorRows* rows) const override {
    if (rows == nullptr) return 0;
    if (rows == &tuning_->rows(floor)) return 1;
    return rows == &floor_[static_cast<std::size_t>(floor)].some_known ? 2 : 0;
  }
  const FloorRows* floor_rows_from(int floor, std::uint8_t origin) const override {
    if (origin == 1) return &tuning_->rows(floor);
    return origin == 2 ? &floor_[static_cast<std::size_t>(floor)].some_known : nullptr;
  }
  void save(StateWriter& state) override { members(state); }
  void load(StateReader& state) override { members(state); }

 private:
  void members(auto& a) {
    a.within(settle_, 0, a.kMaxCount);
    a.each_within(known_, 0, 1);
    a.finite(rows_);
    for (int floor = 0; floor < layout_->floors(); ++floor) {
      Floor& f = floor_[static_cast<std::size_t>(floor)];
      std::uint8_t origin = origin_of(floor, f.rows);
      a(origin, f.some_known);
      if (!f.some_known.fits(*layout_, floor)) a.refuse();
      a.finite(f.s1, f.s2);
      a(f.past, f.starting);
      a.within(f.settling, 0, a.kMaxCount);
      f.rows = floor_rows_from(floor, origin == 2 ? 2 : 1);
    }
  }

  struct Floor {
    const FloorRows* rows = nullptr;  ///< the tuning's rows, or some_known
    FloorRows some_known;
    std::vector<double> s1, s2;
    UnknownPast past;
    bool starting = false;  ///< too few rows since the start to determine the past
    int settling = 0;
  };
  void rebuild(int floor);
  bool all_known_around(int floor) const;
  bool same_surroundings(int floor, const std::vector<std::uint8_t>& known) const;

  RegressorTuning* tuning_;
  const FloorLayout* layout_;
  int settle_;
  std::vector<std::uint8_t> known_;
  std::vector<int> changed_;
  std::vector<Floor> floor_;
  std::vector<double> signal_, response_;
};

}  // namespace framewatch::estimator
