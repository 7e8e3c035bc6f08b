// SPDX-License-Identifier: MIT
#include "estimator/identify/groups/layout_prediction.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "estimator/identify/elements/story_design.h"
#include "estimator/identify/groups/group_equations.h"
#include "estimator/identify/groups/group_tuning.h"
#include "estimator/identify/groups/reduced_building.h"
#include "estimator/numeric/nan.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {
namespace {

using Complex = std::complex<double>;
using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;

constexpr double kHighest_hz = 25, kGroundHighPass_hz = 0.25;
/// Step between frequencies: a share of the frequency, because modes are that narrow, within
/// bounds.
constexpr double kStepRatio = 0.02, kMinStep_hz = 0.02, kMaxStep_hz = 0.3;
constexpr double kNotLinear = 0.15;  // share of the effect of losing 20 to 40 % of a story
constexpr double kDetected = 4;      // standard errors of a difference

struct Frequency {
  double hz, step_hz;
  double ground = 0;  ///< one-sided density of the base's acceleration, (m/s^2)^2/Hz
};

std::vector<Frequency> frequencies(const ExpectedShaking& shaking) {
  std::vector<Frequency> out;
  for (double hz = kMinStep_hz; hz < kHighest_hz; hz += out.back().step_hz)
    out.push_back({hz, std::clamp(kStepRatio * hz, kMinStep_hz, kMaxStep_hz)});
  const double wg = 2 * M_PI * shaking.ground_frequency_hz, wc = 2 * M_PI * kGroundHighPass_hz;
  double sum = 0;
  for (Frequency& f : out) {
    const Complex s(0, 2 * M_PI * f.hz);
    const Complex resonance = 2 * shaking.ground_damping_ratio * wg * s + wg * wg;
    const Complex gain = resonance / (s * s + resonance) * s * s / (s * s + 1.2 * wc * s + wc * wc);
    f.ground = std::norm(gain);
    sum += f.ground * f.step_hz;
  }
  for (Frequency& f : out) f.ground *= shaking.rms_mps2 * shaking.rms_mps2 / sum;
  return out;
}

class Prediction {
 public:
  Prediction(const PipelineConfig& config, const std::vector<double>& noise_density,
             const ExpectedShaking& shaking, const DesignTolerance& tolerance,
             const SensorTolerance& sensors)
      : config_(config),
        table_(config.parameters()),
        tolerance_(tolerance),
        sensors_(sensors),
        design_(story_design(config)) {
    const std::vector<std::uint8_t> all = identifying(config.axes);
    building_ = reduced_building(config.structure, config.axes, table_, design_, all);
    const ReducedBuilding stories = reduced_building(
        config.structure, config.axes, ParameterTable(config.structure), design_, all, true);
    const Eigen::VectorXd one = Eigen::VectorXd::Ones(table_.size());
    const GroupEquations equations = group_equations(building_, one, config.options.rate_hz);
    rows_ = group_rows(config.options, design_, equations, table_.size());
    projection_ = equations.projection;
    collect(stories);
    sum(noise_density, shaking);
  }

  LayoutPrediction result() const {
    const auto parameters = static_cast<std::size_t>(table_.size());
    const auto dofs = static_cast<std::size_t>(config_.structure.degrees_of_freedom());
    LayoutPrediction out{std::vector<double>(parameters, kNaN),
                         std::vector<double>(parameters, kNaN),
                         std::vector<double>(parameters, kNaN),
                         std::vector<double>(dofs, std::numeric_limits<double>::infinity()),
                         {},
                         {}};
    const Index p = table_.size();
    if (building_.rows() == 0) return out;
    const Ldlt factor(information_);
    if (!factor.good() || !factor.positive()) return out;
    const MatrixXd inverse = factor.solve(MatrixXd(MatrixXd::Identity(p, p)));
    const double samples = config_.options.window_s * config_.options.rate_hz;
    const MatrixXd covariance = inverse * scores_ * inverse / samples;
    const MatrixXd sensitivity = inverse * mismatch_;
    for (Index i = 0; i < p; ++i)
      out.window_error[static_cast<std::size_t>(i)] = std::sqrt(covariance(i, i));
    add_design_error(sensitivity, out);
    add_sensor_error(inverse * misread_, out);
    add_changes(sensitivity, out);
    for (std::size_t dof = 0; dof < dofs; ++dof)
      for (Index i = 0; i < table_.elements(); ++i)
        out.smallest_loss[dof] =
            std::min(out.smallest_loss[dof], kDetected * std::sqrt(2.0) *
                                                 out.window_error[static_cast<std::size_t>(i)] /
                                                 std::abs(sensitivity(i, static_cast<Index>(dof))));
    return out;
  }

