#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/can/archive_containers.h"

namespace framewatch::drivers {

/// Numbers the frames of a periodic stream without a counter by their arrival. No frame arrives
/// before it is due and no two have the same number; so a frame that comes in the period after the
/// last one is numbered at once. After a pause a frame may be the one that was due, late, or a
/// later one after losses: such frames wait until the stream is on time again and then get the
/// latest numbers that leave one for each. Unit: periods.
class ArrivalNumbering {
 public:
  /// A frame that came `since` periods after the last numbered one was due. It may seem early by
  /// `tolerance` periods, as far as its due time is uncertain.
  void add(double since, double tolerance);
  bool waiting() const { return !frames_.empty(); }
  /// Whether only one numbering of the frames waiting is possible.
  bool unambiguous() const { return unambiguous_; }
  /// Number that the newest frame has if no frame follows soon; counted from the last numbered one.
  std::int64_t newest() const { return frames_.back().latest; }
  /// The newest frame's number, from another source. False when it cannot be that one.
  bool confirm(std::int64_t number);
  /// Numbers of the frames waiting, counted from the last numbered one; nothing waits afterwards.
  /// Equal numbers are frames that came twice.
  std::vector<std::int64_t> assign_numbers();

  template <typename Archive>
  void archive(Archive& a) {
    archive_vector(a, frames_);
    a(different_, on_time_, unambiguous_);
  }

 private:
  struct Frame {
    std::int64_t latest = 0;  ///< number that it can have
    bool repeated = false;    ///< the frame before it, received twice

    template <typename Archive>
    void archive(Archive& a) {
      a(latest, repeated);
    }
  };

  std::vector<Frame> frames_;
  std::int64_t different_ = 0;  ///< frames without the repeated ones
  int on_time_ = 0;             ///< frames in a row, each alone in its period
  bool unambiguous_ = false;
};

/// Numbers of the first frames of a stream, from 0, for arrivals in periods: those of the grid of
/// due times that makes the sum of the frames' lateness smallest.
std::vector<std::int64_t> first_numbers(const std::vector<double>& arrivals);

}  // namespace framewatch::drivers
