#include "estimator/diagnose/propose/node_proposals.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "estimator/diagnose/propose/harmonic_proposal.h"
#include "estimator/diagnose/propose/law_kind.h"
#include "estimator/diagnose/propose/scalar_fit.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {
namespace {

using Eigen::Index;
using Eigen::VectorXcd;
using Eigen::VectorXd;
constexpr double kFollows = 0.3;  ///< share of a force beyond noise that laws must explain
constexpr double kSlow = 0.3;     ///< of the rms rate: width of the friction term

constexpr double kStationary = 0.25;  ///< share at rest above which a force may be external
constexpr double kAsMuch = 0.5;       ///< share at rest above which laws must explain kMostly
constexpr double kMostly = 0.6;       ///< replaces kFollows then
constexpr double kStandsOut = 3;      ///< power of a force over its noise
constexpr double kEnds_s = 2;         ///< of a segment, which end effects disturb
constexpr double kQuietest = 0.15;    ///< share of the seconds that count as rest

/// Adds a hidden mass on a spring: force m a T(w).
void add_resonator(const Fitter& fitter, const Localisation& place,
                   const std::vector<NeededSignal>& needed, const EffectPlace& node,
                   std::vector<Proposal>& out) {
  const Plant& plant = fitter.plant();
  const VectorXd at = node_direction(plant, node.story, node.frame);
  const Eigen::RowVectorXd motion = at.transpose() * plant.motion;
  std::vector<VectorXcd> accel;
  for (std::size_t r = 0; r < needed.size(); ++r)
    accel.push_back((motion * place.motion[r]).transpose());
  ScalarFit least;
  double chosen_hz = 0, chosen_h = 0;
  const Band band = fit_band(fitter);
  const bool has_element = needed.front().d.size() > 0;
  for (double hz = band.low_hz; hz < 0.9 * band.high_hz; hz *= 1.03)
    for (const double h : {0.01, 0.03, 0.1, 0.3}) {
      std::vector<std::vector<VectorXcd>> columns(needed.size());
      for (std::size_t r = 0; r < needed.size(); ++r) {
        const VectorXd& w = fitter.segments()[r].w;
        const double wr = 2 * M_PI * hz;
        const auto spring = (wr * wr + 2 * h * wr * w.array() * kJ).eval();
        if (has_element) columns[r] = linear_columns(needed[r], w);
        columns[r].push_back((accel[r].array() * spring / (spring - w.array().square())).matrix());
      }
      const ScalarFit fit = scalar_fit(needed, columns);
      if (fit.misfit < least.misfit && fit.coefficients.tail(1)[0] > 0) {
        least = fit;
        chosen_hz = hz;
        chosen_h = h;
      }
    }
  if (least.misfit < 1e299) {
    ModelEffect e;
    e.form = LawForm::resonator;
    e.place = node;
    const double mass = least.coefficients.tail(1)[0];
    e.parameters = {bounded_parameter(mass, 0.02 * mass, 1e-6 * mass, 1e15),
                    logarithmic_parameter(chosen_hz, 0.3 * band.low_hz, 3 * band.high_hz),
                    logarithmic_parameter(chosen_h, 1e-3, 2)};
    Proposal p{place.model, EffectKind::tuned_mass_damper, node, least.misfit};
    p.model.effects.push_back(e);
    out.push_back(p);
  }
}

/// Power of `force` in every second, and that of the ground's motion.
struct Seconds {
  std::vector<double> force, ground;
};

Seconds seconds_of(const Plant& plant, const RecordSegment& s, const VectorXcd& force) {
  Seconds out;
  const VectorXd f = signal_of(force, s, 1);
  const auto length = std::max<Index>(1, static_cast<Index>(std::lround(s.rate_hz)));
  const Index ends =
      std::min<Index>(static_cast<Index>(std::lround(kEnds_s * s.rate_hz)), f.size() / 10);
  for (Index at = ends; at + length <= f.size() - ends; at += length) {
    out.force.push_back(f.segment(at, length).squaredNorm() / static_cast<double>(length));
    double ground = 0;
    for (Index a = 0; a < plant.axis_count(); ++a)
      if (plant.axes[static_cast<std::size_t>(a)].story == 0)
        ground += s.accel.col(a).segment(at, length).squaredNorm();
    out.ground.push_back(ground);
  }
  return out;
}

/// Returns the power of a force while the ground is at rest, over its mean power. A law of the
/// building has no such power. Returns 0 if the force does not exceed its noise.
double share_at_rest(const Plant& plant, const RecordSegment& s, const NeededSignal& needed) {
  const Seconds seconds = seconds_of(plant, s, beyond_linear(s, needed));
  const std::size_t count = seconds.force.size();
  if (count < 8) return 0;
  std::vector<std::size_t> order(count);
  for (std::size_t i = 0; i < count; ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return seconds.ground[a] < seconds.ground[b];
  });
  const double intervals = static_cast<double>(s.intervals());
  const double noise = 2 * needed.weight.cwiseInverse().sum() / (intervals * intervals);
  const auto quiet =
      std::max<std::size_t>(2, static_cast<std::size_t>(kQuietest * static_cast<double>(count)));
  double rest = 0, all = 0;
  for (std::size_t i = 0; i < count; ++i) {
    all += seconds.force[order[i]] / static_cast<double>(count);
    if (i < quiet) rest += seconds.force[order[i]] / static_cast<double>(quiet);
  }
  return all > kStandsOut * noise ? (rest - noise) / (all - noise) : 0;
}

/// Returns true if nonlinear laws of the element's deformation explain more than `share` of a force
/// beyond its linear part. The force is then a law of the element.
bool follows_motion(const RecordSegment& s, const NeededSignal& needed, int ratio, double share) {
  if (needed.d_t.size() == 0) return false;
  std::vector<VectorXcd> columns = linear_columns(needed, s.w);
  const double linear = scalar_fit({needed}, {columns}).misfit;
  const auto d = needed.d_t.array(), v = needed.v_t.array();
  const double slow = kSlow * std::sqrt(v.square().mean());
  for (const VectorXd& law :
       {VectorXd(d.cube()), VectorXd(d * d.abs()), VectorXd(v * v.abs()),
        VectorXd((v / std::max(slow, 1e-300)).tanh()), VectorXd(d.square() * v)})
    columns.push_back(band_of(law, s, ratio));
  const double curved = scalar_fit({needed}, {columns}).misfit;
  const auto noise = static_cast<double>(s.bins());
  return linear - curved > share * std::max(linear - noise, 0.0) + noise;
}

}  // namespace

void add_node_proposals(const Fitter& fitter, const Localisation& place,
                        const std::vector<NeededSignal>& needed, const EffectPlace& node,
                        std::vector<Proposal>& out) {
  add_resonator(fitter, place, needed, node, out);
  out.push_back(harmonic_proposal(fitter, place, needed, node));
  for (std::size_t r = 0; r < needed.size(); ++r) {
    const RecordSegment& s = fitter.segments()[r];
    const double at_rest = share_at_rest(fitter.plant(), s, needed[r]);
    if (at_rest < kStationary) return;
    const double share = at_rest < kAsMuch ? kFollows : kMostly;
    if (follows_motion(s, needed[r], fitter.ratio(r), share)) return;
  }
  if (needed.front().d_t.size() > 0 && follows_motion(kind_of_law(fitter, needed).kind)) return;
  ModelEffect e;
  e.form = LawForm::broadband;
  e.place = node;
  Proposal p{place.model, EffectKind::unmeasured_force, node, 0};
  p.model.effects.push_back(e);
  out.push_back(p);
}

}  // namespace framewatch::estimator