 private:
  /// Collects the stories' stiffness and the floors' masses as sums of w w'.
  void collect(const ReducedBuilding& stories) {
    const Structure& s = config_.structure;
    const ParameterTable all(s);
    const Index dofs = s.degrees_of_freedom();
    springs_ = MatrixXd::Zero(building_.size(), dofs);
    masses_ = MatrixXd::Zero(building_.size(), dofs);
    of_group_.assign(static_cast<std::size_t>(dofs), -1);
    rate_.resize(dofs);
    for (int story = 1; story <= s.stories; ++story)
      for (int f = 0; f < s.frames(); ++f) {
        const Index dof = s.dof(story, f);
        const int k = all.frame_stiffness(story, f);
        const MatrixXd& part = stories.parts[static_cast<std::size_t>(k)];
        Index largest = 0;
        part.diagonal().maxCoeff(&largest);
        springs_.col(dof) = part.col(largest) / std::sqrt(part(largest, largest));
        masses_.col(dof) = std::sqrt(s.frame_mass(story, f)) *
                           building_.frames.row(Index(story) * s.frames() + f).transpose();
        of_group_[static_cast<std::size_t>(dof)] = table_.frame_stiffness(story, f);
        rate_[dof] = design_.theta[all.frame_damping(story, f)] / design_.theta[k];
      }
  }

  void sum(const std::vector<double>& noise_density, const ExpectedShaking& shaking) {
    const Index p = table_.size();
    information_ = scores_ = MatrixXd::Zero(p, p);
    mismatch_ =
        MatrixXd::Zero(p, config_.structure.degrees_of_freedom() + config_.structure.stories);
    misread_ = MatrixXd::Zero(p, 2 * building_.from_axes.cols());
    if (building_.rows() == 0) return;
    const MatrixXd& from = building_.from_axes;
    read_ = Ldlt(MatrixXd(from * from.transpose())).solve(from).transpose();
    MatrixXd noise = MatrixXd::Zero(building_.measured, building_.measured);
    for (std::size_t a = 0; a < noise_density.size(); ++a) {
      const Eigen::VectorXd of_axis = from.col(static_cast<Index>(a));
      noise += noise_density[a] * noise_density[a] * of_axis * of_axis.transpose();
    }
    const std::vector<Frequency> all = frequencies(shaking);
    std::vector<AtFrequency> at_all;
    for (const Frequency& f : all) at_all.push_back(at(f.hz));
    weigh(all, at_all, noise);
    for (std::size_t i = 0; i < all.size(); ++i) add(all[i], at_all[i], noise);
  }

  /// Motion and residual at one frequency.
  struct AtFrequency {
    MatrixXcd motion;    ///< all coordinates by the measured ones
    MatrixXcd residual;  ///< filtered and projected rows x measured
    Eigen::VectorXcd filter;
  };

  AtFrequency at(double hz) const {
    AtFrequency out;
    const Complex s(0, 2 * M_PI * hz);
    const auto& b = building_;
    MatrixXd k = b.constant_stiffness, c = b.constant_damping;
    for (std::size_t p = 0; p < b.parts.size(); ++p) (b.damping[p] != 0 ? c : k) += b.parts[p];
    const MatrixXcd dynamic =
        k.cast<Complex>() + s * c.cast<Complex>() + s * s * b.mass.cast<Complex>();
    const Index inner = b.size() - b.measured;
    out.motion = MatrixXcd::Zero(b.size(), b.measured);
    out.motion.topRows(b.measured).setIdentity();
    if (inner > 0)
      out.motion.bottomRows(inner) =
          -ComplexLu(dynamic.bottomRightCorner(inner, inner))
               .solve(MatrixXcd(dynamic.bottomLeftCorner(inner, b.measured)));
    const double wh = 2 * M_PI * config_.options.high_pass_hz;
    const Complex high_pass = s * s / (s * s + std::sqrt(2.0) * wh * s + wh * wh);
    out.filter.resize(b.rows());
    for (Index r = 0; r < b.rows(); ++r) {
      const double w = 2 * M_PI * rows_.frequency_hz[static_cast<std::size_t>(r)];
      out.filter[r] = high_pass / (s * s + 2 * config_.options.filter_damping * w * s + w * w);
    }
    out.residual = rows(out, out.motion.transpose() * dynamic * out.motion);
    return out;
  }

