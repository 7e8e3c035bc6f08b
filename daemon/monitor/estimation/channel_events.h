#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include <framewatch/event_t.hpp>

#include "estimator/motion/sample.h"
#include "estimator/motion/sample_merger.h"
#include "estimator/structure/sensors.h"

namespace framewatch::daemon {

/// Says which channels have died: "channel_silent", no sample for kSilent_s (and the time that late
/// samples are waited for) while others send; "channel_stuck", most of its samples of kStuck_s were
/// left out because they did not change while the building moved. Cleared when samples come again,
/// or change again for kMoving_s. The id depends on kind and channel alone, and is larger than the
/// ids of all other events.
class ChannelEvents {
 public:
  static constexpr int kSilent_s = 5, kStuck_s = 2, kMoving_s = 3;

  /// `axes` must outlive this. lateness_s: of the estimator's options.
  ChannelEvents(const std::vector<estimator::SensorAxis>& axes, double lateness_s);

  /// Every sample, as it comes.
  void sample(const estimator::AccelSample& sample);
  /// To be called once a second of sensor time. counters: by axis. What is raised or cleared since
  /// the last call.
  std::vector<event_t> look(const std::vector<estimator::AxisCounters>& counters,
                            std::int64_t time_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(channels_);
  }

 private:
  /// Of one kind of trouble.
  struct Trouble {
    int seconds = 0;  ///< that speak for it; while it is raised, against it
    bool raised = false;
    std::int64_t since_us = 0;

    template <typename Archive>
    void archive(Archive& a) {
      a.within(seconds, 0, a.kMaxCount);
      a(raised);
      a.within(since_us, -2 * a.kMaxCount, 2 * a.kMaxCount);
    }
  };
  struct Channel {
    std::int64_t received = 0, stuck = 0;  ///< as of the last look
    std::int64_t heard_us = 0;             ///< last look at which samples had come
    double value = 0;
    bool changed = false;  ///< its value, since the last look
    Trouble silent, still;

    template <typename Archive>
    void archive(Archive& a) {
      for (std::int64_t* count : {&received, &stuck}) a.within(*count, 0, a.kMaxCount);
      a.within(heard_us, -2 * a.kMaxCount, 2 * a.kMaxCount);
      a(value, changed, silent, still);
    }
  };
  /// Whether it is raised or cleared now.
  static bool turns(Trouble& trouble, bool speaks_for, bool speaks_against, int raise_s,
                    int clear_s);
  event_t event_of(std::size_t axis, const Trouble& trouble, bool silent,
                   std::int64_t time_us) const;

  const std::vector<estimator::SensorAxis>& axes_;
  int silent_s_;
  std::vector<Channel> channels_;
};

}  // namespace framewatch::daemon
