#include "estimator/diagnose/verdict/ramps.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/fit/gap.h"
#include "estimator/diagnose/model/bias.h"
#include "estimator/diagnose/verdict/verdict.h"

namespace framewatch::estimator {

using Eigen::Index;

std::vector<FoundEffect> remove_ramps(const Plant& plant, const DiagnosisOptions& options,
                                      std::vector<RecordSegment>& segments) {
  for (const Effect& e : options.known)
    if (e.kind == EffectKind::bias_drift)
      for (RecordSegment& s : segments)
        s = without_ramp(s, e.place.channel, {e.value("ramp_mps3"), e.value("from_s"), 0});
  std::vector<FoundEffect> out;
  if (std::find(options.without.begin(), options.without.end(), EffectKind::bias_drift) !=
      options.without.end())
    return out;
  const std::vector<RecordSegment> whole = segments;
  for (Index a = 0; a < plant.axis_count(); ++a) {
    FoundEffect found;
    found.chosen.kind = EffectKind::bias_drift;
    found.chosen.place.kind = PlaceKind::channel;
    found.chosen.place.channel = static_cast<int>(a);
    found.chosen.fraction = 1;
    found.confidence = 0.99;
    bool any = false;
    for (std::size_t r = 0; r < segments.size(); ++r) {
      const auto ramp = find_ramp(plant, whole[r], a);
      found.ramp_mps3.push_back(ramp ? ramp->slope : 0);
      found.ramp_from_s.push_back(ramp ? ramp->from_s : 0);
      found.drift_rms_mps2.push_back(ramp ? ramp->rms : 0);
      if (!ramp) continue;
      any = true;
      segments[r] = without_ramp(segments[r], a, *ramp);
    }
    if (any) out.push_back(std::move(found));
  }
  return out;
}

namespace {

/// outputs: number of axes in Gap::overall.
void add_ramp(const RecordSegment& s, Index axis, double slope, double from_s, double rms,
              Index outputs, Gap& gap) {
  const double length = std::max(s.seconds() - from_s, 0.0), share = length / s.seconds();
  // Mean square of slope max(t - from, 0) about its mean, unless the drift is another curve.
  const double square =
      std::max(std::pow(slope * length, 2) * share * (1.0 / 3 - share / 4), rms * rms);
  const double intervals = static_cast<double>(s.intervals());
  const double power = 2 * s.spectrum.row(axis).squaredNorm() / (intervals * intervals);
  const double all = static_cast<double>(outputs) * gap.measured_rms * gap.measured_rms;
  gap.axis[axis] = std::hypot(gap.axis[axis], std::sqrt(square / std::max(power, 1e-300)));
  if (gap.axis[axis] > gap.worst) {
    gap.worst = gap.axis[axis];
    gap.worst_axis = static_cast<int>(axis);
  }
  gap.overall = std::hypot(gap.overall, std::sqrt(square / std::max(all, 1e-300)));
}

}  // namespace

void add_ramps_to_gaps(const Plant& plant, const std::vector<RecordSegment>& segments,
                       std::size_t holdout_from, Diagnosis& d) {
  Index outputs = 0;
  for (Index a = 0; a < plant.axis_count(); ++a) outputs += is_output(plant, a);
  // Starts with the last one: its gap is the one before the search.
  for (auto found = d.effects.rbegin(); found != d.effects.rend(); ++found) {
    if (found->ramp_mps3.empty()) continue;
    found->after = mean_gap(d.before, holdout_from);
    for (std::size_t r = 0; r < d.before.size(); ++r)
      add_ramp(segments[r], found->chosen.place.channel, found->ramp_mps3[r], found->ramp_from_s[r],
               r < found->drift_rms_mps2.size() ? found->drift_rms_mps2[r] : 0, outputs,
               d.before[r]);
    found->before = mean_gap(d.before, holdout_from);
  }
}

}  // namespace framewatch::estimator