  MatrixXcd rows(const AtFrequency& f, const MatrixXcd& on_measured) const {
    MatrixXcd out = projection_ * on_measured.bottomRows(building_.rows());
    for (Index r = 0; r < out.rows(); ++r) out.row(r) *= f.filter[r] * weight(r);
    return out;
  }
  double weight(Index r) const { return weights_.size() == 0 ? 1 : weights_[r]; }

  /// Scales rows to equal noise: those in `at_all` and those computed later.
  void weigh(const std::vector<Frequency>& frequencies, std::vector<AtFrequency>& at_all,
             const MatrixXd& noise) {
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(building_.rows());
    for (std::size_t i = 0; i < frequencies.size(); ++i) {
      const MatrixXcd& r = at_all[i].residual;
      variance += frequencies[i].step_hz * (r * noise * r.adjoint()).diagonal().real();
    }
    weights_ = variance.cwiseSqrt().cwiseInverse();
    for (AtFrequency& f : at_all)
      for (Index r = 0; r < f.residual.rows(); ++r) f.residual.row(r) *= weights_[r];
  }

  void add(const Frequency& frequency, const AtFrequency& f, const MatrixXd& noise) {
    const double of_ground = frequency.step_hz * frequency.ground;
    const Complex s(0, 2 * M_PI * frequency.hz);
    const Index measured = building_.measured, inputs = building_.inputs;
    // The building's relative motion under the motion of the base.
    const MatrixXcd moved = -ComplexLu(MatrixXcd(f.residual.rightCols(measured - inputs)))
                                 .solve(MatrixXcd(f.residual.leftCols(inputs)));
    MatrixXcd motion(measured, inputs);
    motion << MatrixXcd::Identity(inputs, inputs), moved;
    const Index p = table_.size(), dofs = springs_.cols();
    const MatrixXcd by_springs = rows(f, f.motion.transpose() * springs_);
    const MatrixXcd by_masses = rows(f, f.motion.transpose() * masses_);
    // Base directions are independent and each has this density. Rocking is not included.
    for (Index input = 0; input < inputs - building_.rotations; ++input) {
      const Eigen::VectorXcd all = f.motion * motion.col(input);
      const Eigen::VectorXcd stretched = springs_.transpose() * all;
      const Eigen::VectorXcd moving = masses_.transpose() * all;
      MatrixXcd h = MatrixXcd::Zero(building_.rows(), p);
      MatrixXcd other = MatrixXcd::Zero(building_.rows(), mismatch_.cols());
      for (Index dof = 0; dof < dofs; ++dof) {
        const Eigen::VectorXcd force = by_springs.col(dof) * stretched[dof];
        other.col(dof) = force;
        other.col(dofs + dof / config_.structure.frames()) +=
            s * s * moving[dof] * by_masses.col(dof);
        const int group = of_group_[static_cast<std::size_t>(dof)];
        if (group < 0) continue;
        h.col(group) += force;
        h.col(group + table_.elements()) += s * rate_[dof] * force;
      }
      for (Index i = 0; i < p; ++i)
        if (table_[static_cast<int>(i)].kind == ParameterKind::bending_stiffness)
          h.col(i) =
              rows(f, f.motion.transpose() * (building_.parts[static_cast<std::size_t>(i)] * all));
      information_ += of_ground * (h.adjoint() * h).real();
      mismatch_ += of_ground * (h.adjoint() * other).real();
      const Eigen::VectorXcd readings = read_ * motion.col(input);
      const MatrixXcd off = f.residual * building_.from_axes * readings.asDiagonal();
      misread_ +=
          of_ground * (MatrixXcd(p, 2 * off.cols()) << h.adjoint() * off, s * (h.adjoint() * off))
                          .finished()
                          .real();
      const MatrixXcd noisy = h.adjoint() * f.residual;
      scores_ += of_ground * config_.options.rate_hz / 2 * (noisy * noise * noisy.adjoint()).real();
    }
  }

  /// The frames of a group's stories and the share of each story in the group's flexibility.
  struct Shares {
    std::vector<Index> dof;
    std::vector<double> share;
  };
  Shares shares_of(const Parameter& group) const {
    const ParameterTable all(config_.structure);
    Shares out;
    double flexibility = 0;
    for (int story = group.story; story <= group.last_story; ++story) {
      double sum = 0;
      for (const int f : group.frames) sum += design_.theta[all.frame_stiffness(story, f)];
      flexibility += 1 / sum;
      for (const int f : group.frames) {
        out.dof.push_back(config_.structure.dof(story, f));
        out.share.push_back(design_.theta[all.frame_stiffness(story, f)] / (sum * sum));
      }
    }
    for (double& share : out.share) share /= flexibility;
    return out;
  }

