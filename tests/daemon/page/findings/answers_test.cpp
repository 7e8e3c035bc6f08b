// SPDX-License-Identifier: MIT
#include "daemon/page/findings/answers.h"

#include <cstdlib>

#include <gtest/gtest.h>

#include "daemon/monitor/event_report/report_words.h"
#include "daemon/monitor/events/change_words.h"
#include "daemon/monitor/events/event_messages.h"
#include "daemon/page/findings/finding.h"
#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace answers_test {

event_t event_of(const std::string& kind, const std::string& place, std::int32_t severity) {
  event_t e{};
  e.id = 7;
  e.since_us = 1'700'000'000'000'000;
  e.state = event_state::raised;
  e.severity = severity;
  e.kind = kind;
  e.place = place;
  e.message = place + " " + kind;
  return e;
}

class AnswersTest : public ::testing::Test {
 protected:
  AnswersTest() : config_(test::good(test::kGoodConfig)) {
    known_.samples = known_.estimates = true;
    known_.watched = known_.with_baseline = known_.observable = 4;
    known_.residual = 0.031;
    known_.followed_since_us = 5;
  }
  Answer answer(std::size_t i) const { return answers(known_, config_)[i]; }
  std::string said(std::size_t i) const {
    const Answer a = answer(i);
    std::string out = a.line.text;
    for (const AnswerLine& line : a.more) out += " | " + line.text;
    return out;
  }
  void find(event_t e, double value = 0, double error = 0) {
    e.value = value;
    e.std_error = error;
    known_.findings.push_back(finding_of(e, config_));
  }

  Config config_;
  Known known_;
};

TEST_F(AnswersTest, SaysWhetherAChangeLasts) {
  event_t e = event_of("stiffness_change", "kx_1_y1", severity::alarm);
  e.message +=
      ", since noon" + kAfterStrongMotion +
      "lost 9 % at the earthquake, 6 % after 1 hour, lasting: full recovery is excluded, at "
      "least 6 % stays";
  find(e, -9, 0.5);
  EXPECT_TRUE(known_.findings[0].text.ends_with(
      " After strong motion: lost 9 % at the earthquake, 6 % after 1 hour, lasting: full recovery "
      "is excluded, at least 6 % stays."))
      << known_.findings[0].text;
  EXPECT_NE(said(0).find("full recovery is excluded"), std::string::npos) << said(0);
}

TEST_F(AnswersTest, AQuietWholeBuildingNeedsNothing) {
  EXPECT_EQ(said(0), "No. None of 4 elements differs from its baseline.");
  EXPECT_EQ(said(1),
            "Yes. All 6 sensors send, and the model leaves 3.1 % of the motion unexplained.");
  EXPECT_EQ(said(2), "Nothing: no acceleration over 0.05 m/s².");
  EXPECT_EQ(said(3), "Nothing.");
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(answer(i).state, AnswerState::good) << i;
}

TEST_F(AnswersTest, SaysNothingBeforeSamplesCome) {
  known_ = {};
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(answer(i).state, AnswerState::wait) << said(i);
}

TEST_F(AnswersTest, JudgesNothingBeforeThereIsABaseline) {
  known_.with_baseline = 0;
  for (const std::size_t i : {0u, 3u}) EXPECT_EQ(answer(i).state, AnswerState::wait) << said(i);
}

