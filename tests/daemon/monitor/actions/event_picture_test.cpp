// SPDX-License-Identifier: MIT
// Tests the plot that an e-mail attaches, on a history of 40 days.
#include "daemon/monitor/actions/event_picture.h"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "daemon/base/clocks.h"
#include "daemon/monitor/history/summary_store.h"
#include "tests/daemon/monitor/actions/example_event.h"
#include "tests/support/temporary.h"

namespace framewatch::daemon {
namespace event_picture_test {

constexpr std::int64_t kHourOfPlot_us = 3600 * kSecond_us;
constexpr double kUsual = 5e8;

/// One hour of a history: the time since the event and the value of kx_1_y1.
struct Hour {
  std::int64_t at_us;
  double value;
};

class EventPictureTest : public testing::Test {
 protected:
  EventPictureTest() {
    settings_.directory = directory_.path("h");
    settings_.summary_s = {3600};
    // At midnight, so that hours of the history begin when those of the plot do.
    event_.time_us = 20'000 * kDay_us;
    event_.since_us = event_.time_us - kDay_us;
  }
  void store(const std::vector<Hour>& hours) {
    SummaryStore store(settings_);
    ASSERT_EQ(store.open(), "");
    SummaryBatch batch;
    batch.parameters.name = {"kx_1_y1"};
    batch.parameters.unit = {"N/m"};
    batch.parameters.kind = {0};
    batch.parameters.story = {1};
    for (const Hour& hour : hours) {
      PeriodData data;
      data.start_us = event_.time_us + hour.at_us;
      data.last_us = data.start_us + 1;
      data.windows = 1;
      data.parameters.resize(1);
      ParameterData& d = data.parameters.front();
      d.observable = 1;
      d.sum = d.min = d.max = hour.value;
      d.box = {hour.value};
      batch.periods.push_back(data);
    }
    ASSERT_EQ(store.add(batch), "");
  }
  /// Returns the points of a series, "days,percent" each.
  std::vector<std::string> points(const std::string& series) {
    SummaryQuery summaries;
    EXPECT_EQ(summaries.open(settings_.directory), "");
    const auto plot = parameter_plot(summaries, event_);
    std::vector<std::string> out;
    if (!plot) return out;
    std::istringstream lines(plot->csv());
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(series + ",")) out.push_back(line.substr(series.size() + 1));
    return out;
  }

  const test::TemporaryDirectory directory_;
  HistorySettings settings_;
  event_t event_ = event(7);
};

TEST_F(EventPictureTest, ShowsThePercentOf30DaysAndBreaksTheLineInAGap) {
  std::vector<Hour> hours{{-40 * kDay_us, 3 * kUsual}};
  for (std::int64_t at_us = -4 * kHourOfPlot_us; at_us < 0; at_us += kHourOfPlot_us)
    hours.push_back({at_us - 6 * kDay_us, kUsual});
  hours.push_back({-kHourOfPlot_us * 6, 0.9 * kUsual});
  store(hours);
  const std::vector<std::string> median = points("median");
  EXPECT_EQ(median, (std::vector<std::string>{"-6.16666667,0", "-6.125,0", "-6.08333333,0",
                                              "-6.04166667,0", "-0.25,", "-0.25,-10"}));
  EXPECT_EQ(points("quartiles"), median);
  EXPECT_EQ(points("since"), (std::vector<std::string>{"-1,-10", "-1,1"}));
}

TEST_F(EventPictureTest, ASteadyParameterHasAnAxisOfTwoPercent) {
  store({{-2 * kHourOfPlot_us, kUsual}, {-kHourOfPlot_us, kUsual}});
  EXPECT_EQ(points("since"), (std::vector<std::string>{"-1,-1", "-1,1"}));
}

TEST_F(EventPictureTest, IsPngAndSvgOnlyWithoutLibrsvg) {
  store({{-2 * kHourOfPlot_us, kUsual}, {-kHourOfPlot_us, 0.9 * kUsual}});
  const auto attached = event_picture({settings_.directory, ""}, event_, never);
  ASSERT_TRUE(attached);
  std::string problem;
  if (SvgConverter::load(problem)) {
    EXPECT_EQ(attached->name, "kx_1_y1.png");
    EXPECT_EQ(attached->type, "image/png");
    EXPECT_TRUE(attached->bytes.starts_with("\x89PNG\r\n"));
    EXPECT_NE(attached->bytes.find("IEND"), std::string::npos);
  }
  SummaryQuery summaries;
  ASSERT_EQ(summaries.open(settings_.directory), "");
  const EmailAttachment svg = as_picture(*parameter_plot(summaries, event_), "a", std::nullopt);
  EXPECT_EQ(svg.name, "a.svg");
  EXPECT_EQ(svg.type, "image/svg+xml");
  EXPECT_NE(svg.bytes.find("change of kx_1_y1"), std::string::npos);
  EXPECT_TRUE(svg.bytes.ends_with("</svg>\n"));
}

TEST_F(EventPictureTest, NothingStoredGivesNoAttachment) {
  EXPECT_FALSE(event_picture({"", ""}, event_, never));
  EXPECT_FALSE(event_picture({settings_.directory, ""}, event_, never));  // no database
  store({});
  EXPECT_FALSE(event_picture({settings_.directory, ""}, event_, never));
  store({{-40 * kDay_us, kUsual}});
  EXPECT_FALSE(event_picture({settings_.directory, ""}, event_, never));
  store({{-kHourOfPlot_us, kUsual}});
  EXPECT_TRUE(event_picture({settings_.directory, ""}, event_, never));
  event_.place = "F1-Y1";
  EXPECT_FALSE(event_picture({settings_.directory, ""}, event_, never));
}

TEST_F(EventPictureTest, TakesThePageOfAReportButNoFileElsewhere) {
  store({{-kHourOfPlot_us, kUsual}});
  const EventSources sources{settings_.directory, directory_.path("")};
  const auto name_of = [&](const std::string& segment) {
    event_.segment = segment;
    return event_picture(sources, event_, never).value_or(EmailAttachment{}).name;
  };
  const std::string page = "event-20261128T140654Z.html";
  test::write_file(directory_.path(page), "<p>strong</p>");
  test::write_file(directory_.path("login.html"), "secret");
  EXPECT_EQ(name_of(page), page);
  for (const std::string other :
       {"login.html", "../login.html", "h/../event-20261128T140654Z.html"})
    EXPECT_TRUE(name_of(other).starts_with("kx_1_y1.")) << other;
}

}  // namespace event_picture_test
}  // namespace framewatch::daemon
