// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tests/earthquake/study_buildings.h"

namespace framewatch::earthquake {

/// Events before the instant from which times are counted.
enum class Interruption {
  none,              ///< strong motion without interruption, for comparison
  starts_at_rest,    ///< the record begins at rest; counted from the first motion of the ground
  starts_in_motion,  ///< the record begins in strong motion; counted from its first sample
  all_missing,       ///< all channels lack samples for a while; counted from its end
  one_missing,       ///< one channel, drawn by seed, lacks samples for a while
  comes_and_goes     ///< one channel is away every other second, five times
};

struct InterruptionCase {
  int building = 0;  ///< index of interruption_buildings()
  bool design_off = false;
  Interruption kind = Interruption::none;
  double length_s = 0;  ///< of all_missing and one_missing
  std::uint64_t seed = 1;
  double noise_ratio = 0.01;  ///< white noise of each channel over the rms of its strong motion
};

/// Returns the buildings of the cases.
const std::vector<StudyBuilding>& interruption_buildings();
/// Returns every kind and length for every building and both designs, with `seeds` motions each,
/// from seed `first` on. Cases of one building and seed share their motion and noise.
std::vector<InterruptionCase> interruption_cases(int seeds, std::uint64_t first);
/// Returns a title, such as "all missing 0.5 s".
std::string text_of(Interruption kind, double length_s);

inline constexpr int kWindowLengths = 4;  ///< by WindowEstimate::window
inline constexpr std::array<double, kWindowLengths> kWindow_s{5, 1, 2.5, 10};
inline constexpr int kMain = 0, kShort = 1;

enum ParameterGroup { stiffnesses, panels, dampings, kParameterGroups };

/// Upper ends of the time bins, s. The first bin holds values published during the interruption.
inline constexpr std::array<double, 7> kUntil_s{0, 1.2, 2, 3, 5, 8, 10};
/// Times at which errors are measured, s.
inline constexpr std::array<double, 4> kErrorAt_s{1.2, 2, 5, 8};

/// Seconds since the start or the end of the interruption; infinite: not within 10 s.
struct FirstWindow {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  double any_s = kNever;  ///< end of the first window with a value of a stiffness
  double all_s = kNever;  ///< end of the first one with values of all frame stiffnesses
  double published_s =
      kNever;  ///< time of the newest sample when the window of any_s was published
};

/// Quarters of a second from 1.2 s to 8 s in which a window may end.
inline constexpr int kSlots = 27;
inline constexpr double kSlot_s = 0.25, kSlotsFrom_s = 1.2;

struct Tally {
  double count = 0, held = 0, square_sum = 0;  ///< as Coverage::add_values
};

struct InterruptionResult {
  std::array<FirstWindow, kWindowLengths> first;
  /// For each quarter of a second: true if a window with a value of a stiffness ends in it.
  std::array<std::array<bool, kSlots>, kWindowLengths> shown{};
  /// Published values by window length, time and kind of parameter. Of the main window only those
  /// that end a tenth of a second apart.
  std::array<std::array<std::array<Tally, kParameterGroups>, kUntil_s.size()>, kWindowLengths>
      tally;
  /// Relative errors, absolute, of the first window that ends within 0.26 s from each of
  /// kErrorAt_s: published values of the 5-s (0) and the 1-s window (1).
  std::array<std::array<std::array<std::vector<double>, kParameterGroups>, kErrorAt_s.size()>, 2>
      error;
  /// Number of parameters that could have been published there.
  std::array<int, kParameterGroups> wanted{};
};

/// Simulates the motion exactly at 1 ms, band-limits and samples it, adds noise, applies the
/// interruption and runs the pipeline.
InterruptionResult run_interruption(const InterruptionCase& of);

}  // namespace framewatch::earthquake
