// SPDX-License-Identifier: MIT
#include "estimator/diagnose/fit/search_settings.h"

#include <algorithm>
#include <set>
#include <string>

#include <gtest/gtest.h>

#include "estimator/diagnose/fit/fit.h"
#include "tests/estimator/diagnose/hidden_effect.h"

namespace framewatch::estimator {
namespace search_settings_test {

const SearchSetting& setting_called(const std::string& name) {
  const auto all = search_settings();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const SearchSetting& s) { return s.name == name; });
  EXPECT_NE(at, all.end()) << name;
  return *at;
}

TEST(SearchSettings, AreAllListedOnceWithinTheirRanges) {
  std::set<std::string> names;
  std::size_t numbers = 0, steps = 0;
  for (const SearchSetting& s : search_settings()) {
    names.insert(s.name);
    (std::holds_alternative<int SearchSettings::*>(s.member) ? steps : numbers) += 1;
    EXPECT_LE(s.low, s.of({})) << s.name;
    EXPECT_GE(s.high, s.of({})) << s.name;
  }
  EXPECT_EQ(names.size(), search_settings().size());
  EXPECT_EQ((numbers * sizeof(double) + steps * sizeof(int) + sizeof(double) - 1) / sizeof(double),
            sizeof(SearchSettings) / sizeof(double))
      << "a number of the search is not in search_settings()";
  constexpr std::size_t kMost = 80;  // more than these nobody can keep in mind
  EXPECT_LE(names.size(), kMost);
}

TEST(SearchSettings, AreSetWithinTheirRange) {
  SearchSettings settings;
  setting_called("min_gain").set(settings, 30.5);
  setting_called("explains").set(settings, 3);
  setting_called("places").set(settings, 2.5);
  setting_called("steps").set(settings, -1);
  EXPECT_DOUBLE_EQ(settings.min_gain, 30.5);
  EXPECT_DOUBLE_EQ(settings.explains, 1);
  EXPECT_EQ(settings.places, 3);
  EXPECT_EQ(settings.steps, 1);
  EXPECT_DOUBLE_EQ(setting_called("places").of(settings), 3);
}

TEST(SearchSettings, GoWithAFitterToOtherSegments) {
  const test::Recorded recorded(test::records_with({}));
  SearchSettings settings;
  settings.min_gain = 7;
  const Fitter fitter(recorded.plant, recorded.segments, {}, {}, settings);
  EXPECT_DOUBLE_EQ(fitter.with(recorded.segments).settings().min_gain, 7);
}

}  // namespace search_settings_test
}  // namespace framewatch::estimator
