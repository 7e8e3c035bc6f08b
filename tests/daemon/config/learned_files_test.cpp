// SPDX-License-Identifier: MIT
#include "daemon/config/learned_files.h"

#include <gtest/gtest.h>

#include "daemon/tools/lab/study_buildings.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace learned_files_test {

const estimator::ParameterTable& table() {
  static const estimator::ParameterTable of(table1());
  return of;
}

std::string with(const std::string& keys) {
  return "[[parameter]]\nname = \"" + table()[0].name +
         "\"\nvalue = 2\nstd_error = 0.1\nunit = \"" + table()[0].unit + "\"\n" + keys;
}

std::optional<estimator::Baseline> read(const std::string& text, std::string& first_problem) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("baseline.toml");
  test::write_file(path, text);
  std::vector<ConfigProblem> problems;
  const auto out = load_baseline(path, table(), problems);
  first_problem = problems.empty() ? "" : problems.front().message;
  return out;
}

TEST(BaselineFile, KeepsValuesByAmplitude) {
  estimator::Baseline b(static_cast<std::size_t>(table().size()));
  b.value[0] = 2, b.std_error[0] = 0.1;
  b.by_amplitude[0] = {{1e-5, 2.05, 0.125}, {1e-4, 1.9, 0.0625}};
  std::string problem;
  const auto back = read(baseline_text(b, table()), problem);
  ASSERT_TRUE(back) << problem;
  ASSERT_EQ(back->by_amplitude[0].size(), 2u);
  EXPECT_EQ(back->by_amplitude[0][1].amplitude_m, 1e-4);
  EXPECT_EQ(back->by_amplitude[0][1].value, 1.9);
  EXPECT_EQ(back->by_amplitude[0][0].std_error, 0.125);
  EXPECT_EQ(baseline_text(*back, table()), baseline_text(b, table()));
}

TEST(BaselineFile, ReadsFilesWithoutAmplitudes) {
  std::string problem;
  const auto b = read(with(""), problem);
  ASSERT_TRUE(b) << problem;
  EXPECT_TRUE(b->by_amplitude[0].empty());
}

TEST(BaselineFile, ReportsMalformedAmplitudes) {
  const std::string good = "value_at_amplitude = [2, 2]\nstd_error_at_amplitude = [0.1, 0.1]\n";
  const std::vector<std::string> wrong{
      "amplitude_m = [1e-5, 1e-4]\n",         // no values
      "amplitude_m = [1e-4, 1e-5]\n" + good,  // descending
      "amplitude_m = [1e-4, 1e-4]\n" + good,  // twice
      "amplitude_m = [0, 1e-4]\n" + good,     // no motion
      "amplitude_m = [1e-5, nan]\n" + good,   // no number
      "amplitude_m = \"small\"\n" + good,     // no list
      "amplitude_m = [1e-5]\n" + good,        // too few
      good,                                   // none
      "amplitude_m = [1e-5, 1e-4]\nvalue_at_amplitude = [2, -2]\nstd_error_at_amplitude = [1, 1]\n",
  };
  for (const std::string& keys : wrong) {
    std::string problem;
    EXPECT_FALSE(read(with(keys), problem)) << keys;
    EXPECT_FALSE(problem.empty()) << keys;
  }
}

}  // namespace learned_files_test
}  // namespace framewatch::daemon
