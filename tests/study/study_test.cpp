// SPDX-License-Identifier: MIT
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/config/config.h"
#include "tests/study/practice.h"
#include "tests/study/sensitivity.h"
#include "tests/study/study_case.h"
#include "tests/study/study_record.h"
#include "tests/study/study_score.h"
#include "tests/support/data.h"
#include "tests/support/temporary.h"

namespace framewatch::study {
namespace {

CaseOptions quick(const std::string& building = "2story_1x1") {
  CaseOptions o;
  o.building = building;
  o.seconds = 15;
  o.seed = 7;
  return o;
}

StudyCase made(const std::string& group, const std::string& name, const CaseOptions& options) {
  std::string why;
  const auto c = make_case(group, name, options, why);
  if (!c) {
    ADD_FAILURE() << name << ": " << why;
    return {};
  }
  return *c;
}

TEST(StudyCase, WritesConfigurationTwoRecordsAndTruth) {
  const test::TemporaryDirectory folder;
  for (const std::string& building : building_kinds()) {
    const std::string directory = folder.path(building);
    std::string error;
    ASSERT_TRUE(write_case(made("nothing", "none", quick(building)), directory, error)) << error;
    std::vector<daemon::ConfigProblem> problems;
    const auto config = daemon::load_config(directory + "/config.toml", problems);
    ASSERT_TRUE(config) << problems.front().where << ": " << problems.front().message;
    EXPECT_GT(config->pipeline.design.size(), 0);
    for (const char* record : {"/train.csv.gz", "/holdout.csv.gz"})
      EXPECT_GT(std::filesystem::file_size(directory + record), 10000u);
    const auto outcome = score(directory);
    ASSERT_TRUE(outcome);
    EXPECT_EQ(outcome->verdict, "refused") << "it has no diagnosis";
    EXPECT_EQ(outcome->truths, 0);
  }
}

TEST(StudyCase, TheSameSeedGivesTheSameRecords) {
  const StudyCase a = made("catalogue", "cubic_stiffness", quick());
  const StudyCase b = made("catalogue", "cubic_stiffness", quick());
  EXPECT_EQ(measured(a, 1), measured(b, 1));
  CaseOptions other = quick();
  other.seed = 8;
  EXPECT_NE(measured(a, 1), measured(made("catalogue", "cubic_stiffness", other), 1));
}

TEST(StudyCase, NoiseHasItsDeclaredSize) {
  const StudyCase loud = made("nothing", "none", quick());
  StudyCase still = loud;
  still.options.noise_ratio = 0;
  const Eigen::MatrixXd noise = measured(loud, 0) - measured(still, 0);
  const Eigen::MatrixXd signal = measured(still, 0);
  for (Eigen::Index a = 0; a < noise.cols(); ++a) {
    const double bias = signal.col(a).head(100).mean();
    const double rms = std::sqrt((signal.col(a).array() - bias).square().mean());
    EXPECT_NEAR(std::sqrt(noise.col(a).squaredNorm() / static_cast<double>(noise.rows())),
                0.02 * rms, 0.15 * 0.02 * rms);
  }
}

TEST(StudyCase, NoiseGrowsTowardLowFrequencies) {
  const auto power_of_mean = [](double flicker_share) {
    CaseOptions options = quick();
    options.flicker_share = flicker_share;
    const StudyCase loud = made("nothing", "none", options);
    StudyCase still = loud;
    still.options.noise_ratio = 0;
    const Eigen::MatrixXd noise = measured(loud, 0) - measured(still, 0);
    double slow = 0;
    constexpr Eigen::Index kBlock = 50;
    for (Eigen::Index at = 0; at + kBlock <= noise.rows(); at += kBlock)
      slow += (noise.middleRows(at, kBlock).colwise().mean()).squaredNorm();
    return slow / noise.squaredNorm();
  };
  EXPECT_GT(power_of_mean(0.3), 4 * power_of_mean(0));
}

TEST(StudyCase, AddsMassDampingWithDashpotsToTheGround) {
  CaseOptions none = quick(), some = quick();
  none.mass_damping = 0;
  some.mass_damping = 0.5;
  const StudyCase a = made("nothing", "none", none), b = made("nothing", "none", some);
  EXPECT_TRUE(a.ground_dampers.empty());
  ASSERT_EQ(std::ssize(b.ground_dampers), b.building.truth.degrees_of_freedom());
  EXPECT_EQ(a.building.theta, b.building.theta);
  EXPECT_LT(clean_record(b, 0).norm(), 0.98 * clean_record(a, 0).norm());
}

TEST(StudyCase, HidesThreeEffects) {
  const StudyCase c = made("three_effects", "cubic_stiffness+gain_error+extra_mass", quick());
  EXPECT_EQ(c.hidden.effects.size(), 3U);
}

TEST(StudyCase, HiddenEffectsShowAboveTheNoise) {
  constexpr double kShows =
      2;  // times the noise of all channels; a sensor's fault is in one channel
  for (const char* name :
       {"bouc_wen", "gain_error", "time_shift", "smooth gap", "cubic_stiffness+gain_error",
        "slack brace", "yielding that tires", "whole frame softens"}) {
    const StudyCase c = made("any", name, quick());
    EXPECT_GE(c.gap_over_floor, 3) << name;
    StudyCase nothing = c;
    nothing.hidden = {{}, {}, c.building.theta};
    EXPECT_GT((clean_record(c, 0) - clean_record(nothing, 0)).norm(),
              kShows * c.options.noise_ratio * clean_record(nothing, 0).norm())
        << name;
  }
}

TEST(Practice, IsImportedWithTheNamesOfTheCatalogue) {
  FRAMEWATCH_DATA_OR_SKIP(truth, "practice/case-009/truth.json");
  const std::string source = std::filesystem::path(truth).parent_path().string();
  const test::TemporaryDirectory folder;
  const std::string directory = folder.path("case");
  std::string error;
  ASSERT_TRUE(import_practice(source, directory, error)) << error;
  std::vector<daemon::ConfigProblem> problems;
  EXPECT_TRUE(daemon::load_config(directory + "/config.toml", problems));
  std::filesystem::create_directory(directory + "/out");
  std::ofstream(directory + "/out/diagnosis.json")
      << R"({"verdict": "explained", "effects": [{"effect": "cubic_stiffness", "location":
            {"kind": "frame", "direction": "y", "story": 2, "frame": "x2"}}]})";
  EXPECT_TRUE(score(directory).value().all_right());
  EXPECT_FALSE(import_practice(folder.path("nowhere"), directory, error));
}

