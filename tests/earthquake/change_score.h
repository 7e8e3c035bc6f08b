// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "tests/earthquake/change_run.h"

namespace framewatch::earthquake {

/// Times after the first announcement at which what is shown is judged, s. The last one is the end
/// of the record.
inline constexpr std::array<double, 8> kAfter_s{
    0, 1, 2, 5, 10, 30, 60, std::numeric_limits<double>::infinity()};

/// What is shown of an element at one time.
struct Shown {
  bool there = false;      ///< the record lasts so long, and the truth has stood still long enough
  bool withdrawn = false;  ///< cleared
  bool sized = false;      ///< with a number
  double error = 0, std_error = 0, truth = 0;  ///< of the size, relative to the baseline
};

/// An element that changed and is watched.
struct ElementScore {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  int parameter = -1;
  double truth = 0;         ///< at the end, relative
  double delay_s = kNever;  ///< from when it can be seen to the first announcement
  int said = 0;             ///< announcements, cleared ones left out
  int cleared = 0;
  std::array<Shown, kAfter_s.size()> shown;
  std::vector<Shown> sizes;         ///< of each announcement with a number
  int pairs = 0, pairs_within = 0;  ///< of an earlier and a later size: within two earlier errors
  bool error_grew = false;          ///< a later stated error is larger than an earlier one
};

struct CaseScore {
  std::vector<ElementScore> changed;
  int unchanged = 0;   ///< watched elements that did not change
  int neighbours = 0;  ///< of these, named after the change
  int standing = 0;    ///< of these, still named at the end
  int gains = 0;       ///< elements of which a gain was announced
  int early = 0;       ///< elements named before anything changed
  int whole = 0;       ///< announcements about the whole building
  int said = 0;        ///< announcements in all, cleared ones left out
  int unlearned = 0;
};

CaseScore score_change(const ChangeCase& of, const ChangeRun& run);

}  // namespace framewatch::earthquake
