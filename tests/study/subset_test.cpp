// SPDX-License-Identifier: MIT
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>

#include <gtest/gtest.h>

#include "daemon/tools/diagnosis/diagnose_command.h"
#include "tests/study/study_case.h"
#include "tests/study/study_score.h"
#include "tests/support/temporary.h"

namespace framewatch::study {
namespace {

constexpr double kSeconds = 20;
constexpr double kNoise = 0.01;

Outcome diagnosed(const std::string& group, const std::string& name, std::uint64_t seed,
                  double noise = kNoise, const std::vector<std::string>& without = {}) {
  const test::TemporaryDirectory folder;
  CaseOptions options;
  options.seconds = kSeconds;
  options.noise_ratio = noise;
  options.seed = seed;
  std::string why;
  const auto c = make_case(group, name, options, why);
  const std::string directory = folder.path("case");
  if (!c || !write_case(*c, directory, why)) {
    ADD_FAILURE() << name << ": " << why;
    return {};
  }
  daemon::DiagnoseArguments a;
  a.config = directory + "/config.toml";
  a.train = {directory + "/train.csv.gz"};
  a.holdout = {directory + "/holdout.csv.gz"};
  a.out = directory + "/out";
  a.without = without;
  a.quiet = true;
  daemon::diagnose_command(a);
  return score(directory).value_or(Outcome{});
}

struct HiddenEffect {
  const char* name;
  std::uint64_t seed;
  double noise = kNoise;
};
void PrintTo(const HiddenEffect& effect, std::ostream* out) {
  *out << "seed " << effect.seed;
}
class StudyEffects : public testing::TestWithParam<HiddenEffect> {};

TEST_P(StudyEffects, HaveNamesAndPlaces) {
  const Outcome o = diagnosed("catalogue", GetParam().name, GetParam().seed, GetParam().noise);
  EXPECT_TRUE(o.all_right()) << o.verdict;
}

INSTANTIATE_TEST_SUITE_P(Subset, StudyEffects,
                         testing::Values(HiddenEffect{"cubic_stiffness", 4000},
                                         HiddenEffect{"tuned_mass_damper", 4002},
                                         HiddenEffect{"time_shift", 4003},
                                         // so stiff that its run does not converge from a soft
                                         // start
                                         HiddenEffect{"one_sided_gap", 3300008, 0.05},
                                         HiddenEffect{"floor_flexibility", 4005}),
                         [](const auto& effect) { return std::string(effect.param.name); });

// One mass would act along the same two directions.
TEST(StudySubset, FindsTwoEffectsAtOneCrossing) {
  const Outcome o = diagnosed("two_effects", "tuned_mass_damper+two_sided_gap", 2300049, 0.02);
  EXPECT_TRUE(o.all_right()) << o.verdict;
}

TEST(StudySubset, FindsTheModelAdequateIfNothingIsHidden) {
  EXPECT_EQ(diagnosed("nothing", "none", 4100).verdict, "adequate");
}

TEST(StudySubset, NamesAnUnknownEffectOnlyWithDoubt) {
  const Outcome o = diagnosed("catalogue", "two_sided_gap", 4200, kNoise, {"two_sided_gap"});
  EXPECT_FALSE(o.confidently_wrong) << (o.named.empty() ? "" : o.named.front());
  EXPECT_NE(o.verdict, "adequate");
}

TEST(DiagnoseRefuses, RecordsThatItCannotJudge) {
  constexpr int kBadInput = 2;
  const test::TemporaryDirectory folder;
  const std::string directory = folder.path("case"), brief = folder.path("brief.csv");
  CaseOptions options;
  std::string why;
  options.seconds = 8;
  ASSERT_TRUE(write_case(*make_case("nothing", "none", options, why), directory, why)) << why;
  std::ofstream(brief) << "time_s,F1-y1\n0,0\n0.01,0\n0.02,0\n";
  daemon::DiagnoseArguments good;
  good.config = directory + "/config.toml";
  good.train = {directory + "/train.csv.gz"};
  good.holdout = {directory + "/holdout.csv.gz"};
  good.out = directory + "/out";
  good.quiet = true;
  const auto refused = [&](daemon::DiagnoseArguments a) {
    const bool two = daemon::diagnose_command(a) == kBadInput;
    return two && !std::filesystem::exists(good.out);
  };
  daemon::DiagnoseArguments a = good;
  a.holdout = a.train;
  EXPECT_TRUE(refused(a)) << "one file twice";
  a = good;
  a.holdout = {brief};
  EXPECT_TRUE(refused(a)) << "too short, and channels are missing";
  a = good;
  a.without = {"gremlins"};
  EXPECT_TRUE(refused(a)) << "no such effect";
  a = good;
  a.component.displacement = true;
  EXPECT_TRUE(refused(a)) << "a building is no component";
  a = good;
  a.train = {directory + "/nowhere.csv"};
  EXPECT_TRUE(refused(a)) << "no such file";
}

}  // namespace
}  // namespace framewatch::study
