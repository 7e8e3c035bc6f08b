#pragma once

#include <optional>
#include <string>
#include <vector>

namespace framewatch::study {

/// What a diagnosis made of one case.
struct Outcome {
  std::string directory, group, building, hidden;
  double noise_ratio = 0;
  std::string verdict;             ///< refused: no diagnosis.json
  std::vector<std::string> named;  ///< effects adopted
  int truths = 0;                  ///< effects hidden
  int places_right = 0;    ///< of those, at whose place something was adopted; of none, that which
                           ///< is the likeliest
  int right = 0;           ///< of those, with their name or that of their family too
  int exact = 0;           ///< with their very name
  bool told_apart = true;  ///< false: right only among those that cannot be told apart
  bool extra = false;      ///< something was adopted that is not there
  bool confidently_wrong = false;  ///< and the diagnosis is sure of its name
  bool of_the_kind = true;  ///< all that was adopted is at the place of a hidden effect and a law
                            ///< of its kind
  bool in_doubt = true;     ///< and has a confidence of at most a half
  std::optional<double> gap_before, gap_after, noise_floor;  ///< held out, overall
  std::vector<double> parameter_errors;  ///< relative, of what was named exactly

  bool abstained() const { return named.empty(); }
  /// Nothing named, or nothing but what is near, and said to be in doubt.
  bool no_wrong_name() const { return abstained() || (of_the_kind && in_doubt); }
  bool kind_and_place() const { return !abstained() && of_the_kind; }
  bool all_right() const { return right == truths && !extra; }
  /// Share of what exceeds the noise floor that is gone.
  std::optional<double> removed() const;
};

/// Group of a case of the catalogue that was diagnosed without its effect in the catalogue.
inline constexpr const char* kTakenOut = "taken_out";

/// From DIRECTORY/truth.json and DIRECTORY/out/diagnosis.json, or that of another folder, which is
/// the name of its group then; empty when there is no truth.
std::optional<Outcome> score(const std::string& directory, const std::string& folder = "out");

/// A rate that is asked for.
struct Bound {
  std::string what, asked, measured;
  bool holds = false;
};

/// Of what there are cases of.
std::vector<Bound> bounds_of(const std::vector<Outcome>& outcomes);

/// Rates, confusion matrix, shrinking of the gap and what is asked, as Markdown.
std::string tables(const std::vector<Outcome>& outcomes);

}  // namespace framewatch::study
