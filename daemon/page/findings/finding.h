#pragma once

#include <cstdint>
#include <string>

#include <framewatch/event_t.hpp>

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

}  // namespace framewatch::daemon
