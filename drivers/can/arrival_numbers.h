#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "drivers/can/archive_list.h"

namespace framewatch::drivers {

/// Numbers the frames of a periodic stream that does not count, by when they arrive. No frame
/// arrives before it is due and no two have one number; so a frame that comes in the period after
/// the last one has no choice. After a pause it may be the one that was due, late, or a later one
/// while others were lost: such frames wait until the stream is on time again and then get the
/// latest numbers that leave one for each. Unit: periods.
class ArrivalNumbers {
 public:
  /// A frame that came `since` periods after the last settled one was due. `share` of a period
  /// that it may seem early by because its due time is not known better.
  void add(double since, double share);
  bool waiting() const { return !frames_.empty(); }
  /// Whether the frames waiting can be told apart now.
  bool settled() const { return settled_; }
  /// Number that the newest frame has if no frame follows soon; counted from the last settled one.
  std::int64_t newest() const { return frames_.back().latest; }
  /// Something else than arrival tells the newest frame's number. False: it cannot be that one.
  bool confirm(std::int64_t number);
  /// Numbers of the frames waiting, counted from the last settled one; nothing waits afterwards.
  /// Equal numbers are frames that came twice.
  std::vector<std::int64_t> settle();

  template <typename Archive>
  void archive(Archive& a) {
    archive_list(a, frames_);
    a(different_, on_time_, settled_);
  }

 private:
  struct Frame {
    std::int64_t latest = 0;  ///< number it can have
    bool again = false;       ///< the frame before it, come twice

    template <typename Archive>
    void archive(Archive& a) {
      a(latest, again);
    }
  };

  std::vector<Frame> frames_;
  std::int64_t different_ = 0;  ///< frames that are not there twice
  int on_time_ = 0;             ///< frames in a row, each alone in its period
  bool settled_ = false;
};

/// Numbers of the first frames of a stream, from 0: those of the period's grid that makes the
/// frames least late together.
std::vector<std::int64_t> first_numbers(const std::vector<double>& arrivals);

}  // namespace framewatch::drivers
