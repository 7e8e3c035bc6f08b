// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/identify/elements/deformations.h"
#include "estimator/identify/elements/floor_layout.h"
#include "estimator/identify/regressors/unknown_past.h"
#include "estimator/setup/pipeline_config.h"
#include "estimator/state/archive.h"

namespace framewatch::estimator {

/// The deformation of every frame, panel or group of stories, as a root mean square over whole
/// blocks. It is the amplitude that stiffness may depend on. Displacements come from one oscillator
/// section (OscillatorSection) whose corner is kCorner of the design's lowest frequency. The effect
/// of the motion before a start is removed (UnknownPast), because it decays for seconds and would
/// look like a large deformation. Memory is bounded; allocates only in the constructor.
class ElementDrift {
 public:
  static constexpr double kCorner = 0.4;

  /// Takes sets of the layout's MotionSource. most_blocks: blocks in the longest window.
  ElementDrift(const PipelineConfig& config, const ParameterTable& table, const FloorLayout& layout,
               int block_rows, int most_blocks);

  void restart();
  /// Takes one instant.
  void push(const DeformationSet& set);

  /// Returns the rms of the element's deformation over the newest `blocks` and the block that is
  /// being filled, m; for a panel as in docs/equations.md (3). NaN if a channel that shows it is
  /// missing, or if the parameter is not a stiffness of a frame, panel or group.
  double rms(int parameter, int blocks) const;

  int elements() const { return static_cast<int>(elements_.size()); }
  int block_rows() const { return block_rows_; }

  void archive(auto& a) {
    a.finite(s1_, s2_, sums_);
    a.each_within(was_known_, 0, 1);
    a(past_);
    a.each_within(counts_, 0, block_rows_);
    a.within(rows_, 0, block_rows_);
    a.within(at_, 0, static_cast<double>(blocks_ - 1));
  }

 private:
  struct Term {
    std::size_t value;  ///< index in the DeformationSet
    double weight;
  };
  struct Element {
    std::vector<Term> terms;         ///< empty: not measured
    std::vector<std::size_t> flags;  ///< flags of the DeformationSet that must be set
  };
  void find_stories(const ParameterTable& table, const FloorLayout& layout);
  void find_groups(const PipelineConfig& config, const ParameterTable& table);
  bool known(const Element& element, const DeformationSet& set) const;

  int block_rows_, blocks_;
  double gain_ = 0, over_w2_ = 0;
  PolePair high_pass_poles_, section_;
  std::vector<Element> elements_;  ///< by stiffness parameter
  std::vector<double> s1_, s2_;
  std::vector<UnknownPast> past_;        ///< by element
  std::vector<std::uint8_t> was_known_;  ///< flags at the last instant
  std::vector<double> sums_;             ///< sums of squares, blocks x elements
  std::vector<std::int32_t> counts_;     ///< instants in the sums
  int rows_ = 0, at_ = 0;                ///< rows in the block being filled, and its place
};

}  // namespace framewatch::estimator
