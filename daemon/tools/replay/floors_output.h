// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "drivers/files/text_output.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// Writes the motion of every floor, with or without a channel, as CSV (docs/formats.md). Each
/// instant has one row: accelerations without their means, m/s^2, and drift ratios. Unknown values
/// are empty cells.
class FloorsOutput {
 public:
  explicit FloorsOutput(const estimator::PipelineConfig& config);

  /// These return false and set error() when the file cannot be written.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool put(const estimator::SampleSet& instant);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

  /// Computes floors without a channel with the stiffnesses of `estimate` from now on.
  void follow(const estimator::WindowEstimate& estimate) { response_.follow(estimate); }

 private:
  bool good(bool done);

  estimator::Structure structure_;
  estimator::StoryResponse response_;
  drivers::TextOutput file_;
  std::string path_, error_, line_;
};

}  // namespace framewatch::daemon
