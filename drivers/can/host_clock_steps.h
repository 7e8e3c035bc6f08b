#pragma once

#include <cstdint>
#include <vector>

namespace framewatch::drivers {

/// A stream of frames with receive stamps of the host, as HostClockSteps asks it about a step.
class StampedStream {
 public:
  enum class Vote {
    abstains,  ///< silent now, or its times do not come from a clock or counter
    no,
    yes,
  };
  /// Whether the newest frame's stamp is off by this step, microseconds.
  virtual Vote vote(double step_us, double now_us) const = 0;
  /// The host's clock has stepped: stamps from now on are without the step.
  virtual void shift(double step_us) = 0;

 protected:
  ~StampedStream() = default;
};

/// Steps of the host's clock. A step moves the stamps of every stream, a restart those of one node:
/// they are told apart by how many streams see the same step at the same time.
class HostClockSteps {
 public:
  /// `stream` must outlive this.
  void join(StampedStream& stream) { streams_.push_back(&stream); }
  /// Stamp without the steps so far.
  double continuous(double stamp_us) const { return stamp_us - total_us_; }
  std::int64_t count() const { return count_; }
  /// Called by a stream whose stamps have stepped by `step_us`. True: two streams or more, and half
  /// of those that are active, agree; every stream is shifted then. False: the node has restarted.
  bool resolve(double step_us, double now_us);

  template <typename Archive>
  void archive(Archive& a) {
    a(total_us_, count_);
  }

 private:
  std::vector<StampedStream*> streams_;
  double total_us_ = 0;
  std::int64_t count_ = 0;
};

}  // namespace framewatch::drivers
