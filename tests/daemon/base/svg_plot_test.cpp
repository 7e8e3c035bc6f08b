// SPDX-License-Identifier: MIT
#include "daemon/base/svg_plot.h"

#include <cmath>
#include <cstdio>
#include <utility>

#include <fmt/core.h>
#include <gtest/gtest.h>

#include "daemon/base/html_page.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace svg_plot_test {

std::vector<std::string> labels(const SvgAxis& axis, int wanted) {
  std::vector<std::string> out;
  for (const SvgTick& tick : ticks(axis, wanted)) out.push_back(tick.label);
  return out;
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (auto at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(SvgAxis, TicksAreRound) {
  EXPECT_EQ(labels({"", 0, 10}, 5), (std::vector<std::string>{"0", "2", "4", "6", "8", "10"}));
  EXPECT_EQ(labels({"", -0.13, 0.12}, 5),
            (std::vector<std::string>{"-0.10", "-0.05", "0.00", "0.05", "0.10"}));
  EXPECT_EQ(labels({"", 0.05, 2000, true}, 6),
            (std::vector<std::string>{"0.1", "1", "10", "100", "1000"}));
}

TEST(SvgAxis, EndsComeFromFiniteValues) {
  const SvgAxis axis = fitted({"x"}, {estimator::kNaN, 2, INFINITY, 4});
  EXPECT_LT(axis.low, 2);
  EXPECT_GT(axis.low, 1.5);
  EXPECT_GT(axis.high, 4);
  EXPECT_GT(fitted({"x"}, {}).high, fitted({"x"}, {}).low);
  EXPECT_GT(fitted({"x"}, {3, 3}).high, 3);
  const SvgAxis decades = fitted({"x", estimator::kNaN, estimator::kNaN, true}, {-1, 0, 1, 100});
  EXPECT_GT(decades.low, 0);
  EXPECT_TRUE(std::isnan(position(decades, 0)));
}

TEST(SvgPlot, NanBreaksALine) {
  SvgPlot plot("", {"x"}, {"y"});
  plot.add({"", 0, SvgMark::line, {0, 1, 2, 3, 4}, {0, 1, estimator::kNaN, 1, 0}});
  EXPECT_EQ(count(plot.svg(), "<polyline"), 2);
}

TEST(SvgPlot, WithoutAxesASquareIsDrawnAsASquare) {
  for (const auto& [width, height] : {std::pair(600, 200), std::pair(200, 600)}) {
    SvgPlot plot("", {"x"}, {"y"}, width, height);
    plot.leave_out_axes();
    plot.add({"", 0, SvgMark::line, {0, 3, 3}, {0, 0, 3}});
    const std::string svg = plot.svg();
    const std::size_t at = svg.find("points=\"");
    double x1 = 0, y1 = 0, x2 = 0, y2 = 0, x3 = 0, y3 = 0;
    ASSERT_NE(at, std::string::npos);
    ASSERT_EQ(std::sscanf(svg.c_str() + at, "points=\"%lf,%lf %lf,%lf %lf,%lf", &x1, &y1, &x2, &y2,
                          &x3, &y3),
              6);
    EXPECT_GT(x2 - x1, 100);
    EXPECT_NEAR(x2 - x1, y2 - y3, 0.2);
    EXPECT_EQ(count(svg, "<text"), 0);
  }
}

TEST(SvgPlot, LongLinesKeepTheirExtremesAndStaySmall) {
  constexpr std::size_t kMaxBytes = 60'000;
  std::vector<double> x, y;
  for (int i = 0; i < 500'000; ++i) {
    x.push_back(i);
    y.push_back(i == 123'456 ? 7 : std::sin(0.1 * i));
  }
  SvgPlot plot("", {"x", 0, 500'000}, {"y", -10, 10}, 640, 280);
  plot.add({"", 0, SvgMark::line, x, y});
  const std::string svg = plot.svg();
  EXPECT_LT(svg.size(), kMaxBytes);
  SvgPlot without("", {"x", 0, 500'000}, {"y", -10, 10}, 640, 280);
  y[123'456] = 0;
  without.add({"", 0, SvgMark::line, x, y});
  EXPECT_NE(svg, without.svg());
}

TEST(SvgPlot, EmptyAndImpossibleInputDrawsOnlyAFrame) {
  SvgPlot plot("nothing", {"x"}, {"y"});
  plot.add({"a", 0, SvgMark::dots, {estimator::kNaN, 1}, {1, INFINITY}});
  plot.add(SvgBox{1, {}, {}, 0});
  const std::string svg = plot.svg();
  EXPECT_EQ(svg.find("nan"), std::string::npos);
  EXPECT_EQ(svg.find("inf"), std::string::npos);
}

TEST(SvgPlot, TextIsNotMarkup) {
  SvgPlot plot("a < b & \"c\"", {"<x>"}, {"y"});
  plot.add({"<script>", 0, SvgMark::line, {0, 1}, {0, 1}});
  const std::string page = html_page("<t>", plot.svg());
  EXPECT_EQ(page.find("<script"), std::string::npos);
  EXPECT_NE(page.find("a &lt; b &amp; &quot;c&quot;"), std::string::npos);
  EXPECT_NE(page.find("<title>&lt;t&gt;</title>"), std::string::npos);
}

/// Returns the brightness in gray, 0 to 255 (ITU-R BT.601), of a color like "#00457c".
double gray(const std::string& color) {
  const auto part = [&](std::size_t at) { return std::stoi(color.substr(at, 2), nullptr, 16); };
  return 0.299 * part(1) + 0.587 * part(3) + 0.114 * part(5);
}

TEST(SvgPlot, DocumentKeepsSeriesApartInGray) {
  constexpr double kLeast = 30;  // of 255
  SvgPlot plot("title", {"x"}, {"y"});
  for (int color = 0; color < 4; ++color) plot.add({"s", color, SvgMark::line, {0, 1}, {0, 1}});
  const std::string document = plot.document(85);
  for (const char* part : {"var(", "currentColor", "system-ui", ">title</text>"})
    EXPECT_EQ(document.find(part), std::string::npos) << part;
  EXPECT_NE(document.find("width=\"85.00mm\""), std::string::npos);
  // Lines of stages (0, 1) beside a reference (6) or a pale error (5), bars of 4, 6, 0, 1.
  std::vector<double> brightness;
  for (int color = 0; color < 7; ++color) {
    const std::string rule = fmt::format(".plot .s{}{{stroke:", color);
    brightness.push_back(gray(document.substr(document.find(rule) + rule.size(), 7)));
  }
  for (const std::vector<std::size_t>& together :
       {std::vector<std::size_t>{0, 1, 4, 6}, {0, 5}, {0, 1, 6}, {0, 1, 3}, {1, 2, 3}})
    for (const std::size_t a : together)
      for (const std::size_t b : together)
        EXPECT_TRUE(a >= b || std::abs(brightness[a] - brightness[b]) >= kLeast) << a << " " << b;
  EXPECT_EQ(count(document, "stroke-dasharray:7 2}"), 1);
}

TEST(SvgPlot, CsvHasWhatIsDrawn) {
  SvgPlot lines("", {"time, s"}, {"force, kN"});
  lines.add({"a, b", 0, SvgMark::line, {0, 0.5}, {1, estimator::kNaN}, {0.25, 0.5}});
  lines.add({"", 1, SvgMark::line, {2}, {3}, {}, "told"});
  EXPECT_EQ(lines.csv(),
            "series,time (s),force (kN),standard error\n\"a, b\",0,1,0.25\n\"a, b\",0.5,,0.5\n"
            "told,2,3,\n");
  SvgAxis names{""};
  names.categories = {"story 1, north wall", "story 2"};
  SvgPlot box("", names, {"stiffness, MN/m"});
  estimator::BoxplotStatistics s{};
  s.count = 9;
  s.whisker_low = 1;
  s.q1 = 2;
  s.median = 3;
  s.q3 = 4;
  s.whisker_high = 5;
  box.add({"forced", 0, SvgMark::line, {estimator::kNaN}, {estimator::kNaN}});
  box.add(SvgBox{1.2, s, {7}, 0});
  EXPECT_EQ(box.csv(),
            "series,x,stiffness (MN/m),statistic\n"
            "forced,\"story 1, north wall\",1,lower whisker\n"
            "forced,\"story 1, north wall\",2,lower quartile\n"
            "forced,\"story 1, north wall\",3,median\n"
            "forced,\"story 1, north wall\",4,upper quartile\n"
            "forced,\"story 1, north wall\",5,upper whisker\n"
            "forced,\"story 1, north wall\",7,outlier\n");
}

TEST(SvgPlot, BarsDoNotOverlapInANarrowPicture) {
  SvgPlot plot("", {"x", 0, 41}, {"y"});
  SvgSeries bars{"", 0, SvgMark::bars, {}, {}};
  for (int i = 1; i <= 40; ++i) {
    bars.x.push_back(i);
    bars.y.push_back(1);
  }
  plot.add(bars);
  const std::string document = plot.document(40);
  const auto number_after = [&](const char* word, std::size_t from) {
    return std::stod(document.substr(document.find(word, from) + std::string(word).size()));
  };
  const std::size_t first = document.find("<rect class=\"f0\""),
                    second = document.find("<rect class=\"f0\"", first + 1);
  EXPECT_LT(number_after("width=\"", first),
            number_after("x=\"", second) - number_after("x=\"", first));
}

TEST(SvgPlot, ValuesBesideTheXAxisDoNotStretchTheYAxis) {
  SvgPlot plot("", {"x", 0, 1}, {"y"});
  plot.add({"", 0, SvgMark::line, {0, 1, 2}, {1, 2, 1e6}});
  EXPECT_EQ(plot.svg().find("1000000"), std::string::npos);
  EXPECT_EQ(plot.svg().find("500000"), std::string::npos);
}

TEST(SvgPlot, PageLoadsNothing) {
  const std::string page = html_page("t", "");
  for (const char* part : {"http", "src=", "<script", "@import", "url("})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  for (const char* part : {"prefers-color-scheme", "@media print"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

}  // namespace svg_plot_test
}  // namespace framewatch::daemon