/// A floor with two digits. Of two effects, the one that does not equal a lower stiffness in every
/// record.
TEST(Practice, ListsTheEffectsToFind) {
  FRAMEWATCH_DATA_OR_SKIP(data, "practice/case-009/truth.json");
  const std::filesystem::path cases = std::filesystem::path(data).parent_path().parent_path();
  const test::TemporaryDirectory folder;
  const auto is_right = [&](const std::string& name, const std::string& found) {
    const std::string directory = folder.path(name);
    std::string error;
    EXPECT_TRUE(import_practice((cases / name).string(), directory, error)) << error;
    std::filesystem::create_directory(directory + "/out");
    std::ofstream(directory + "/out/diagnosis.json")
        << R"({"verdict": "explained", "effects": [)" << found << "]}";
    return score(directory).value().all_right();
  };
  EXPECT_TRUE(is_right("case-007", R"({"effect": "tuned_mass_damper", "location":
      {"kind": "node", "direction": "y", "story": 12, "frame": "x3"}})"));
  EXPECT_TRUE(is_right("case-032", R"({"effect": "bilinear_hysteresis", "location":
      {"kind": "frame", "direction": "x", "story": 1, "frame": "y1"}})"));
}

TEST(StudyScore, ScoresNamePlaceAndGap) {
  const test::TemporaryDirectory folder;
  const std::string directory = folder.path("case");
  std::string error;
  const StudyCase c = made("catalogue", "bouc_wen", quick());
  ASSERT_TRUE(write_case(c, directory, error)) << error;
  std::filesystem::create_directory(directory + "/out");
  const estimator::EffectPlace& place = c.hidden.effects.front().place;
  const auto diagnosed = [&](const std::string& verdict, const std::string& name, int story,
                             double confidence = 0.999) {
    const std::string where = place.kind == estimator::PlaceKind::panel
                                  ? "\"kind\": \"panel\", \"panel\": \"x1y1\""
                                  : "\"kind\": \"frame\", \"frame\": \"" +
                                        c.building.truth.frame_name(place.frame) + "\"";
    std::ofstream(directory + "/out/diagnosis.json")
        << "{\"verdict\": \"" << verdict << "\", \"effects\": [{\"effect\": \"" << name
        << "\", \"location\": {" << where << ", \"story\": " << story
        << "}, \"parameters\": {\"kh_npm\": {\"value\": "
        << 1.2 * c.hidden.effects.front().value("kh_npm") << "}}, \"confidence\": " << confidence
        << "}], \"gap\": {\"before\": {\"holdout\": {\"overall\": 0.2}}, \"after\": "
           "{\"holdout\": "
           "{\"overall\": 0.04}}, \"noise_floor\": {\"holdout\": {\"overall\": 0.02}}}}";
    return score(directory).value();
  };
  const Outcome right = diagnosed("explained", "bouc_wen", place.story);
  EXPECT_TRUE(right.all_right());
  EXPECT_EQ(right.exact, 1);
  EXPECT_NEAR(right.removed().value(), 1 - 0.02 / 0.18, 1e-9);
  ASSERT_EQ(right.parameter_errors.size(), 1u);
  EXPECT_NEAR(right.parameter_errors[0], 0.2, 1e-5) << "the size was written as text";

  const Outcome family = diagnosed("explained", "bilinear_hysteresis", place.story);
  EXPECT_TRUE(family.all_right());
  EXPECT_EQ(family.exact, 0);

  const Outcome elsewhere = diagnosed("explained", "bouc_wen", 3 - place.story);
  EXPECT_TRUE(elsewhere.confidently_wrong);
  EXPECT_EQ(elsewhere.places_right, 0);

  const Outcome otherwise = diagnosed("partly_explained", "cubic_stiffness", place.story);
  EXPECT_FALSE(otherwise.all_right());
  EXPECT_EQ(otherwise.places_right, 1);
  EXPECT_TRUE(otherwise.confidently_wrong);
  EXPECT_FALSE(
      diagnosed("partly_explained", "cubic_stiffness", place.story, 0.5).confidently_wrong);

  const Outcome near = diagnosed("partly_explained", "pinching", place.story, 0.5);
  EXPECT_TRUE(near.no_wrong_name()) << "remembers as Bouc-Wen does";
  EXPECT_FALSE(near.all_right());
  EXPECT_TRUE(near.kind_and_place());
  EXPECT_FALSE(otherwise.kind_and_place());
  for (const auto& [name, story, confidence] :
       {std::tuple("pinching", place.story, 0.6), std::tuple("pinching", 3 - place.story, 0.5),
        std::tuple("cubic_stiffness", place.story, 0.5)})
    EXPECT_FALSE(diagnosed("partly_explained", name, story, confidence).no_wrong_name())
        << name << story << confidence;

  EXPECT_FALSE(score(directory, kTakenOut)->confidently_wrong) << "it was not diagnosed so";
  const std::vector<Bound> bounds = bounds_of({right, elsewhere});
  ASSERT_FALSE(bounds.empty());
  EXPECT_EQ(bounds.front().measured, "1 of 2 (50.0 %)") << bounds.front().what;
  EXPECT_FALSE(bounds.front().holds);
  EXPECT_TRUE(bounds_of({right}).front().holds);

  const std::string table = tables({right, elsewhere});
  EXPECT_NE(table.find("| bouc_wen | 2 | 1 | 1 |"), std::string::npos) << table;
}

