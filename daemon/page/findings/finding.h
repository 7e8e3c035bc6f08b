// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <framewatch/event_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/config/config.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {

/// The subject of a finding: change: of the building; shake: motion it went through; belief:
/// whether the estimates can be trusted; service: disk, history and the like.
enum class FindingKind { change, shake, belief, service };

/// A raised event in words for the operator of the building.
struct Finding {
  std::int64_t id = 0;  ///< of the event; 0: not an event, cannot be acknowledged
  FindingKind kind = FindingKind::service;
  std::int32_t severity = 0;
  std::string place;  ///< parameter or channel, as the configuration names it
  std::int64_t since_us = 0;
  /// Size of a change relative to the baseline, and its standard error; NaN for other findings.
  double change_ratio = estimator::kNaN, std_error = estimator::kNaN;
  bool of_channel = false;  ///< `place` is a channel without usable samples
  std::string text;         ///< one sentence, without the time
  std::string advice;       ///< what to do
  bool acknowledged = false;
  std::string who;  ///< who acknowledged it; empty where unknown
};

/// Returns the words for an event's place: a parameter as named_place(), else the place itself.
std::string place_name(const std::string& place, const Config& config);

/// Describes an event that is raised or changed.
Finding finding_of(const event_t& event, const Config& config);

/// Checks whether the identified model explains the motion. It does not while the mean residual of
/// the valid main windows over kMean_s exceeds kMax. Needs no separate model of the building,
/// unlike the events of [gap], which are more sensitive.
class ModelFit {
 public:
  static constexpr double kMax = 0.5, kAgain = 0.4, kMean_s = 10;

  void push(const window_estimate_t& estimate);

  /// Returns the rms of the residual over the rms of the response; nullopt before the first window.
  std::optional<double> residual() const;
  std::optional<Finding> finding() const;

 private:
  double mean_ = 0;     ///< of the squared ratios
  double seconds_ = 0;  ///< length of the windows in mean_
  std::int64_t last_us_ = 0, since_us_ = 0;
  bool fits_ = true;
};

}  // namespace framewatch::daemon
