// SPDX-License-Identifier: MIT
#include "tests/study/sensitivity.h"

#include <optional>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "estimator/diagnose/fit/search_settings.h"
#include "tests/study/study_score.h"

namespace framewatch::study {
namespace {

using estimator::SearchSetting;
using estimator::SearchSettings;

constexpr double kHalf = 0.5, kTwice = 2;

std::string value_text(double value) {
  return fmt::format("{:.6g}", value);
}

/// Returns the setting times a factor, within its range; nullopt if that is the usual value.
std::optional<ChangedSetting> changed(const SearchSetting& setting, double factor) {
  const double usual = setting.of({});
  SearchSettings settings;
  setting.set(settings, factor * usual);
  if (setting.of(settings) == usual) return std::nullopt;
  return ChangedSetting{setting.name, value_text(setting.of(settings))};
}

/// Returns "" if the outcome is the usual one, otherwise what was named: "time_shift: nothing".
std::string difference(const Outcome& usual, const Outcome& now) {
  if (now.named == usual.named && now.right == usual.right &&
      now.places_right == usual.places_right && now.extra == usual.extra &&
      now.confidently_wrong == usual.confidently_wrong)
    return "";
  std::string out = usual.hidden + ": ";
  out += now.named.empty() ? "nothing" : fmt::format("{}", fmt::join(now.named, ", "));
  if (now.confidently_wrong) out += ", **confidently wrong**";
  if (!usual.all_right() && now.all_right()) out += ", which is right";
  return out;
}

std::string cell_of(const std::vector<std::string>& directories, const SearchSetting& setting,
                    double factor) {
  const std::optional<ChangedSetting> it = changed(setting, factor);
  if (!it) return "-";
  std::vector<std::string> differences;
  int waiting = 0;
  for (const std::string& directory : directories) {
    const auto usual = score(directory), now = score(directory, it->text());
    if (!usual || !now || now->verdict == "refused") {
      ++waiting;
      continue;
    }
    if (std::string text = difference(*usual, *now); !text.empty())
      differences.push_back(std::move(text));
  }
  std::string out = it->value;
  if (!differences.empty()) out += fmt::format(": {}", fmt::join(differences, "; "));
  if (waiting > 0) out += fmt::format(" ({} not run)", waiting);
  return out;
}

}  // namespace

std::vector<ChangedSetting> changed_settings(const std::string& only) {
  std::vector<ChangedSetting> out;
  for (const SearchSetting& setting : estimator::search_settings())
    for (const double factor : {kHalf, kTwice})
      if (only.empty() || only == setting.name)
        if (auto it = changed(setting, factor)) out.push_back(std::move(*it));
  return out;
}

std::string sensitivity_table(const std::vector<std::string>& directories,
                              const std::string& only) {
  std::string out = "| number | usual | half | twice |\n| --- | --- | --- | --- |\n";
  for (const SearchSetting& setting : estimator::search_settings())
    if (only.empty() || only == setting.name)
      out +=
          fmt::format("| `{}` | {} | {} | {} |\n", setting.name, value_text(setting.of({})),
                      cell_of(directories, setting, kHalf), cell_of(directories, setting, kTwice));
  return out;
}

}  // namespace framewatch::study