/// Writes a case that hides a drop, and the diagnosis of its folder.
void write_scored(const std::string& directory, const std::string& folder, const char* effects) {
  std::filesystem::create_directories(directory + "/" + folder);
  test::write_file(directory + "/truth.json",
                   R"({"study": {"name": "stiffness_drop"}, "effects": [{"effect":
                       "stiffness_drop", "location": {"kind": "frame", "story": 1,
                       "frame": "x1"}}]})");
  test::write_file(directory + "/" + folder + "/diagnosis.json",
                   std::string(R"({"verdict": "explained", "effects": [)") + effects + "]}");
}

TEST(Sensitivity, ChangesEveryNumberWithinItsRange) {
  std::set<std::string> names;
  for (const ChangedSetting& one : changed_settings("")) names.insert(one.name);
  EXPECT_GT(names.size(), 70U);
  const std::vector<ChangedSetting> share = changed_settings("explains");
  ASSERT_EQ(share.size(), 2U);
  EXPECT_EQ(share[0].text(), "explains=0.485");
  EXPECT_EQ(share[1].text(), "explains=1") << "twice is more than everything";
  EXPECT_EQ(changed_settings("adequate").size(), 2U);
  EXPECT_TRUE(changed_settings("no_such_number").empty());
}

TEST(Sensitivity, TellsTheResultsThatAreNotTheUsualOnes) {
  const test::TemporaryDirectory folder;
  const char* right = R"({"effect": "stiffness_drop", "confidence": 0.99, "location":
                          {"kind": "frame", "story": 1, "frame": "x1"}})";
  const char* wrong = R"({"effect": "cubic_stiffness", "confidence": 0.99, "location":
                          {"kind": "frame", "story": 1, "frame": "x1"}})";
  const std::string directory = folder.path("case");
  write_scored(directory, "out", right);
  write_scored(directory, "pays=0.475", right);
  write_scored(directory, "pays=1", wrong);
  write_scored(directory, "leads=0.45", "");
  const std::vector<std::string> all{directory};
  EXPECT_EQ(sensitivity_table(all, "pays"),
            "| number | usual | half | twice |\n| --- | --- | --- | --- |\n"
            "| `pays` | 0.95 | 0.475 | 1: stiffness_drop: cubic_stiffness, **confidently wrong** "
            "|\n");
  const std::string leads = sensitivity_table(all, "leads");
  EXPECT_NE(leads.find("| 0.45: stiffness_drop: nothing | 1 (1 not run) |"), std::string::npos)
      << leads;
}

}  // namespace
}  // namespace framewatch::study
