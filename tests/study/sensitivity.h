// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace framewatch::study {

/// A number of the search that is half or twice as large.
struct ChangedSetting {
  std::string name, value;

  /// Returns NAME=VALUE: the argument of `--setting`, and the folder of the diagnoses.
  std::string text() const { return name + "=" + value; }
};

/// Returns every number of the search, or the one called `only`, half and twice as large, within
/// its range. Leaves out values that the range makes equal to the usual one.
std::vector<ChangedSetting> changed_settings(const std::string& only);

/// Returns a Markdown table of every number, or of the one called `only`. For each value it lists
/// the cases in these directories whose names, places or confident errors differ from those in the
/// folder `out`.
std::string sensitivity_table(const std::vector<std::string>& directories, const std::string& only);

}  // namespace framewatch::study
