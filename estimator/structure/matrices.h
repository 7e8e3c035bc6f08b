#pragma once

#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/structure/parameter_table.h"
#include "estimator/structure/structure.h"

namespace framewatch::estimator {

/// One frame story or floor panel: a rank-one contribution b b^T times its stiffness (damping).
/// b holds (degree of freedom, coefficient) pairs: a vertical frame +1 at its floor and -1 at the
/// floor below; a panel sqrt(Lx/Ly)(u_{l+1} - u_l) + sqrt(Ly/Lx)(v_{j+1} - v_j), docs/equations.md.
struct Element {
  int story;
  int frame;      ///< -1 for a panel
  int panel;      ///< -1 for a frame
  int stiffness;  ///< index in theta; damping is at + ParameterTable::elements()
  std::vector<std::pair<int, double>> b;
};

/// All elements in the order of the stiffness half of theta.
std::vector<Element> elements(const Structure& structure, const ParameterTable& table);

/// Mass (diagonal, kg), damping and stiffness of M y'' + C y' + K y = -M r a_g, degrees of freedom
/// story-major (Structure::dof). Source: paper equations (4)-(12), misprints corrected.
struct Matrices {
  Eigen::VectorXd mass;
  Eigen::MatrixXd damping;
  Eigen::MatrixXd stiffness;
};
Matrices assemble(const Structure& structure, const ParameterTable& table,
                  const Eigen::VectorXd& theta);

/// Degrees of freedom x (x, y): 1 where motion of the ground in that direction moves it.
Eigen::MatrixXd ground_influence(const Structure& structure);

/// degrees of freedom x independent coordinates. Identity when floors are flexible; for rigid
/// floors three columns per floor at most: translations and rotation about the plan's centre,
/// orthonormal under the floor's mass.
Eigen::MatrixXd floor_constraint(const Structure& structure);

}  // namespace framewatch::estimator