TEST_F(AnswersTest, AChangeHasItsEventNumber) {
  find(event_of("stiffness_change", "kx_1_y2", severity::alarm), -14.83, 0.41);
  const Answer changed = answer(0);
  EXPECT_EQ(changed.question, "Is the building changed?");
  EXPECT_EQ(changed.state, AnswerState::bad);
  EXPECT_EQ(changed.line.since_us, 1'700'000'000'000'000);
  EXPECT_EQ(changed.line.text,
            "Yes. Story 1, frame y2 (kx_1_y2) has lost 14.8 % of its stiffness, give or take "
            "0.4 %: 36 times its uncertainty.");
  EXPECT_NE(said(3).find("structural engineer inspect story 1, frame y2"), std::string::npos);
  EXPECT_EQ(answer(3).state, AnswerState::bad);
}

TEST_F(AnswersTest, AnAcknowledgedEventStaysButAsksForNothing) {
  find(event_of("stiffness_change", "kx_1_y2", severity::alarm), -14.83, 0.41);
  known_.findings.back().acknowledged = true;
  known_.findings.back().who = "Ana";
  EXPECT_EQ(said(0).substr(0, 4), "Yes.");
  EXPECT_NE(said(0).find("Story 1, frame y2 (kx_1_y2) is acknowledged by Ana."), std::string::npos);
  EXPECT_EQ(answer(0).state, AnswerState::look);
  EXPECT_EQ(said(3), "Nothing.");
}

TEST_F(AnswersTest, FramesHaveTheLabelsThatPeopleGave) {
  config_.pipeline.structure.labels_x = {"south wall", "north wall"};
  find(event_of("stiffness_change", "kx_1_y2", severity::alarm), -14.83, 0.41);
  known_.findings.back().acknowledged = true;
  EXPECT_EQ(said(0).find("Yes. Story 1, north wall (kx_1_y2) has lost 14.8 %"), 0u) << said(0);
  EXPECT_NE(said(0).find("Story 1, north wall (kx_1_y2) is acknowledged."), std::string::npos);
  known_.findings.back().acknowledged = false;
  EXPECT_NE(said(3).find("structural engineer inspect story 1, north wall"), std::string::npos);
}

/// A gap alarm used to take the place of an unacknowledged damage.
TEST_F(AnswersTest, AGapDoesNotHideDamage) {
  find(event_of("stiffness_change", "kx_1_y2", severity::alarm), -14.83, 0.41);
  find(event_of("gap", "F1-Y1", severity::warning), 40);
  EXPECT_NE(said(0).find("14.8 %"), std::string::npos);
  EXPECT_NE(said(1).find("The model does not fit"), std::string::npos);
  EXPECT_EQ(answer(1).state, AnswerState::look);
  EXPECT_NE(answer(3).line.text.find("structural engineer"), std::string::npos);
  EXPECT_NE(said(3).find("framewatch diagnose"), std::string::npos);
}

TEST_F(AnswersTest, NamesADeadSensor) {
  find(event_of("channel_silent", "F1-Y1", severity::warning));
  EXPECT_TRUE(known_.findings.back().of_channel);
  EXPECT_EQ(answer(1).state, AnswerState::look);
  EXPECT_EQ(said(1), "Only in part. F1-Y1 channel_silent. | 5 of 6 sensors are good.");
  EXPECT_EQ(said(3), "Check the power, cable and mounting of sensor F1-Y1.");
  EXPECT_EQ(said(0).substr(0, 3), "No.");
}

TEST_F(AnswersTest, DoesNotTrustOldValues) {
  known_.silent_s = 75;
  EXPECT_EQ(said(1), "No: no samples for 1 min 15 s. The values shown are old.");
  EXPECT_NE(said(3).find("framewatch status"), std::string::npos);
  known_.silent_s = 0;
  known_.estimates_silent_s = 10;
  EXPECT_NE(said(1).find("there are no estimates for 10 s"), std::string::npos);
}

TEST_F(AnswersTest, NamesTheStoriesOfATallBuildingThatSwayedMost) {
  constexpr int kStories = 12, kMax = 7;
  estimator::Structure& s = config_.pipeline.structure;
  s.stories = kStories;
  s.story_height.assign(kStories, 3.0);
  Shake shake;
  shake.over = true;
  shake.peak = {config_.pipeline.axes.size(), static_cast<std::size_t>(s.degrees_of_freedom())};
  for (int story = 1; story <= kStories; ++story)
    shake.peak.drift_m[static_cast<std::size_t>(s.dof(story, 0))] =
        0.03 / (1 + std::abs(story - kMax));
  known_.newest = known_.strongest = &shake;
  const Answer told = answer(2);
  ASSERT_GE(told.more.size(), 7U);
  EXPECT_EQ(told.more[0].text.substr(0, 17), "Story 7: 1.00 % (");
  EXPECT_EQ(told.more[1].text.substr(0, 8), "Story 8:");
  EXPECT_EQ(told.more[2].text.substr(0, 8), "Story 6:");
  EXPECT_EQ(told.more[5].text, "The other 7 stories swayed less.");
}

TEST_F(AnswersTest, ReportsAShakeByStoryWithItsBaseShear) {
  Shake shake;
  shake.from_us = 1'000'000;
  shake.to_us = 9'000'000;
  shake.over = true;
  shake.peak = {config_.pipeline.axes.size(), 4};
  shake.peak.base_shear_n = {1234, 56};
  shake.peak.accel_mps2 = {1.2, 0.1, 3.1, 3.4, 0.2, 0.2};
  shake.peak.drift_m = {0.0011, 0.0021, 0, 0};
  known_.newest = known_.strongest = &shake;
  EXPECT_EQ(
      said(2),
      "A shake: a story swayed by up to 0.210 % of its height (drift ratio); the force at the base "
      "(shear) was up to 1.23 kN along x, 56 N along y. | Story 1: 0.210 % (2.10 mm) in frame y2 | "
      "Peak acceleration of the ground 1.20 m/s², of the floors 3.40 m/s²");
  EXPECT_EQ(answer(2).line.since_us, 1'000'000);
  EXPECT_EQ(answer(2).line.until_us, 9'000'000);
  shake.peak = {config_.pipeline.axes.size(), 4};
  EXPECT_EQ(said(2).substr(0, 74),
            "A shake: how far its stories swayed is not known; the force at the base (s");
}

TEST_F(AnswersTest, JudgesAShakeByItsReport) {
  Shake shake;
  shake.from_us = 1'000'000;
  shake.to_us = 9'000'000;
  shake.over = true;
  shake.peak = {config_.pipeline.axes.size(), 4};
  known_.newest = known_.strongest = &shake;
  known_.report = {"event-20261124T000000Z", EventColor::red, "story 1 drifted by 2 %", 2'000'000,
                   8'000'000};
  EXPECT_EQ(answer(2).state, AnswerState::bad);
  EXPECT_EQ(answer(2).more.front().text, "Judged red: story 1 drifted by 2 %.");
  EXPECT_EQ(answer(2).more.front().report, "event-20261124T000000Z");
  known_.report->color = EventColor::green;
  EXPECT_EQ(answer(2).state, AnswerState::good);
  known_.newest = known_.strongest = nullptr;  // the page's server was restarted
  EXPECT_EQ(answer(2).more.front().text,
            "The last strong motion was judged green: story 1 drifted by 2 %.");
  EXPECT_EQ(answer(2).more.front().since_us, 2'000'000);
  EXPECT_EQ(answer(2).more.front().report, "event-20261124T000000Z");
}

TEST_F(AnswersTest, AsksForInspectionUnlessTheReportIsGreen) {
  event_t e = event_of("strong_motion", "story 1", severity::alarm);
  e.message = "after strong motion: red, story 1 drifted by 2 %; report event-x.html";
  find(e);
  EXPECT_EQ(known_.findings[0].text, "after strong motion: red, story 1 drifted by 2 %.");
  EXPECT_NE(said(3).find("structural engineer inspect the building"), std::string::npos);
  EXPECT_EQ(said(0).substr(0, 3), "No.");
  EXPECT_EQ(said(1).substr(0, 4), "Yes.");
}

TEST(FindingWords, WriteForcesAndPercentsLikeAnEngineer) {
  EXPECT_EQ(force_words(999.7), "1 kN");
  EXPECT_EQ(force_words(1.234e7), "12.3 MN");
  EXPECT_EQ(percent_words(0.1483, 0.0041), "14.8 %");
  EXPECT_EQ(percent_words(0.1483, 0.02), "15 %");
  EXPECT_EQ(percent_words(0.0823, 0.0003), "8.23 %");
}

TEST(ModelFit, ReportsWhenMostOfTheMotionIsUnexplainedUntilItEnds) {
  ModelFit fit;
  window_estimate_t e{};
  e.status = 1;
  e.reason = {0};
  double t = 0;
  const auto last = [&](double residual, double seconds) {
    for (const double end = t + seconds; t < end; t += 0.1) {
      e.window_end_us = static_cast<std::int64_t>(1e6 * t);
      e.residual_ratio = residual;
      fit.push(e);
    }
  };
  last(0.05, 30);
  EXPECT_FALSE(fit.finding());
  EXPECT_NEAR(fit.residual().value_or(0), 0.05, 1e-3);
  last(0.9, 3);  // a moment is not silence
  EXPECT_FALSE(fit.finding());
  last(0.8, 30);
  ASSERT_TRUE(fit.finding());
  EXPECT_NE(fit.finding()->text.find("does not fit"), std::string::npos);
  e.reason = {2};  // unobservable elements are not mentioned
  last(0.0, 100);
  EXPECT_TRUE(fit.finding());
  e.reason = {0};
  last(0.05, 60);
  EXPECT_FALSE(fit.finding());
}

}  // namespace answers_test
}  // namespace framewatch::daemon
