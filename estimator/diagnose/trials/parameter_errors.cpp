#include "estimator/diagnose/trials/parameter_errors.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/normal_equations.h"
#include "estimator/diagnose/trials/catalogue_form.h"
#include "estimator/numeric/solve.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

void set_errors(const Fitter& fitter, const Model& model,
                const std::vector<Eigen::MatrixXcd>& motion, std::vector<FoundEffect>& effects) {
  if (effects.empty()) return;
  std::vector<Whitened> systems = fitter.systems(model, motion, forcing_of(model));
  if (systems.empty()) return;
  const Linearised at = fitter.linearise(model, std::move(systems), thorough(model, 0));
  MatrixXd normal = normal_equations(at, fitter.within()).normal;
  normal.diagonal() += at.prior;
  const VectorXd scale = normal.diagonal().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * normal * scale.asDiagonal();
  scaled.diagonal().array() += 1e-10;
  const Ldlt factor(scaled);
  for (FoundEffect& found : effects) {
    if (found.ramp_mps3.size() > 0) continue;
    const VectorXd value = catalogue_values(fitter.plant(), fitter.segments(), found, model);
    MatrixXd jacobian = MatrixXd::Zero(value.size(), normal.cols());
    for (std::size_t u = 0; u < at.unknowns.size(); ++u) {
      const Unknown& unknown = at.unknowns[u];
      const bool parameter = unknown.kind == Unknown::Kind::parameter ||
                             unknown.kind == Unknown::Kind::record_parameter;
      const bool axis = unknown.kind == Unknown::Kind::gain || unknown.kind == Unknown::Kind::clock;
      if (!(parameter && unknown.index == found.index) &&
          !(axis && found.index < 0 && unknown.index == found.chosen.place.channel))
        continue;
      constexpr double kPart = 0.05;  // of the unknown's unit, for the derivative
      Model moved = model;
      set_value(moved, unknown, value_of(model, unknown) + kPart);
      jacobian.col(static_cast<Index>(u)) =
          (catalogue_values(fitter.plant(), fitter.segments(), found, moved) - value) / kPart;
    }
    // Errors grow in proportion to the misfit over noise.
    const MatrixXd turned = scale.asDiagonal() * jacobian.transpose();
    const VectorXd variance =
        0.5 * at.level * (jacobian * (scale.asDiagonal() * factor.solve(turned))).diagonal();
    found.std_error.clear();
    for (const double v : variance) found.std_error.push_back(std::sqrt(std::max(v, 0.0)));
  }
}

}  // namespace framewatch::estimator
