#include "estimator/diagnose/propose/axis_proposals.h"

#include <algorithm>
#include <cmath>

#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::MatrixXd;
using Eigen::VectorXcd;
using Eigen::VectorXd;
int flat_samples(const RecordSegment& s, Index axis, double& level) {
  const VectorXd a = s.accel.col(axis);
  const double top = a.maxCoeff(), bottom = a.minCoeff();
  const double width = 1e-3 * (top - bottom);
  level = 0.5 * (top - bottom);
  int high = 0, low = 0;
  for (Index i = 0; i < a.size(); ++i) {
    high += a[i] > top - width;
    low += a[i] < bottom + width;
  }
  return std::max(high, low);
}

}  // namespace

void add_axis_proposals(const Fitter& fitter, const Localisation& place,
                        std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const int axis = place.candidate_places.front().axis;
  const EffectPlace here = place.candidate_places.front().place;
  // Estimates the reading that the axis should have from all other axes.
  double own = 0, cross = 0, late = 0, late_weight = 0;
  std::vector<MatrixXcd> truth(place.motion.size());
  for (std::size_t r = 0; r < place.motion.size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    Model neutral = place.model;
    const Whitened system =
        whiten(plant, neutral, s, r, Forcing::measured, place.motion[r], fitter.ratio(r));
    truth[r] = system.calibrated.row(axis);
    const Index n = plant.equations();
    for (Index b = 0; b < s.bins(); ++b) {
      const auto at = static_cast<std::size_t>(b);
      VectorXcd u = system.weights->whitener(b).times(system.operation[at].col(axis));
      const VectorXcd rest = rows_of_bin(system.rest, b, n);
      if (place.candidate_places.size() > 1) {
        const MatrixXcd basis = candidate_basis(
            system, b, {place.candidate_places.begin() + 1, place.candidate_places.end()});
        u -= (basis * (basis.adjoint() * u)).eval();
      }
      const double weight = std::max(u.squaredNorm(), 1e-300);
      const Complex read = truth[r](0, b);
      const Complex should = read - u.dot(rest) / weight;
      truth[r](0, b) = should;
      own += weight * std::norm(should);
      cross += weight * (std::conj(should) * read).real();
      const Complex turn = std::conj(should) * read;
      late += -weight * turn.imag() * s.w[b];
      late_weight += weight * turn.real() * s.w[b] * s.w[b];
    }
  }
  const double gain = own > 0 ? cross / own - 1 : 0;
  {
    Proposal p{place.model, gain < -1.5 ? EffectKind::polarity : EffectKind::gain_error, here, 0};
    p.model.free_gain.push_back(axis);
    p.model.gain[axis] += gain;
    out.push_back(p);
  }
  {
    Proposal p{place.model, EffectKind::time_shift, here, 0};
    p.model.free_clock.push_back(axis);
    if (late_weight > 0) p.model.clock_s[axis] += late / late_weight;
    out.push_back(p);
  }
  const SensorAxis& a = plant.axes[static_cast<std::size_t>(axis)];
  for (std::size_t other = 0; other < plant.axes.size(); ++other) {
    const SensorAxis& b = plant.axes[other];
    if (b.story != a.story || b.direction == a.direction) continue;
    if (!a.horizontal() || !b.horizontal()) continue;
    ModelEffect e;
    e.form = LawForm::misaligned;
    e.place = here;
    e.place.kind = PlaceKind::channel_pair;
    e.place.with_channel = static_cast<int>(other);
    e.parameters = {bounded_parameter(0.0, 1e-3, -1.5, 1.5)};
    Proposal p{place.model, EffectKind::misalignment, e.place, 0};
    p.model.effects.push_back(e);
    out.push_back(p);
  }
  for (std::size_t r = 0; r < fitter.segments().size(); ++r) {
    double level = 0;
    if (flat_samples(fitter.segments()[r], axis, level) < 8) continue;
    ModelEffect e;
    e.form = LawForm::clipped;
    e.place = here;
    Proposal p{place.model, EffectKind::clipping, here, 0};
    p.model.effects.push_back(e);
    out.push_back(p);
    break;
  }
}

}  // namespace framewatch::estimator
