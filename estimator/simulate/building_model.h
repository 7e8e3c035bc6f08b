// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/element_law.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// The force of the effect unmeasured_force, N, positive toward +x or +y: a sine plus a stationary
/// Gaussian force, which is a sum of sines with seeded frequencies and phases. Identical on every
/// machine.
class AppliedForce {
 public:
  explicit AppliedForce(const Effect& effect);

  double from_s() const { return from_s_; }
  /// Returns the force at time_s, N, as if it had always acted.
  double at(double time_s) const;

 private:
  struct Tone {
    double amplitude;  ///< N
    double omega;      ///< rad/s
    double phase;      ///< rad
  };
  std::vector<Tone> tones_;
  double from_s_;
};

/// A spring and a dashpot along b: force k b'y + c b'y' on the degrees of freedom b.
struct LinearElement {
  Eigen::VectorXd b;
  double stiffness = 0;  ///< N/m
  double damping = 0;    ///< N*s/m
};

/// The linear part of a building with its effects. Degrees of freedom are the structure's, then one
/// for each hidden mass, all relative to the ground.
struct LinearModel {
  Eigen::VectorXd mass;               ///< kg
  Eigen::MatrixXd influence;          ///< x inputs: acceleration with the base, per unit of input
  Eigen::MatrixXd constraint;         ///< x independent coordinates
  std::vector<LinearElement> linear;  ///< those of theta in its order, then those of the effects

  Eigen::MatrixXd stiffness() const;  ///< of the degrees of freedom
  Eigen::MatrixXd damping() const;
};

/// Builds the linear model. extra_mass, tuned_mass_damper, base_rocking, frame_bending,
/// added_spring, added_damper, modal_damping and floor_flexibility act in it; the other kinds do
/// not.
LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects);
/// Builds the linear model for other inputs. influence: Inputs::influence. bending: hinges of the
/// design, in series with those of frame_bending.
LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects,
                         const Eigen::MatrixXd& influence, const BendingStiffness& bending = {});

/// Returns the rotational stiffness of base_rocking along a direction, all such effects in series,
/// N*m/rad; 0 without any.
double rocking_stiffness(const std::vector<Effect>& effects, Direction direction);
/// Returns the rotational stiffness of the hinges at every floor of a frame, base first, those of
/// frame_bending in series with the design's, N*m/rad. Empty: frames do not bend.
std::vector<double> hinge_stiffness(const Structure& structure, const std::vector<Effect>& effects,
                                    const BendingStiffness& bending, Direction direction);

/// A law on an element of LinearModel::linear, or between floors.
struct PlacedLaw {
  int element;  ///< -1: see `between`
  std::unique_ptr<ElementLaw> law;
  /// Degrees of freedom whose displacements are added and subtracted; the second may be missing.
  std::vector<int> between;

  /// Returns b of the deformation b'y.
  Eigen::VectorXd deformation(const LinearModel& model) const;
};

struct PlacedForce {
  int dof;
  AppliedForce force;
};

/// Return the laws and the forces of `effects`, in their order.
std::vector<PlacedLaw> placed_laws(const Structure& structure, const ParameterTable& table,
                                   const Eigen::VectorXd& theta,
                                   const std::vector<Effect>& effects);
std::vector<PlacedForce> placed_forces(const Structure& structure,
                                       const std::vector<Effect>& effects);

/// Returns true if the building with its effects is stable: its linear stiffness is positive
/// definite, with every p_delta and all losses by stiffness_drop and stiffness_drift.
bool stands(const Structure& structure, const ParameterTable& table, const Eigen::VectorXd& theta,
            const std::vector<Effect>& effects);

/// Returns true if any effect needs NonlinearBuilding: all but those of channels do.
bool concerns_building(const std::vector<Effect>& effects);

}  // namespace framewatch::estimator