  void add_changes(const MatrixXd& sensitivity, LayoutPrediction& out) const {
    const auto n = static_cast<std::size_t>(table_.elements());
    out.change_error.assign(n, 0);
    out.change_leak.assign(n * n, 0);
    for (std::size_t g = 0; g < n; ++g) {
      const Shares shares = shares_of(table_[static_cast<int>(g)]);
      const auto count = static_cast<double>(shares.dof.size());
      double squares = 0, own = 0;
      for (std::size_t i = 0; i < shares.dof.size(); ++i) {
        const double moved = sensitivity(static_cast<Index>(g), shares.dof[i]);
        squares += std::pow(moved / shares.share[i] - 1, 2) / count;
        own += std::abs(moved) / count;
      }
      // The linear effect does not hold for a large loss in a story.
      out.change_error[g] = std::hypot(kNotLinear, std::sqrt(squares));
      for (std::size_t q = 0; q < n; ++q)
        for (const Index d : shares.dof)
          if (q != g && own > 0)
            out.change_leak[g * n + q] = std::max(
                out.change_leak[g * n + q], std::abs(sensitivity(static_cast<Index>(q), d)) / own);
    }
  }

  /// The error of each story minus the part that the whole group has in common, which is the
  /// group's factor.
  void add_design_error(const MatrixXd& sensitivity, LayoutPrediction& out) const {
    const Structure& s = config_.structure;
    const Index p = table_.size();
    Eigen::VectorXd variance = Eigen::VectorXd::Zero(p);
    for (int g = 0; g < table_.elements(); ++g) {
      const Shares shares = shares_of(table_[g]);
      Eigen::VectorXd common = Eigen::VectorXd::Zero(p);
      for (const Index d : shares.dof) common += sensitivity.col(d);
      for (std::size_t i = 0; i < shares.dof.size(); ++i)
        variance += std::pow(tolerance_.profile, 2) *
                    (sensitivity.col(shares.dof[i]) - shares.share[i] * common).cwiseAbs2();
    }
    for (int story = 1; story <= s.stories; ++story)
      variance += std::pow(tolerance_.mass, 2) *
                  sensitivity.col(Index(s.degrees_of_freedom()) + story - 1).cwiseAbs2();
    for (Index i = 0; i < p; ++i)
      out.design_error[static_cast<std::size_t>(i)] = std::sqrt(variance[i]);
  }

  /// sensitivity: of the parameters to gains and times (s) of the axes. Errors that all axes have
  /// in common cancel.
  void add_sensor_error(const MatrixXd& sensitivity, LayoutPrediction& out) const {
    const Index axes = sensitivity.cols() / 2;
    const Eigen::VectorXd variance =
        std::pow(sensors_.gain, 2) * sensitivity.leftCols(axes).rowwise().squaredNorm() +
        std::pow(sensors_.time_s, 2) * sensitivity.rightCols(axes).rowwise().squaredNorm();
    for (Index i = 0; i < variance.size(); ++i)
      out.sensor_error[static_cast<std::size_t>(i)] = std::sqrt(variance[i]);
  }

  const PipelineConfig& config_;
  ParameterTable table_;
  DesignTolerance tolerance_;
  SensorTolerance sensors_;
  GroupDesign design_;
  ReducedBuilding building_;
  FloorRows rows_;
  MatrixXd projection_;
  MatrixXd springs_, masses_;  ///< coordinates x frame stories, floors' frames
  std::vector<int> of_group_;  ///< stiffness parameter of every frame story, or -1
  Eigen::VectorXd rate_;       ///< damping over stiffness of every frame story, s
  Eigen::VectorXd weights_;
  MatrixXd read_;  ///< axes x measured coordinates
  MatrixXd information_, scores_, mismatch_, misread_;
};

}  // namespace

LayoutPrediction predict_layout(const PipelineConfig& config,
                                const std::vector<double>& noise_density,
                                const ExpectedShaking& shaking, const DesignTolerance& tolerance,
                                const SensorTolerance& sensors) {
  return Prediction(config, noise_density, shaking, tolerance, sensors).result();
}

}  // namespace framewatch::estimator
