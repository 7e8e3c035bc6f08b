// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "daemon/tools/export/opensees_model.h"

namespace framewatch::daemon {

/// A row and column of the matrices.
struct MatrixRow {
  std::string name;   ///< "floor 1, frame y2"; on a rigid floor "floor 1, rotation"
  std::string along;  ///< x, y, or z for a rotation about the vertical axis
  std::string unit;   ///< m or rad
  int floor = 0;
};

/// M y'' + C y' + K y = -M r a_g in N, m, kg and s. On flexible floors a row is the displacement of
/// a frame at a floor; on a rigid floor, the two displacements of its middle and its rotation,
/// counter-clockwise from above. Hidden masses come last. All displacements are relative to the
/// base.
struct ModelMatrices {
  std::vector<MatrixRow> rows;
  Eigen::MatrixXd mass, damping, stiffness;
  Eigen::MatrixXd influence;  ///< rows x 2: r for ground motion along x and y
  Eigen::MatrixXd frames;     ///< frames at floors (Structure::dof) x rows: their displacements
};

/// Returns the matrices. Adds a problem for each effect that no matrix holds; the result is then
/// without it. Effects of sensors are skipped.
ModelMatrices model_matrices(const ExportedModel& model, std::vector<std::string>& problems);

/// Writes M.mtx, C.mtx, K.mtx, r.mtx, frames.mtx (Matrix Market), rows.csv and matrices.mat into
/// `folder`, which exists. Returns why this failed, or an empty text.
std::string write_matrices(const ModelMatrices& matrices, const std::string& folder);

/// A design that has been read from matrices.
struct MatrixDesign {
  Eigen::VectorXd theta;  ///< of every story, in the order of ParameterTable(structure), SI
  /// Shares of K and C that the building's frames and panels do not hold.
  double stiffness_rest = 0, damping_rest = 0;
};

/// Reads M.mtx, C.mtx and K.mtx from `folder`, with the rows of model_matrices() without effects,
/// and returns the stiffness and damping of each frame and panel that describe K and C best, by
/// least squares. Adds a problem if a file is missing or damaged, if M is not the building's, if K
/// leaves more than a hundredth, or if a stiffness is not positive.
std::optional<MatrixDesign> read_matrix_design(const estimator::Structure& structure,
                                               const std::string& folder,
                                               std::vector<std::string>& problems);

/// Parses a real matrix in the Matrix Market format, coordinate or array, general or symmetric.
/// Returns nullopt and adds a problem with `name` and the line if it is damaged or has other than
/// `size` rows and columns.
std::optional<Eigen::MatrixXd> parse_matrix_market(const std::string& name, const std::string& text,
                                                   Eigen::Index size,
                                                   std::vector<std::string>& problems);

}  // namespace framewatch::daemon
