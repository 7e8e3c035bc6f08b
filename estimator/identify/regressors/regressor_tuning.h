#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/elements/perturbed_designs.h"
#include "estimator/identify/noise/floor_noise.h"
#include "estimator/identify/noise/noise_moments.h"
#include "estimator/motion/derivative_triple.h"
#include "estimator/motion/drift_controlled_integrator.h"
#include "estimator/motion/oscillator_section.h"
#include "estimator/numeric/jacobi_eigen.h"
#include "estimator/numeric/kernels.h"
#include "estimator/setup/options.h"

namespace framewatch::estimator {

/// Share of the sensor noise in the normal matrix that the solver subtracts. Subtracting all of it
/// would be unbiased, but the solution would diverge where there is little but noise. So this share
/// is subtracted, and the right-hand side corrected such that the rest biases toward theta0 only.
/// docs/equations.md, noise in the regressors.
inline constexpr double kCompensatedShare = 0.8;

struct FloorRows;

/// The part of a floor's sensor noise per instant that a solver subtracts, packed like the sums:
/// `share` of the normal matrix, and so much of the right-hand side that the rest biases toward
/// theta0.
void pack_compensation(const FloorLayout& layout, int floor, const FloorRows& rows, double share,
                       std::vector<double>& out);

/// One floor's projected equations: each row r is sum_f phi_rf (equation f), filtered by its
/// oscillator section and scaled by the root of its weight.
struct FloorRows {
  /// Whether all sizes are those of a floor of this layout; numbers from a file may be any.
  bool fits(const FloorLayout& layout, int floor) const;

  int rows = 0;
  std::vector<double> gain, a1, a2;  ///< OscillatorSection of every row
  std::vector<double> frequency_hz;  ///< its corner
  /// rows x padded(front): multiplies the filtered front signals [deformations..., response].
  std::vector<double> beta;
  std::vector<double> response;  ///< rows x frames: -phi_rf, forms the response from m p''
  /// What sensor noise adds per instant, for x = 1: to the normal matrix (unknowns x
  /// unknowns), to the right-hand side, and to the energy of the response.
  std::vector<double> noise_energy;
  std::vector<double> noise_diagonal;  ///< of noise_energy
  std::vector<double> noise_bias;      ///< noise_energy times PerturbedDesigns
  std::vector<double> noise_right;
  double noise_response = 0;
  /// The part of these that the solver subtracts per instant, packed like the sums.
  std::vector<double> noise_compensation;
  double noise_residual = 0;  ///< expected weighted squared residual per instant

  template <typename Archive>
  void archive(Archive& a) {
    a(rows);
    for (std::vector<double>* values :
         {&gain, &a1, &a2, &frequency_hz, &beta, &response, &noise_energy, &noise_diagonal,
          &noise_bias, &noise_right, &noise_compensation})
      a.any_size(*values);
    a.finite(noise_response, noise_residual);
  }
};

/// How the rows of every floor are formed: projection, oscillator sections and weights for given
/// parameters theta0, the design of the drawings at first, later what was identified.
/// docs/equations.md, matched rows.
/// Allocates when constructed, never after.
class RegressorTuning {
 public:
  /// Structure to high_pass must outlive the object. theta0 > 0, theta order. noise_density: of
  /// every axis, m/s^2/sqrt(Hz), > 0; empty: the configured ones.
  RegressorTuning(const Structure& structure, const FloorLayout& layout,
                  const Deformations& deformations, const EstimatorOptions& options,
                  const DerivativeTriple& triple, const HighPass& high_pass,
                  const Eigen::VectorXd& theta0, std::vector<double> noise_density = {});

  /// Other parameters. Every floor must then be tuned before anything else is asked.
  void set_theta0(const Eigen::VectorXd& theta0, const std::vector<double>& noise_density);
  void tune(int floor);

  /// Rows of a floor when every motion is known.
  const FloorRows& rows(int floor) const { return rows_[static_cast<std::size_t>(floor)]; }
  /// known: (floors + 1) x frames flags of DeformationSet. Equations that need an unknown motion
  /// are left out and the rest projected on their own eigenvectors. out: once a copy of
  /// rows(floor).
  void rows(int floor, const std::vector<std::uint8_t>& known, FloorRows& out);

  const Eigen::VectorXd& theta0() const { return theta0_; }
  const std::vector<double>& noise_density() const { return noise_density_; }
  /// Instants the slowest section needs to forget its start: 3 / (zeta w), and at least `least`.
  int settle_rows(int least) const;
  /// Largest relative change of the corners of a floor's sections between theta0 and `theta`.
  double detuning(int floor, const Eigen::VectorXd& theta);

  template <typename Archive>
  void archive(Archive& a) {
    a.finite(theta0_, noise_density_);
    a(noise_, rows_);
    for (int floor = 0; floor < layout_->floors(); ++floor)
      if (!rows(floor).fits(*layout_, floor)) a.refuse();
  }

 private:
  void form(int floor, FloorRows& out);
  void weigh(int floor, int r, const OscillatorSection& section, FloorRows& out);
  void pack_noise(int floor, FloorRows& out) const;
  double damping() const;
  void take_all_equations();
  void take_usable_equations(int floor, const std::vector<std::uint8_t>& known);
  int floor_modes(int floor, const Eigen::VectorXd& theta);
  void floor_stiffness(int floor, const Eigen::VectorXd& theta);
  double theta0_at(int floor, int position) const {
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
  PerturbedDesigns perturbed_;
  std::vector<FloorNoise> noise_;
  std::vector<FloorRows> rows_;

  // Of one call, kept so that it need not allocate.
  std::vector<int> equations_;
  Eigen::MatrixXd basis_, modes_, stiffness_;  ///< frames x rows, frames x rows, frames x frames
  std::vector<double> projected_;
  Eigen::VectorXd frequency_hz_, force_, inertia_, common_;
  JacobiEigen eigen_;
};

}  // namespace framewatch::estimator
