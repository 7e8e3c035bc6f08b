// SPDX-License-Identifier: MIT
#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// A frame story or floor panel. It contributes b b^T times its stiffness to the stiffness matrix,
/// and b b^T times its damping to the damping matrix. b holds pairs of a degree of freedom and a
/// coefficient. A frame story has +1 at its floor and -1 at the floor below; a panel has
/// sqrt(Lx/Ly)(u_{l+1} - u_l) + sqrt(Ly/Lx)(v_{j+1} - v_j), docs/equations.md.
struct Element {
  int story;
  int frame;      ///< -1 for a panel
  int panel;      ///< -1 for a frame
  int stiffness;  ///< index in theta; the damping is ParameterTable::elements() further
  std::vector<std::pair<int, double>> b;
};

/// Returns all elements in the order of the stiffness half of theta.
std::vector<Element> elements(const Structure& structure, const ParameterTable& table);

/// Returns the mass of every frame on every floor, kg, by degree of freedom.
Eigen::VectorXd frame_masses(const Structure& structure);

/// Mass (diagonal, kg), damping and stiffness of M y'' + C y' + K y = -M r a_g. Degrees of freedom
/// are story-major (Structure::dof). Source: equations (4)-(12) of the paper, misprints corrected.
struct Matrices {
  Eigen::VectorXd mass;
  Eigen::MatrixXd damping;
  Eigen::MatrixXd stiffness;
};
Matrices assemble(const Structure& structure, const ParameterTable& table,
                  const Eigen::VectorXd& theta);

/// Returns a matrix of degrees of freedom x (x, y): 1 where ground motion in that direction moves
/// the degree of freedom.
Eigen::MatrixXd ground_influence(const Structure& structure);

/// Returns a matrix of degrees of freedom x independent coordinates: the identity if floors are
/// flexible. Rigid floors have at most three columns each, two translations and the rotation about
/// the plan's center, orthonormal under the floor's mass.
Eigen::MatrixXd floor_constraint(const Structure& structure);

}  // namespace framewatch::estimator
