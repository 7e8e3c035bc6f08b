#pragma once

#include <string>

#include "drivers/files/text_output.h"
#include "estimator/shaking/story_response.h"

namespace framewatch::daemon {

/// CSV of every floor's motion, whether it has a channel or not (docs/formats.md): one row per
/// instant, accelerations without their means and drift ratios; an empty cell is not known.
class FloorsOutput {
 public:
  explicit FloorsOutput(const estimator::PipelineConfig& config);

  /// These return false, with error(), when the file cannot be written.
  [[nodiscard]] bool open(const std::string& path);
  [[nodiscard]] bool put(const estimator::SampleSet& instant);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

  /// What was identified: floors without a channel move by it from now on.
  void follow(const estimator::WindowEstimate& estimate) { response_.follow(estimate); }

 private:
  bool good(bool done);

  estimator::Structure structure_;
  estimator::StoryResponse response_;
  drivers::TextOutput file_;
  std::string path_, error_, line_;
};

}  // namespace framewatch::daemon
