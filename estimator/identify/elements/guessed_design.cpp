// SPDX-License-Identifier: MIT
#include "estimator/identify/elements/guessed_design.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "estimator/numeric/quantile.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {
namespace {

constexpr double kPeriodPerStory = 0.1;  // s
constexpr double kGuessedDamping = 0.02;
constexpr double kLargestStep = 5;  // retuning: largest factor by which a parameter moves at once
constexpr double kTrustedError = 0.1;  // retuning: relative standard error that is trusted by half

}  // namespace

Eigen::VectorXd guessed_design(const Structure& s, const ParameterTable& table) {
  const double w1 = 2 * M_PI / (kPeriodPerStory * s.stories);
  const double shape = M_PI / (2 * s.stories + 1);
  Eigen::VectorXd theta = Eigen::VectorXd::Zero(table.size());
  for (int story = 1; story <= s.stories; ++story) {
    double sum = 0;
    for (int f = 0; f < s.frames(); ++f) {
      const double k = s.frame_mass(story, f) * (w1 / shape) * (w1 / shape);
      theta[table.frame_stiffness(story, f)] = k;
      sum += k / s.frames();
    }
    for (int p = 0; p < s.panels(); ++p) theta[table.panel_stiffness(story, p)] = sum;
  }
  theta.tail(table.elements()) = 2 * kGuessedDamping / w1 * theta.head(table.elements());
  return theta;
}

double trusted_ratio(double ratio, double std_error) {
  const double doubt = std_error / kTrustedError;
  return std::exp(std::log(ratio) / (1 + doubt * doubt));
}

RetuningWork::RetuningWork(int parameters) : factor(static_cast<std::size_t>(parameters)) {
  seen.reserve(factor.size());
}

void retuned_design(const FloorLayout& layout, const ParameterTable& table,
                    const Eigen::VectorXd& design, const std::vector<double>& ratio,
                    const std::vector<double>& std_error, const std::vector<std::uint8_t>& shown,
                    RetuningWork& work, Eigen::VectorXd& out) {
  std::fill(work.factor.begin(), work.factor.end(), 0.0);
  for (int u = 0; u < layout.unknowns(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    if (shown[i] == 0 || !(ratio[i] > 0)) continue;
    const double moved = trusted_ratio(ratio[i], std_error[i] / ratio[i]);
    const int parameter = layout.parameter_of(u);
    work.factor[static_cast<std::size_t>(parameter)] =
        std::clamp(moved, 1 / kLargestStep, kLargestStep);
  }
  const auto median = [&](ParameterKind kind, double otherwise) {
    work.seen.clear();
    for (int p = 0; p < table.size(); ++p)
      if (table[p].kind == kind && work.factor[static_cast<std::size_t>(p)] > 0)
        work.seen.push_back(work.factor[static_cast<std::size_t>(p)]);
    return upper_median(work.seen, otherwise);
  };
  const double frame_stiffness = median(ParameterKind::frame_stiffness, 1);
  const double frame_damping = median(ParameterKind::frame_damping, 1);
  const double unseen[] = {frame_stiffness, median(ParameterKind::panel_stiffness, frame_stiffness),
                           frame_damping, median(ParameterKind::panel_damping, frame_damping),
                           median(ParameterKind::bending_stiffness, 1)};
  for (int p = 0; p < table.size(); ++p) {
    const double factor = work.factor[static_cast<std::size_t>(p)];
    out[p] = design[p] * (factor > 0 ? factor : unseen[static_cast<int>(table[p].kind)]);
  }
}

namespace {

/// Standard deviation over tolerance, for a design whose error is uniform within its tolerance.
constexpr double kUniform = 0.58;

}  // namespace

PerturbedDesigns::PerturbedDesigns(const FloorLayout& layout) : own_(layout.own()) {
  for (int u = 0; u < layout.unknowns(); ++u)
    for (int c = 0; c < kCount; ++c)
      error_.push_back(kUniform * design_tolerance(layout.kind(u % own_)) * fixed_sign(u, c));
}

}  // namespace framewatch::estimator
