// SPDX-License-Identifier: MIT
// Plausible ranges of buildings and of shaking-table models. Values outside get a warning.
#pragma once

namespace framewatch::daemon {

struct PlausibleRange {
  double least, most;
  bool holds(double value) const { return value >= least && value <= most; }
};

inline constexpr double kMinBuildingStory_m = 2;  ///< lower stories are of a model
inline constexpr PlausibleRange kStoryHeight_m{0.02, 20};
inline constexpr PlausibleRange kUsualStoryHeight_m{2, 8};
inline constexpr PlausibleRange kSpan_m{0.05, 100};
inline constexpr PlausibleRange kUsualSpan_m{1, 50};
inline constexpr PlausibleRange kBuildingDensity{20, 3000};  ///< kg/m^2 of floor
inline constexpr PlausibleRange kModelDensity{1, 8000};      ///< includes steel plates
/// Product of first natural frequency (Hz) and height (m) of buildings (Ellis, Proc. Instn Civ.
/// Engrs 69 (1980) 763, from 163 buildings).
inline constexpr double kFrequencyTimesHeight_mps = 46;
inline constexpr double kMaxOffFrequency = 10;  ///< largest factor above or below it
inline constexpr PlausibleRange kModelFrequency_hz{0.2, 100};
inline constexpr PlausibleRange kFirstDampingRatio{0.001, 0.3};
inline constexpr double kMaxUnequalStories = 100;  ///< largest stiffness ratio of two stories

}  // namespace framewatch::daemon
