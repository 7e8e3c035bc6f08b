#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/deformations.h"
#include "estimator/identify/floor_layout.h"
#include "estimator/identify/floor_noise.h"
#include "estimator/identify/kernels.h"
#include "estimator/identify/noise_moments.h"
#include "estimator/identify/symmetric_eigen.h"
#include "estimator/identify/wrong_designs.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/motion_filter.h"
#include "estimator/options.h"

namespace framewatch {

/// Share of the sensor noise in the normal matrix that the solver takes off. All of it would be
/// unbiased but blows up where there is little but noise; so this share goes, and the right-hand
/// side is corrected such that what is left pulls toward the design only.
/// docs/equations.md, noise in the regressors.
inline constexpr double kTakenOff = 0.8;

struct FloorRows;

/// The part of a floor's sensor noise per instant that a solver takes off, packed like the sums:
/// `share` of the normal matrix, and of the right-hand side so much that the rest pulls toward the
/// design.
void pack_taken_off(const FloorLayout& layout, int floor, const FloorRows& rows, double share,
                    std::vector<double>& out);

/// One floor's projected equations: each row r is sum_f phi_rf (equation f), low-passed by an
/// all-pole section s = gain x - a1 s' - a2 s'' and scaled by the root of its weight.
struct FloorRows {
  int rows = 0;
  std::vector<double> gain, a1, a2;  ///< per row
  std::vector<double> frequency_hz;  ///< corner of each row's filter
  /// rows x padded(front): multiplies the filtered front signals [deformations..., response].
  std::vector<double> beta;
  std::vector<double> response;  ///< rows x frames: -phi_rf, forms the response from m p''
  /// What sensor noise adds per instant, for the design: to the normal matrix (unknowns x
  /// unknowns), to the right-hand side, and to the energy of the response.
  std::vector<double> noise_energy;
  std::vector<double> noise_diagonal;  ///< of noise_energy
  std::vector<double> noise_pull;      ///< noise_energy times the wrong designs' errors
  std::vector<double> noise_right;
  double noise_response = 0;
  /// The part of these that the solver takes off per instant, packed like the sums.
  std::vector<double> noise_taken_off;
  double noise_residual = 0;  ///< expected weighted squared residual per instant

  template <typename Archive>
  void archive(Archive& a) {
    a(rows, gain, a1, a2, frequency_hz, beta, response, noise_energy, noise_diagonal, noise_pull);
    a(noise_right, noise_response, noise_taken_off, noise_residual);
  }
};

/// How the rows of every floor are formed for one design theta0. docs/equations.md, matched rows.
/// Allocates when constructed, never after.
class RowTuning {
 public:
  /// Structure to high_pass must outlive the object. theta0 > 0, theta order. noise_density: of
  /// every axis, m/s^2/sqrt(Hz), > 0; empty: the configured ones.
  RowTuning(const Structure& structure, const FloorLayout& layout, const Deformations& deformations,
            const EstimatorOptions& options, const DerivativeTriple& triple,
            const HighPass& high_pass, const Eigen::VectorXd& theta0,
            std::vector<double> noise_density = {});

  /// Another design, of the same sizes. Every floor must then be tuned before anything else is
  /// asked.
  void set_design(const Eigen::VectorXd& theta0, const std::vector<double>& noise_density);
  void tune(int floor);

  /// Rows of a floor when every motion is known.
  const FloorRows& rows(int floor) const { return rows_[static_cast<std::size_t>(floor)]; }
  /// known: (floors + 1) x frames flags of DeformationSet. Equations that need an unknown motion
  /// are left out and the rest projected on their own eigenvectors. out: once a copy of
  /// rows(floor).
  void rows(int floor, const std::vector<std::uint8_t>& known, FloorRows& out);

  const Eigen::VectorXd& design() const { return theta0_; }
  const std::vector<double>& noise_density() const { return noise_density_; }
  /// Instants the slowest row filter needs to forget its start: 3 / (zeta w), and at least `least`.
  int settle_rows(int least) const;
  /// Largest relative change of a floor's filters' corners between this design and `theta`.
  double detuning(int floor, const Eigen::VectorXd& theta);

  template <typename Archive>
  void archive(Archive& a) {
    a(theta0_, noise_density_, noise_, rows_);
  }

 private:
  void form(int floor, FloorRows& out);
  void weigh(int floor, int r, FloorRows& out);
  void pack_noise(int floor, FloorRows& out) const;
  double damping() const;
  void take_all_equations();
  void take_usable_equations(int floor, const std::vector<std::uint8_t>& known);
  int floor_modes(int floor, const Eigen::VectorXd& theta);
  void floor_stiffness(int floor, const Eigen::VectorXd& theta);
  double design_at(int floor, int position) const {
    return theta0_[layout_->parameter(floor, position)];
  }
  double mass(int floor, int f) const {
    return mass_[static_cast<std::size_t>(floor * layout_->frames() + f)];
  }

  const FloorLayout* layout_;
  const EstimatorOptions* options_;
  NoiseFilter noise_filter_;
  Eigen::VectorXd theta0_;
  std::vector<double> noise_density_;
  std::vector<double> mass_;    ///< floors x frames
  Eigen::MatrixXd constraint_;  ///< of rigid floors; empty when flexible
  WrongDesigns wrong_;
  std::vector<FloorNoise> noise_;
  std::vector<FloorRows> rows_;

  // Of one call, kept so that it need not allocate.
  std::vector<int> equations_;
  Eigen::MatrixXd basis_, modes_, stiffness_;  ///< frames x rows, frames x rows, frames x frames
  std::vector<double> projected_;
  Eigen::VectorXd frequency_hz_, force_, inertia_, common_;
  SymmetricEigen eigen_;
};

}  // namespace framewatch
