#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

/// What a finding is about: whether the building changed, what it went through, whether what is
/// shown can be believed, or the service beside it (disk, history).
enum class FindingKind { change, shake, belief, service };

/// An event that is raised and not cleared, in words for whoever looks after the building.
struct Finding {
  std::int64_t id = 0;  ///< of the event; 0: of no event, nobody can acknowledge it
  FindingKind kind = FindingKind::service;
  std::int32_t severity = 0;
  std::string place;  ///< parameter or channel, as the configuration names it
  std::int64_t since_us = 0;
  /// Of a change: relative to the baseline, and its standard error; NaN otherwise. The numbers of
  /// the event: whoever shows the change shows these.
  double change_ratio = estimator::kNaN, std_error = estimator::kNaN;
  bool of_channel = false;  ///< place is a channel that sends nothing good
  std::string text;         ///< one sentence, without the time
  std::string advice;       ///< what to do
  bool acknowledged = false;
  std::string who;  ///< acknowledged it, where that is known
};

/// Of an event that is raised or changed.
Finding finding_of(const event_t& event, const Config& config);

/// Whether the identified model explains the motion, from the residuals of the main windows that
/// identify something: it does not while their mean over kMean_s is over kMax. With [gap] in the
/// configuration its events say it more sharply; this needs no model of the building beside.
class ModelFit {
 public:
  static constexpr double kMax = 0.5, kAgain = 0.4, kMean_s = 10;

  void push(const window_estimate_t& estimate);

  /// Rms of what the model leaves over rms of the response; empty while it is not known.
  std::optional<double> residual() const;
  std::optional<Finding> finding() const;

 private:
  double mean_ = 0;     ///< of the squares
  double seconds_ = 0;  ///< of windows in it
  std::int64_t last_us_ = 0, since_us_ = 0;
  bool fits_ = true;
};

}  // namespace framewatch::daemon
