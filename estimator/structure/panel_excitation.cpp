#include "estimator/structure/panel_excitation.h"

#include <algorithm>
#include <cmath>
#include <complex>

#include "estimator/numeric/solve.h"
#include "estimator/structure/matrices.h"
#include "estimator/structure/natural_frequencies.h"

namespace framewatch::estimator {
namespace {

constexpr std::size_t kModes = 12;

}  // namespace

std::vector<double> panel_excitation(const Structure& s, const ParameterTable& table,
                                     const Eigen::VectorXd& theta) {
  const Matrices matrices = assemble(s, table, theta);
  const std::vector<Element> all = elements(s, table);
  const Eigen::MatrixXd force = matrices.mass.asDiagonal() * ground_influence(s);
  std::vector<double> share(static_cast<std::size_t>(s.stories * s.panels()), 0.0);
  const int first_panel = table.elements() - static_cast<int>(share.size());

  std::vector<double> frequencies = natural_frequencies_hz(s, table, theta);
  frequencies.resize(std::min(frequencies.size(), kModes));
  for (const double hz : frequencies) {
    const double w = 2 * M_PI * hz;
    Eigen::MatrixXcd dynamic = matrices.stiffness.cast<std::complex<double>>();
    dynamic += std::complex<double>(0, w) * matrices.damping;
    dynamic.diagonal() -= (w * w * matrices.mass).cast<std::complex<double>>();
    const Eigen::MatrixXcd motion =
        ComplexLu(dynamic).solve(Eigen::MatrixXcd(force.cast<std::complex<double>>()));
    Eigen::VectorXd deformation(table.elements());
    for (const Element& e : all) {
      Eigen::RowVectorXcd q = Eigen::RowVectorXcd::Zero(2);
      for (const auto& [dof, coefficient] : e.b) q += coefficient * motion.row(dof);
      deformation[e.stiffness] = q.cwiseAbs().sum();
    }
    const double largest_frame = deformation.head(first_panel).maxCoeff();
    for (std::size_t p = 0; p < share.size(); ++p)
      share[p] = std::max(share[p], deformation[first_panel + static_cast<int>(p)] / largest_frame);
  }
  return share;
}

}  // namespace framewatch::estimator
