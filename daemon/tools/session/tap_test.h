#pragma once

#include <optional>
#include <vector>

namespace framewatch::daemon {

/// Tells which sensor was tapped, and whether it first moved in its positive direction: a person
/// taps every sensor's place in the building's positive direction, one after the other, in any
/// order.
///
/// A tap begins when an axis is further from rest than its threshold and than 2.5 times what the
/// building's ringing still does. The axis with the largest distance in the next quarter of a
/// second was tapped; its sign is that of the first sample beyond half of that distance: the blow
/// itself, which is several times what the structure answers with.
class TapTest {
 public:
  struct Tap {
    int axis;     ///< -1: another axis moved nearly as much, so which one is not clear
    int sign;     ///< 1 positive, -1 negative
    double peak;  ///< m/s^2
  };

  TapTest(std::size_t axes, double rate_hz);

  /// Distances from rest of one instant and thresholds, m/s^2, by axis; NaN: no sample.
  std::optional<Tap> push(const std::vector<double>& distance,
                          const std::vector<double>& threshold);

 private:
  Tap judge() const;

  long pulse_, rest_;  ///< samples
  double forget_;      ///< of the ringing, per sample
  long since_ = -1;    ///< samples since the tap began; -1: none
  std::vector<std::vector<double>> pulse_rows_;
  std::vector<double> ringing_;  ///< m/s^2
};

}  // namespace framewatch::daemon
