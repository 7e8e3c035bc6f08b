// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "tests/earthquake/change_run.h"

namespace framewatch::earthquake {

/// Times after the first announcement at which the display is scored, s. The last one is the end
/// of the record.
inline constexpr std::array<double, 8> kAfter_s{
    0, 1, 2, 5, 10, 30, 60, std::numeric_limits<double>::infinity()};

/// The display of an element at one time.
struct Shown {
  bool there =
      false;  ///< true if the record lasts that long and the truth has been constant long enough
  bool withdrawn = false;                      ///< cleared
  bool sized = false;                          ///< with a number
  double error = 0, std_error = 0, truth = 0;  ///< of the size, relative to the baseline
};

/// A watched element that changed.
struct ElementScore {
  static constexpr double kNever = std::numeric_limits<double>::infinity();
  int parameter = -1;
  double truth = 0;         ///< at the end, relative
  double delay_s = kNever;  ///< from the first time it can be seen to the first announcement
  int said = 0;             ///< announcements, without cleared ones
  int cleared = 0;
  std::array<Shown, kAfter_s.size()> shown;
  std::vector<Shown> sizes;  ///< one for each announcement with a number
  int pairs = 0,
      pairs_within =
          0;  ///< pairs of an earlier and a later size that agree within two earlier errors
  bool error_grew = false;  ///< pairs in which the later stated error is larger
};

struct CaseScore {
  std::vector<ElementScore> changed;
  int unchanged = 0;   ///< watched elements that did not change
  int neighbours = 0;  ///< of these, the number named after the change
  int standing = 0;    ///< of these, the number still named at the end
  int gains = 0;       ///< elements with an announced gain
  int early = 0;       ///< elements named before anything changed
  int whole = 0;       ///< announcements about the whole building
  int said = 0;        ///< all announcements, without cleared ones
  int unlearned = 0;
};

CaseScore score_change(const ChangeCase& of, const ChangeRun& run);

}  // namespace framewatch::earthquake
