#include <algorithm>

#include "estimator/diagnose/propose_parts.h"
#include "estimator/structure/complex.h"

namespace framewatch {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;

std::vector<Needed> needed_of(const Fitter& fitter, const Localisation& place) {
  const Plant& plant = fitter.plant();
  const Suspect& suspect = place.suspects.front();
  const std::vector<Suspect> others(place.suspects.begin() + 1, place.suspects.end());
  const bool axis = suspect.kind == Suspect::Kind::axis;
  const Index n = plant.equations();
  std::vector<Needed> out;
  for (std::size_t r = 0; r < fitter.stretches().size(); ++r) {
    const Stretch& s = fitter.stretches()[r];
    const Whitened system =
        whiten(plant, place.model, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    Needed one;
    one.force.resize(s.bins());
    one.weight.resize(s.bins());
    VectorXcd rest(n);
    for (Index b = 0; b < s.bins(); ++b) {
      const auto at = static_cast<std::size_t>(b);
      VectorXcd u =
          system.weights->whitener(b) * (axis ? VectorXcd(system.operation[at].col(suspect.axis))
                                              : suspect.directions.col(0).cast<Complex>());
      if (!others.empty()) {  // what the other places do is not counted
        const MatrixXcd basis = suspect_basis(system, b, others);
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      rest.real() = system.residual.segment(2 * n * b, n);
      rest.imag() = system.residual.segment(2 * n * b + n, n);
      one.weight[b] = std::max(u.squaredNorm(), 1e-300);
      one.force[b] = -u.dot(rest) / one.weight[b];
    }
    if (suspect.kind == Suspect::Kind::element) {
      const VectorXcd q = (plant.building.sense.row(suspect.element) * place.motion[r]).transpose();
      one.d = -q.array() / s.w.array().square();
      one.d_t = signal_of(one.d, s, fitter.ratio(r));
      one.v_t = signal_of(one.d.array() * s.w.array() * Complex(0, 1), s, fitter.ratio(r));
    }
    out.push_back(std::move(one));
  }
  return out;
}

}  // namespace framewatch
