#include "estimator/watch/mean_temperature.h"

#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

constexpr double kColdest_degc = -90, kHottest_degc = 150;  // beyond is a broken thermometer

}  // namespace

void MeanTemperature::push(Time time, double degc) {
  if (!(degc >= kColdest_degc && degc <= kHottest_degc)) return;
  const std::int64_t number = number_of(time);
  if (number < 0) return;
  Bin& bin = bins_[static_cast<std::size_t>(number % kBins)];
  if (bin.number != number) bin = {number, 0, 0};
  ++bin.count;
  bin.sum += degc;
}

double MeanTemperature::mean(Time start, Time end) const {
  const std::int64_t first = number_of(start), last = number_of(end);
  double sum = 0, before = std::numeric_limits<double>::quiet_NaN();
  int count = 0;
  std::int64_t newest = first - kHolds - 1;
  for (const Bin& bin : bins_) {
    if (bin.count == 0 || bin.number <= newest || bin.number > last) continue;
    const double mean = bin.sum / static_cast<double>(bin.count);
    if (bin.number < first) {
      newest = bin.number;
      before = mean;
    } else {
      sum += mean;
      ++count;
    }
  }
  return count > 0 ? sum / count : before;
}

}  // namespace framewatch::estimator
