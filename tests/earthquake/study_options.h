// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace framewatch::earthquake {

/// Options of a study's command line, each a name and a number: --seed 3.
class StudyOptions {
 public:
  /// Returns nullopt if an argument is not one of `known` followed by a number.
  static std::optional<StudyOptions> read(int count, char** arguments,
                                          const std::vector<std::string>& known);
  double number(const std::string& name, double usual) const;
  bool given(const std::string& name) const { return numbers_.contains(name); }

 private:
  std::map<std::string, double> numbers_;
};

}  // namespace framewatch::earthquake
