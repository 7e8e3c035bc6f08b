// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/building_model.h"
#include "estimator/simulate/simulated_building.h"

namespace framewatch::estimator {

/// A building with effects. The matrix exponential advances its linear part, exactly while the
/// inputs are linear within a step. The fourth-order Runge-Kutta scheme advances laws and forces,
/// in coordinates that move with the linear part (Lawson, SIAM J. Numer. Anal. 4, 1967). Without
/// laws it equals LinearBuilding up to rounding. Diagnosis deliberately fits with another scheme.
class NonlinearBuilding : public DrivenBuilding {
 public:
  /// effects: without problems; those of channels are ignored. step_s: > 0. A step is divided into
  /// as many parts as the stiffest law and the fastest mode need, times `refinement`.
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects, double step_s,
                    int refinement = 1);
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects, Inputs inputs,
                    double step_s, int refinement = 1);
  /// more_laws: laws beyond the catalog.
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects,
                    std::vector<PlacedLaw> more_laws, Inputs inputs, double step_s,
                    int refinement = 1);

  void set_theta(const Eigen::VectorXd& theta) override;
  /// Sets the state relative to the ground, m and m/s; hidden masses move with the ground, at rest.
  void set_state(const Eigen::VectorXd& disp_rel, const Eigen::VectorXd& vel_rel);
  void drive(const Eigen::Ref<const Eigen::VectorXd>& before,
             const Eigen::Ref<const Eigen::VectorXd>& after) override;
  double step_s() const override { return step_s_; }
  void set_time(double time_s) override { time_s_ = part_start_s_ = time_s; }
  int parts() const { return parts_; }
  Eigen::VectorXd disp_rel() const override;
  Eigen::VectorXd vel_rel() const override;
  const Eigen::VectorXd& accel_abs() const override { return accel_abs_; }
  const Eigen::VectorXd& applied_n() const override { return applied_n_; }
  std::vector<double> motion() const override;
  [[nodiscard]] bool resume(const std::vector<double>& motion) override;

 private:
  /// A law in independent coordinates.
  struct Law {
    Eigen::VectorXd b;     ///< deformation = b'q
    Eigen::VectorXd push;  ///< acceleration of the coordinates per newton
    int first_state;
  };
  /// The effect of laws and forces at one stage.
  struct Slope {
    Eigen::VectorXd accel;   ///< of the coordinates
    Eigen::VectorXd states;  ///< z'
  };

  void choose_parts(const LinearModel& model, const Eigen::MatrixXd& mass_inverse);
  void advance_part(double part_s);
  void evaluate(double time_s, const Eigen::VectorXd& state, const Eigen::VectorXd& z,
                const Eigen::VectorXd& forces, Slope& out) const;
  void forces_at(double time_s, Eigen::VectorXd& out) const;
  /// Moves the coordinates of a state freely for half a part.
  void flow(const Eigen::VectorXd& state, Eigen::VectorXd& out) const;
  /// Moves the effect of an acceleration `accel` now over half a part.
  void carry(const Eigen::VectorXd& accel, Eigen::VectorXd& out) const;
  void update_accel();

  Structure structure_;
  ParameterTable table_;
  std::vector<Effect> effects_;
  std::vector<PlacedLaw> laws_;
  std::vector<PlacedForce> forces_;
  Inputs inputs_;
  double step_s_;
  int refinement_;
  int parts_ = 1;
  double time_s_ = 0;
  double part_start_s_ = 0;
  double velocity_scale_ = 1;  ///< 1/s; displacements are stored times this, which balances L
  Eigen::MatrixXd constraint_;
  RowMatrix half_;         ///< 2 coordinates x (state, inputs, their slope): over half a part
  RowMatrix output_;       ///< degrees of freedom x state
  RowMatrix output_push_;  ///< degrees of freedom x coordinates: their accelerations
  RowMatrix direct_;       ///< degrees of freedom x inputs: immediate effect of forces
  std::vector<Law> placed_;
  std::vector<Eigen::VectorXd> force_push_;
  Eigen::VectorXd state_;  ///< scaled coordinates, their velocities, inputs, their slope
  Eigen::VectorXd z_;      ///< of all laws
  Eigen::VectorXd accel_abs_;
  Eigen::VectorXd applied_n_;
  // Scratch of one part.
  Slope k1_, k2_, k3_, k4_;
  Eigen::VectorXd middle_, stage_, end_, carried_, stage_z_, force_now_, force_middle_, force_end_;
};

}  // namespace framewatch::estimator
