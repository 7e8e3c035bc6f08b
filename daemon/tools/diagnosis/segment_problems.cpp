#include "daemon/tools/diagnosis/segment_problems.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>
#include <fmt/ranges.h>

namespace framewatch::daemon {
namespace {

using estimator::ClockOffset;

constexpr std::size_t kMaxNames = 4;

std::string names_of(const estimator::Plant& plant, const std::vector<ClockOffset>& offsets) {
  std::vector<std::string> names;
  for (const ClockOffset& o : offsets)
    names.push_back(plant.axes[static_cast<std::size_t>(o.axis)].name);
  const std::size_t count = names.size();
  if (count > kMaxNames) names.resize(kMaxNames);
  const std::string more =
      count > kMaxNames ? fmt::format(" and {} more", count - kMaxNames) : std::string();
  return fmt::format("{}{}", fmt::join(names, ", "), more);
}

/// Seconds in which a segment's band has the fewest frequencies.
double least_seconds(const estimator::RecordSegment& s) {
  return s.seconds() * static_cast<double>(estimator::kFewestBins) /
         static_cast<double>(std::max<Eigen::Index>(1, s.bins()));
}

void add_clock_problems(const std::string& path, const estimator::Plant& plant,
                        const estimator::RecordSegment& segment,
                        std::vector<std::string>& problems) {
  constexpr double kTogether = 0.1;  ///< s, of channels that one sentence names
  std::map<std::pair<Eigen::Index, long>, std::vector<ClockOffset>> groups;
  for (const ClockOffset& o : clocks_apart(plant, segment))
    groups[{o.base, std::lround(o.seconds / kTogether)}].push_back(o);
  for (const auto& [key, offsets] : groups) {
    double mean = 0;
    for (const ClockOffset& o : offsets) mean += o.seconds / static_cast<double>(offsets.size());
    problems.push_back(
        fmt::format("{}: clocks apart: {} read {:.2f} s {} than {} in motion so slow that a "
                    "building goes with its base; measure again with one clock, or give the later "
                    "ones that delay_s",
                    path, names_of(plant, offsets), std::abs(mean), mean > 0 ? "later" : "earlier",
                    plant.axes[static_cast<std::size_t>(key.first)].name));
  }
}

}  // namespace

void add_segment_problems(const std::string& path, const estimator::DiagnosisInput& input,
                          std::size_t record, const estimator::ComponentTest& component,
                          std::vector<std::string>& problems) {
  const estimator::RecordSegment& s = input.segments[record];
  const estimator::SegmentFault fault = fault_of(input.plant, s, component);
  if (fault == estimator::SegmentFault::too_short)
    problems.push_back(
        fmt::format("{}: too short: {} frequencies lie in the building's band, at least {} are "
                    "needed; measure {:.0f} s or more",
                    path, s.bins(), estimator::kFewestBins, std::ceil(least_seconds(s))));
  else if (fault == estimator::SegmentFault::no_excitation)
    problems.push_back(path +
                       ": no excitation: the floors' motion does not stand out of the sensors' "
                       "noise; measure stronger motion, or with quieter sensors");
  else if (!component.any())
    add_clock_problems(path, input.plant, s, problems);
}

}  // namespace framewatch::daemon
