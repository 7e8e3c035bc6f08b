// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/gap/gap.h"
#include "estimator/gap/measured_inputs.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// Simulates a model in step with the building, under its measured inputs. A windowed sinc
/// interpolates these between samples, at steps of at most 1 ms. The floors' accelerations pass the
/// same drift control and filter as the measured ones. The inputs do not, because nonlinear laws do
/// not commute with a filter.
class RunningModel {
 public:
  /// late: delay of every input's samples, less than an instant, in instants.
  RunningModel(const Structure& structure, const ParameterTable& table, const GapModel& model,
               const Inputs& inputs, double rate_hz, double high_pass_hz,
               const Eigen::VectorXd& late);

  /// Sets model and inputs to rest, also in the past.
  void restart();
  /// Takes the inputs at the next instant.
  void push(const Eigen::VectorXd& inputs);
  /// Returns the filtered absolute acceleration of a degree of freedom (Structure::dof), m/s^2, as
  /// a sensor there and a DriftControlledIntegrator return it, kDelay instants before the newest.
  double accel_abs(int dof) const { return filter_.value(dof); }
  /// Returns the time after which the initial state is forgotten, s.
  double settle_s() const { return settle_s_; }

  /// Returns the share of the initial state's motion that remains after a time.
  double remains(double time_s) const;

  static constexpr int kDelay = 16;  ///< instants

  void archive(auto& a) {
    std::vector<double> motion = building_->motion();
    a.finite(recent_, bias_, before_, motion);
    a.within(newest_, 0, kTaps - 1);
    a(filter_);
    if (a.kReading) {
      if (building_->resume(motion))
        motion_ = motion;
      else
        restart();
    }
  }

 private:
  static constexpr int kTaps = 2 * kDelay + 1;
  void step_through();
  void leap();
  void prepare_leap();
  static constexpr double kAfterEverything_s = 1e6;

  int steps_;  ///< per instant
  std::unique_ptr<DrivenBuilding> building_;
  std::vector<double> rest_;  ///< its motion at rest
  double settle_s_;
  using Taps = Eigen::Matrix<double, Eigen::Dynamic, kTaps>;
  static Taps taps(int steps, double late);
  std::vector<Taps> taps_;  ///< of each input: steps x instants, newest first
  Eigen::MatrixXd recent_;  ///< inputs x ring of kTaps instants
  /// All steps of an instant at once, without rows if the building is not linear: (motion, before_,
  /// recent_ newest first) x motion, padded.
  RowMatrix leap_;
  std::vector<double> from_, to_;  ///< of leap_
  std::vector<double> motion_;     ///< of a linear building
  int newest_ = 0;
  double bias_share_;  ///< weight of a sample in the slow mean, which is bias
  Eigen::VectorXd bias_, before_, after_;
  DriftControlledIntegrator filter_;
  std::vector<double> unfiltered_;
};

/// Computes the gain of white noise of the input axes, through a model and through the filters
/// alone: sums of squares of their impulse responses. Nonlinear laws of elements are omitted,
/// because noise is small. Each call computes a few instants, so no instant is late.
class NoisePath {
 public:
  NoisePath(const Structure& structure, const ParameterTable& table, const GapModel& model,
            const MeasuredInputs& inputs, double rate_hz, double high_pass_hz);

  /// Computes the next few instants.
  void advance();
  bool known() const { return next_ == static_cast<int>(inputs_.used.size()); }
  /// Returns the variance of a filtered axis per variance of its samples.
  double own() const { return own_; }
  /// Returns degrees of freedom x all axes: variance per variance of the axis' samples.
  /// Precondition: known().
  const Eigen::MatrixXd& inputs() const { return gain_; }

  void archive(auto& a) {
    a(model_);
    a.within(next_, 0, static_cast<double>(inputs_.used.size()));
    a.within(instant_, 0, instants_ - 1);
    a.finite(gain_);
  }

 private:
  MeasuredInputs inputs_;
  RunningModel model_;
  int instants_;  ///< length of a response
  int next_ = 0, instant_ = 0;
  double own_;
  Eigen::MatrixXd gain_;
};

}  // namespace framewatch::estimator
