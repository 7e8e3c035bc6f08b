#pragma once

#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/building_model.h"
#include "estimator/simulate/driven_building.h"

namespace framewatch::estimator {

/// A building with effects. Its linear part is advanced by the matrix exponential, exactly while
/// the inputs are linear within a step; laws and forces by the fourth-order Runge-Kutta
/// scheme in the coordinates that move with it (Lawson, SIAM J. Numer. Anal. 4, 1967). Without laws
/// it is LinearBuilding up to rounding. Diagnosis fits with another scheme, on purpose.
class NonlinearBuilding : public DrivenBuilding {
 public:
  /// Effects without problems, those of channels are ignored; step_s > 0. A step is divided into as
  /// many parts as the stiffest law and the fastest mode need, times `refinement`.
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects, double step_s,
                    int refinement = 1);
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects, Inputs inputs,
                    double step_s, int refinement = 1);
  /// The same with laws beyond the catalogue.
  NonlinearBuilding(const Structure& structure, const ParameterTable& table,
                    const Eigen::VectorXd& theta, const std::vector<Effect>& effects,
                    std::vector<PlacedLaw> more_laws, Inputs inputs, double step_s,
                    int refinement = 1);

  void set_theta(const Eigen::VectorXd& theta) override;
  /// Relative to the ground; hidden masses move with it, at rest.
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
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// A law as the integration sees it, in independent coordinates.
  struct Law {
    Eigen::VectorXd b;     ///< deformation = b'q
    Eigen::VectorXd push;  ///< acceleration of the coordinates per newton
    int first_state;
  };
  /// What the laws and forces do at one stage.
  struct Slope {
    Eigen::VectorXd accel;   ///< of the coordinates
    Eigen::VectorXd states;  ///< z'
  };

  void choose_parts(const LinearModel& model, const Eigen::MatrixXd& mass_inverse);
  void advance_part(double part_s);
  void evaluate(double time_s, const Eigen::VectorXd& state, const Eigen::VectorXd& z,
                const Eigen::VectorXd& forces, Slope& out) const;
  void forces_at(double time_s, Eigen::VectorXd& out) const;
  /// The coordinates' part of a state that moves freely for half a part.
  void flow(const Eigen::VectorXd& state, Eigen::VectorXd& out) const;
  /// out = what `accel`, given now, has become after half a part.
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
  double velocity_scale_ = 1;  ///< 1/s; displacements are held times this, which evens out L
  Eigen::MatrixXd constraint_;
  RowMajor half_;         ///< 2 coordinates x (state, inputs, their slope): over half a part
  RowMajor output_;       ///< degrees of freedom x state
  RowMajor output_push_;  ///< degrees of freedom x coordinates: accelerations from those
  RowMajor direct_;       ///< degrees of freedom x inputs: what their forces do at once
  std::vector<Law> placed_;
  std::vector<Eigen::VectorXd> force_push_;
  Eigen::VectorXd state_;  ///< scaled coordinates, their velocities, inputs, their slope
  Eigen::VectorXd z_;      ///< of all laws
  Eigen::VectorXd accel_abs_;
  Eigen::VectorXd applied_n_;
  // Room for one part's arithmetic.
  Slope k1_, k2_, k3_, k4_;
  Eigen::VectorXd middle_, stage_, end_, carried_, stage_z_, force_now_, force_middle_, force_end_;
};

}  // namespace framewatch::estimator
