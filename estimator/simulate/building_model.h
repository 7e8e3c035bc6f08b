#pragma once

#include <memory>
#include <vector>

#include <Eigen/Core>

#include "estimator/simulate/applied_force.h"
#include "estimator/simulate/element_law.h"
#include "estimator/simulate/linear_model.h"
#include "estimator/structure/effect.h"
#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// extra_mass, tuned_mass_damper, base_rocking, frame_bending, added_spring, added_damper,
/// modal_damping and floor_flexibility act here, the other kinds do not.
LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects);
/// The same under other inputs. influence: Inputs::influence.
LinearModel linear_model(const Structure& structure, const ParameterTable& table,
                         const Eigen::VectorXd& theta, const std::vector<Effect>& effects,
                         const Eigen::MatrixXd& influence);

/// A law on an element of LinearModel::linear, or between floors.
struct PlacedLaw {
  int element;  ///< -1: `between`
  std::unique_ptr<ElementLaw> law;
  /// Degrees of freedom whose displacements are added and subtracted; the second may be missing.
  std::vector<int> between;

  /// b of the deformation b'y. size: of y.
  Eigen::VectorXd deformation(const LinearModel& model) const;
};

struct PlacedForce {
  int dof;
  AppliedForce force;
};

/// The laws of `effects`, in their order.
std::vector<PlacedLaw> placed_laws(const Structure& structure, const ParameterTable& table,
                                   const Eigen::VectorXd& theta,
                                   const std::vector<Effect>& effects);
std::vector<PlacedForce> placed_forces(const Structure& structure,
                                       const std::vector<Effect>& effects);

/// Whether the building with its effects stands: its linear stiffness, with every p_delta and all
/// that is lost by stiffness_drop and stiffness_drift, is positive definite.
bool stands(const Structure& structure, const ParameterTable& table, const Eigen::VectorXd& theta,
            const std::vector<Effect>& effects);

/// Whether any effect needs more than LinearBuilding: all but those of channels do.
bool concerns_building(const std::vector<Effect>& effects);

}  // namespace framewatch::estimator
