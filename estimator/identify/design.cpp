#include "estimator/identify/design.h"

#include <algorithm>
#include <cmath>

namespace framewatch {
namespace {

constexpr double kPeriodPerStory = 0.1;  // s
constexpr double kGuessedDamping = 0.02;
constexpr double kLargestStep = 5;     // retuning: most a parameter may move at once
constexpr double kTrustedError = 0.1;  // retuning: relative standard error trusted by half

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

Eigen::VectorXd retuned_design(const FloorLayout& layout, const ParameterTable& table,
                               const Eigen::VectorXd& design, const std::vector<double>& ratio,
                               const std::vector<double>& std_error,
                               const std::vector<bool>& shown) {
  constexpr int kKinds = 4;
  std::vector<double> seen[kKinds];
  Eigen::VectorXd factor = Eigen::VectorXd::Zero(table.size());
  for (int u = 0; u < layout.unknowns(); ++u) {
    const auto i = static_cast<std::size_t>(u);
    if (!shown[i] || !(ratio[i] > 0)) continue;
    const double doubt = std_error[i] / ratio[i] / kTrustedError;
    const double moved = std::exp(std::log(ratio[i]) / (1 + doubt * doubt));
    const int parameter = layout.parameter(u / layout.own(), u % layout.own());
    factor[parameter] = std::clamp(moved, 1 / kLargestStep, kLargestStep);
    seen[static_cast<int>(table[parameter].kind)].push_back(factor[parameter]);
  }
  const auto median = [&](ParameterKind kind, double otherwise) {
    std::vector<double>& values = seen[static_cast<int>(kind)];
    if (values.empty()) return otherwise;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
  };
  const double frame_stiffness = median(ParameterKind::frame_stiffness, 1);
  const double frame_damping = median(ParameterKind::frame_damping, 1);
  const double unseen[kKinds] = {
      frame_stiffness, median(ParameterKind::panel_stiffness, frame_stiffness), frame_damping,
      median(ParameterKind::panel_damping, frame_damping)};
  Eigen::VectorXd out = design;
  for (int p = 0; p < table.size(); ++p)
    out[p] *= factor[p] > 0 ? factor[p] : unseen[static_cast<int>(table[p].kind)];
  return out;
}

}  // namespace framewatch
