#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "estimator/motion/sample.h"

namespace framewatch::estimator {

/// Repairs single lost samples by the cubic through their four neighbours, two instants later:
/// x = (4 (x-1 + x+1) - (x-2 + x+2)) / 6. Longer losses stay NaN. docs/equations.md, lost samples.
class LostSampleFiller {
 public:
  /// repair: flags of the axes.
  explicit LostSampleFiller(std::vector<std::uint8_t> repair);

  /// Takes the next set; returns the set two instants older, or null while there is none.
  const SampleSet* push(const SampleSet& set);
  /// The input has ended: gives out the sets still held, one per call.
  const SampleSet* drain();

  /// Samples repaired so far, per axis.
  const std::vector<std::int64_t>& repaired() const { return repaired_; }

  template <typename Archive>
  void archive(Archive& a) {
    a(ring_);
    a.within(next_, 0, 4);
    a.within(filled_, 0, 5);
    a.within(waiting_, 0, kLookAhead + 1);
    a(repaired_);
  }

 private:
  static constexpr int kLookAhead = 2;
  SampleSet& held(int age) { return ring_[static_cast<std::size_t>((next_ + 4 - age) % 5)]; }
  void repair();
  const SampleSet* give();

  std::vector<std::uint8_t> repair_;
  std::array<SampleSet, 5> ring_;
  int next_ = 0;     ///< slot of the next set
  int filled_ = 0;   ///< consecutive sets held, at most 5
  int waiting_ = 0;  ///< sets not yet given out
  SampleSet out_;
  std::vector<std::int64_t> repaired_;
};

}  // namespace framewatch::estimator
