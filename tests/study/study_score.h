// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace framewatch::study {

/// Result of a diagnosis of one case.
struct Outcome {
  std::string directory, group, building, hidden;
  double noise_ratio = 0;
  std::string verdict;             ///< refused: no diagnosis.json
  std::vector<std::string> named;  ///< effects adopted
  int truths = 0;                  ///< effects hidden
  int places_right =
      0;  ///< of those, with an adopted effect at their place; if none, with the likeliest place
  int right = 0;                   ///< of those, with their name or that of their family
  int exact = 0;                   ///< with exactly their name
  bool told_apart = true;          ///< false: right only among indistinguishable names
  bool extra = false;              ///< an effect was adopted that is not there
  bool confidently_wrong = false;  ///< with high confidence in its name
  bool of_the_kind =
      true;  ///< every adopted effect is at the place of a hidden effect and a law of its kind
  bool in_doubt = true;  ///< with a confidence of at most a half
  std::optional<double> gap_before, gap_after, noise_floor;  ///< held out, overall
  std::vector<double> parameter_errors;                      ///< relative, of exactly named effects

  bool abstained() const { return named.empty(); }
  /// Returns true if nothing was named, or only a nearest law with low confidence.
  bool no_wrong_name() const { return abstained() || (of_the_kind && in_doubt); }
  bool kind_and_place() const { return !abstained() && of_the_kind; }
  bool all_right() const { return right == truths && !extra; }
  /// Returns the removed share of the excess over the noise floor.
  std::optional<double> removed() const;
};

/// Group of a case of the catalog that was diagnosed without its effect in the catalog.
inline constexpr const char* kTakenOut = "taken_out";

/// Reads DIRECTORY/truth.json and DIRECTORY/out/diagnosis.json. For another `folder`, its name is
/// the group. Returns nullopt if there is no truth.
std::optional<Outcome> score(const std::string& directory, const std::string& folder = "out");

/// A required rate.
struct Bound {
  std::string what, asked, measured;
  bool holds = false;
};

/// Returns the bounds for which there are cases.
std::vector<Bound> bounds_of(const std::vector<Outcome>& outcomes);

/// Returns rates, confusion matrix, reduction of the gap and required rates as Markdown.
std::string tables(const std::vector<Outcome>& outcomes);

}  // namespace framewatch::study
