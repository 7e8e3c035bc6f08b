#include "estimator/diagnose/verdict/ramps.h"

#include <algorithm>
#include <cmath>

#include "estimator/diagnose/model/bias.h"

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
      if (!ramp) continue;
      any = true;
      segments[r] = without_ramp(segments[r], a, *ramp);
    }
    if (any) out.push_back(std::move(found));
  }
  return out;
}

void add_ramps_to_gaps(const std::vector<RecordSegment>& segments, std::size_t holdout_from,
                       Diagnosis& d) {
  for (FoundEffect& found : d.effects) {
    if (found.ramp_mps3.empty()) continue;
    found.before = found.after = 0;
    std::size_t held = 0;
    for (std::size_t r = 0; r < d.before.size(); ++r) {
      const RecordSegment& s = segments[r];
      const Index axis = found.chosen.place.channel;
      const double length = std::max(s.seconds() - found.ramp_from_s[r], 0.0);
      const double share = length / s.seconds();
      // Of slope max(t - from, 0) about its mean.
      const double square =
          std::pow(found.ramp_mps3[r] * length, 2) * share * (1.0 / 3 - share / 4);
      const double intervals = static_cast<double>(s.intervals());
      const double power = 2 * s.spectrum.row(axis).squaredNorm() / (intervals * intervals);
      Gap& gap = d.before[r];
      gap.axis[axis] = std::hypot(gap.axis[axis], std::sqrt(square / std::max(power, 1e-300)));
      if (gap.axis[axis] > gap.worst) {
        gap.worst = gap.axis[axis];
        gap.worst_axis = static_cast<int>(axis);
      }
      const double all = 2 * s.spectrum.squaredNorm() / (intervals * intervals);
      gap.overall = std::hypot(gap.overall, std::sqrt(square / std::max(all, 1e-300)));
      if (r < holdout_from) continue;
      ++held;
      found.before += gap.overall;
      found.after += d.after[r].overall;
    }
    if (held > 0) {
      found.before /= static_cast<double>(held);
      found.after /= static_cast<double>(held);
    }
  }
}

}  // namespace framewatch::estimator
