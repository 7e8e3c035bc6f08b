// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "estimator/gap/base_response.h"
#include "estimator/gap/channel_law.h"
#include "estimator/motion/sample.h"
#include "estimator/structure/sensors.h"
#include "estimator/structure/structure.h"
#include "estimator/watch/change_record.h"

namespace framewatch::estimator {

/// The beginning, another law, or the end of a doubt about a channel.
struct ChannelNews {
  int axis = -1;
  AlarmState state = AlarmState::raised;
  Time found, since;  ///< end and start of windows
  ChannelLaw law;
  double departure = 0;  ///< rms of what the reading has beyond the motion, over the motion's rms
  double others = 0;     ///< the largest departure of the channels that are not in doubt
};

/// One instant of what the channels read and should read, m/s^2, filtered; references.
struct ChannelInstant {
  const std::vector<double>& read;      ///< by axis
  const std::vector<double>& expected;  ///< by axis; NaN for the base
  BaseResponse* base;                   ///< of the same model; null if it is not linear
  /// Share of the motion's energy that the unknown motion at the start may still be, kWindow_s ago.
  double start_share;
};

/// Tells a channel that misreads from a building that changed. The running model knows how every
/// channel of a healthy building should move. A change of the building moves all floors of a
/// direction differently; a faulty channel departs alone. A faulty channel of the base moves the
/// whole model, but by a law that no change of a building has.
/// docs/equations.md, faults of channels.
class ChannelCheck {
 public:
  static constexpr int kWindow_s = 5;

  ChannelCheck(const Structure& structure, const std::vector<SensorAxis>& axes, double rate_hz);

  /// Forgets the window, after an interruption.
  void restart() { filled_ = departing_ = 0; }
  /// Forgets everything, because the model is another one.
  void forget();
  /// Returns true if the next push() looks at a window. It needs the noise then.
  bool ends_second() const { return (newest_ + 1) % per_second_ == 0; }
  /// Takes one instant. noise_variance: by axis, of what is compared; NaN or 0 if unknown. Returns
  /// the news of this instant, at most once a second, valid until the next call.
  const std::vector<ChannelNews>& push(Time time, const ChannelInstant& instant,
                                       const std::vector<double>& noise_variance);
  /// Returns true while a channel seems to misread and is not in doubt yet.
  bool has_candidate() const {
    return std::any_of(doubts_.begin(), doubts_.end(),
                       [](const Doubt& doubt) { return !doubt.raised && doubt.seconds > 0; });
  }
  /// Returns by axis: 1 if the channel is in doubt.
  const std::vector<std::uint8_t>& doubted() const { return doubted_; }
  /// Returns true if a channel of the base is in doubt: the model moves the floors wrongly.
  bool base_doubted() const;

  void archive(auto& a) {
    a(read_, expected_, usual_, doubts_);
    a.within(newest_, 0, static_cast<double>(read_.rows() - 1));
    for (int* rows : {&filled_, &departing_}) a.within(*rows, 0, static_cast<double>(read_.rows()));
    a.each_within(doubted_, 0, 1);
  }

 private:
  /// Holds what a healthy channel leaves, learned window by window.
  struct Usual {
    std::vector<Eigen::Index> from;  ///< axes whose expected motions make up this channel's
    Eigen::MatrixXd sums;            ///< products of slope, motions and reading
    Eigen::MatrixXd waiting;         ///< of the last window, which does not count yet
    double waiting_departure = 0;    ///< Seen::departure of that window
    Eigen::VectorXd law;             ///< factors of the own slope and the motions
    double share = 0;                ///< energy that the law leaves over that of the motion
    double mean = 0, spread = 0;     ///< mean and variance of ln(left / usual) of windows
    double input_share = 0;          ///< base only: least energy of the reading over the floors'
    int windows = 0;

    void forget();
    void archive(auto& a) {
      a.finite(sums, waiting, waiting_departure, law, share, mean, spread, input_share);
      a.within(windows, 0, a.kMaxCount);
    }
  };
  struct Doubt {
    bool raised = false;
    int seconds = 0;  ///< for which windows contradict `raised`
    int age = 0;      ///< seconds since it was raised, while that matters
    ChannelLaw law;
    Time since{};
    double motion = 0;  ///< least energy of the motion that shows whether the fault is over

    void archive(auto& a) {
      a(raised, law, since);
      for (int* count : {&seconds, &age}) a.within(*count, 0, a.kMaxCount);
      a.finite(motion);
    }
  };
  /// One axis in the present window.
  struct Seen {
    bool judged = false;   ///< it should move enough to be judged
    double usual = 0;      ///< energy that a healthy channel leaves
    double left = 0;       ///< energy that it leaves
    double motion = 0;     ///< energy of its expected motion
    double departure = 0;  ///< ln(left / usual)
    bool departs = false;
  };

  /// A channel that seems to misread in the present window.
  struct Candidate {
    int axis;
    ChannelLaw law;
    double departure;  ///< ChannelNews::departure
    bool sure;         ///< its law leaves little
  };

  Eigen::MatrixXd newest(const Eigen::MatrixXd& ring, Eigen::Index rows) const;
  void correct(std::size_t axis);
  Seen look_at(std::size_t axis, double noise, double start_share) const;
  Eigen::Index rows_since_onset(const std::vector<int>& axes) const;
  void follow_departure(bool departs, const std::vector<int>& floors);
  void learn(bool quiet);
  std::vector<Candidate> find_candidates(BaseResponse* base);
  std::vector<Candidate> lost_inputs(const std::vector<int>& floors) const;
  std::vector<Candidate> repeating_input() const;
  std::vector<Candidate> faulty_input(const std::vector<int>& floors, const std::vector<int>& apart,
                                      BaseResponse& base) const;
  double departure(const std::vector<int>& axes) const;
  int witnesses(int axis) const;
  double least_motion(std::size_t axis, const ChannelLaw& law) const;
  void decide(Time time, const std::vector<Candidate>& candidates);

  std::vector<SensorAxis> axes_;
  std::vector<Direction> along_;
  double rate_hz_;
  int per_second_;
  Eigen::MatrixXd read_, expected_;  ///< rings of instants x axes
  int newest_ = 0;                   ///< place of the next instant in read_
  int filled_ = 0;                   ///< instants in read_
  int departing_ = 0;                ///< instants since floors depart; 0: they do not
  std::vector<Usual> usual_;
  std::vector<Doubt> doubts_;
  std::vector<std::uint8_t> doubted_;
  std::vector<ChannelNews> news_;

  // These members describe the present window.
  Eigen::MatrixXd window_read_, motion_;  ///< in the order of time; motion of the model
  Eigen::MatrixXd window_expected_;       ///< motion_ with the usual law
  std::vector<Seen> seen_;
  std::vector<double> noise_;
};

}  // namespace framewatch::estimator
