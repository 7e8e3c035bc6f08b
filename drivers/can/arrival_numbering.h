// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "drivers/can/archive_containers.h"

namespace framewatch::drivers {

/// Numbers the frames of a periodic stream without a counter by their arrival. No frame arrives
/// before it is due and no two have the same number, so a frame that comes in the period after the
/// last one is numbered at once. After a pause a frame may be the one that was due, late, or a
/// later one after losses. Such frames wait until the stream is on time again and then get the
/// latest numbers that leave one for each. Unit: periods.
class ArrivalNumbering {
 public:
  /// Adds a frame that came `since` periods after the last numbered one was due. It may seem early
  /// by `tolerance` periods because its due time is uncertain.
  void add(double since, double tolerance);
  bool waiting() const { return !frames_.empty(); }
  /// Returns true if only one numbering of the waiting frames is possible.
  bool unambiguous() const { return unambiguous_; }
  /// Returns the number of the newest frame if no frame follows soon, counted from the last
  /// numbered one.
  std::int64_t newest() const { return frames_.back().latest; }
  /// Sets the number of the newest frame from another source. Returns false when it cannot be that
  /// one.
  bool confirm(std::int64_t number);
  /// Returns the numbers of the waiting frames, counted from the last numbered one, and forgets the
  /// frames. Equal numbers mark frames that came twice.
  std::vector<std::int64_t> assign_numbers();

  template <typename Archive>
  void archive(Archive& a) {
    archive_vector(a, frames_);
    a(different_, on_time_, unambiguous_);
  }

 private:
  struct Frame {
    std::int64_t latest = 0;  ///< latest number that it can have
    bool repeated = false;    ///< the frame before it was received twice

    template <typename Archive>
    void archive(Archive& a) {
      a(latest, repeated);
    }
  };

  std::vector<Frame> frames_;
  std::int64_t different_ = 0;  ///< frames that are not repeated
  int on_time_ = 0;             ///< frames in a row, each alone in its period
  bool unambiguous_ = false;
};

/// Returns the numbers of the first frames of a stream, from 0. `arrivals` are in periods. Chooses
/// the grid of due times that minimizes the sum of the frames' lateness.
std::vector<std::int64_t> first_numbers(const std::vector<double>& arrivals);

}  // namespace framewatch::drivers
