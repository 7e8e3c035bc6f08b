#include "daemon/tools/diagnosis/noise_beyond.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr double kBeyond = 2;

double quietest(const std::vector<estimator::RecordSegment>& segments, Eigen::Index axis) {
  double least = std::numeric_limits<double>::infinity();
  for (const estimator::RecordSegment& s : segments)
    least = std::min(
        least,
        std::sqrt(estimator::quiet_noise_variance(s.accel.col(axis), s.rate_hz) / (s.rate_hz / 2)));
  return least;
}

}  // namespace

std::vector<NoiseBeyond> noise_beyond_configured(
    const estimator::Plant& plant, const std::vector<estimator::RecordSegment>& segments) {
  std::vector<NoiseBeyond> out;
  for (std::size_t a = 0; a < plant.axes.size(); ++a) {
    const auto axis = static_cast<Eigen::Index>(a);
    const double configured = plant.axes[a].noise_density;
    if (configured <= 0 || plant.is_force(axis) || segments.front().is_displaced(axis)) continue;
    const double read = quietest(segments, axis);
    if (read > kBeyond * configured) out.push_back({a, configured, read});
  }
  return out;
}

std::string noise_sentence(const DiagnoseOutput& o) {
  if (o.diagnosis.verdict == estimator::Verdict::adequate) return "";
  const std::vector<NoiseBeyond> beyond = noise_beyond_configured(o.plant, o.segments);
  if (beyond.empty()) return "";
  const auto ratio = [](const NoiseBeyond& n) { return n.read / n.configured; };
  const NoiseBeyond& worst = *std::max_element(
      beyond.begin(), beyond.end(),
      [&](const NoiseBeyond& a, const NoiseBeyond& b) { return ratio(a) < ratio(b); });
  return fmt::format(
      "{} reads {:.3g} times the noise that is configured ({:.2g} of {:.2g} m/s^2/sqrt(Hz), in the "
      "quietest seconds from 20 to 46 % of the sampling rate){}. Where that is noise, so may be "
      "what is left: record the building at rest, or leave noise_mps2_per_rthz out.",
      o.plant.axes[worst.axis].name, ratio(worst), worst.read, worst.configured,
      beyond.size() > 1
          ? fmt::format(", and {} more channels twice as much or more", beyond.size() - 1)
          : std::string());
}

}  // namespace framewatch::daemon
