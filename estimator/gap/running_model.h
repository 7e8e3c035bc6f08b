#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/gap/gap.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/simulate/simulated_building.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A model that is simulated in step with the building, under its measured inputs. Between the
/// samples these are interpolated by a windowed sinc, at steps of 1 ms at most. The floors'
/// accelerations pass drift control and filter as the measured ones do; the inputs do not, because
/// nonlinear laws do not commute with a filter.
class RunningModel {
 public:
  /// late: delay of every input's samples, less than an instant, in instants.
  RunningModel(const Structure& structure, const ParameterTable& table, const GapModel& model,
               const Inputs& inputs, double rate_hz, double high_pass_hz,
               const Eigen::VectorXd& late);

  /// Model and inputs at rest, also in the past.
  void restart();
  /// The inputs at the next instant.
  void push(const Eigen::VectorXd& inputs);
  /// Filtered absolute acceleration of a degree of freedom (Structure::dof), m/s^2: what a sensor
  /// there and a DriftControlledIntegrator give kDelay instants before the newest.
  double accel_abs(int dof) const { return filter_.value(dof); }
  /// Time after which the initial state is forgotten.
  double settle_s() const { return settle_s_; }

  static constexpr int kDelay = 16;  ///< instants

  template <typename Archive>
  void archive(Archive& a) {
    std::vector<double> motion = building_->motion();
    a.finite(recent_, bias_, before_, motion);
    a.within(newest_, 0, kTaps - 1);
    a(filter_);
    if constexpr (Archive::kReading) {
      if (!building_->resume(motion)) restart();
    }
  }

 private:
  static constexpr int kTaps = 2 * kDelay + 1;
  static constexpr double kAfterEverything_s = 1e6;

  int steps_;  ///< per instant
  std::unique_ptr<DrivenBuilding> building_;
  std::vector<double> rest_;  ///< its motion
  double settle_s_;
  using Taps = Eigen::Matrix<double, Eigen::Dynamic, kTaps>;
  static Taps taps(int steps, double late);
  std::vector<Taps> taps_;  ///< of each input: steps x instants, newest first
  Eigen::MatrixXd recent_;  ///< inputs x ring of kTaps instants
  int newest_ = 0;
  double bias_share_;  ///< of a sample in the slow mean that is no motion
  Eigen::VectorXd bias_, before_, after_;
  DriftControlledIntegrator filter_;
  std::vector<double> unfiltered_;
};

}  // namespace framewatch::estimator
