// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/law_tracks.h"

#include <cmath>
#include <utility>

#include "estimator/diagnose/fit/measured_deformation.h"
#include "estimator/diagnose/model/law_port.h"
#include "estimator/numeric/complex.h"

namespace framewatch::estimator {

using Eigen::Index;
using Eigen::MatrixXcd;
using Eigen::VectorXcd;
using Eigen::VectorXd;

Forcing forcing_of(const Model& model) {
  return has_element_law(model) ? Forcing::simulated : Forcing::measured;
}

Equivalent equivalent_of(const LawTrack& track) {
  const double dd = track.d.squaredNorm(), vv = track.v.squaredNorm(), dv = track.d.dot(track.v);
  const double fd = track.force.dot(track.d), fv = track.force.dot(track.v);
  const double det = dd * vv - dv * dv;
  if (!(det > 1e-9 * dd * vv)) return {};
  return {(fd * vv - fv * dv) / det, (fv * dd - fd * dv) / det};
}

VectorXcd beyond(const Equivalent& linear, const VectorXcd& force, const VectorXcd& d,
                 const VectorXd& w) {
  return force.array() - d.array() * (linear.stiffness + kJ * linear.damping * w.array());
}

VectorXcd harmonic_bins(const ModelEffect& effect, const RecordSegment& segment,
                        std::size_t record) {
  const double hz = effect.parameters[0].plain();
  const std::vector<LawParameter>& r = effect.record_parameters[record];
  VectorXd signal(segment.intervals());
  for (Index i = 0; i < signal.size(); ++i) {
    const double t = static_cast<double>(i) / segment.rate_hz, phase = 2 * M_PI * hz * t;
    signal[i] = t < effect.onset_s[record]
                    ? 0
                    : r[0].value * std::cos(phase) + r[1].value * std::sin(phase);
  }
  return band_of(signal, segment, 1);
}

std::optional<std::vector<LawTrack>> tracks_of(const Plant& plant, const Model& model,
                                               const RecordSegment& segment, std::size_t record,
                                               Forcing forcing, const MatrixXcd& motion, int ratio,
                                               RunCache* cache) {
  const bool any = has_element_law(model);
  if (forcing == Forcing::simulated && any && !plant.prescribed) {
    FreeRun run = free_run(plant, model, segment, record, ratio, cache);
    if (!run.good) return std::nullopt;
    return std::move(run.tracks);
  }
  std::vector<LawTrack> out;
  if (!any) return out;
  const MatrixXcd driving = motion.size() > 0 ? motion : calibrated(model, segment);
  for (const ActiveLaw& active : active_laws(plant, model)) {
    MeasuredDeformation m = measured_deformation(plant, segment, active.port.sense, driving, ratio);
    LawTrack& track = out.emplace_back(LawTrack{std::move(m.d), std::move(m.v), {}});
    track.force =
        law_force(law_at(model, active, record), track.d, track.v, 1 / (segment.rate_hz * ratio));
  }
  return out;
}

}  // namespace framewatch::estimator
