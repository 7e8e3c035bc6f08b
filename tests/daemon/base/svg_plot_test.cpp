// SPDX-License-Identifier: MIT
#include "daemon/base/svg_plot.h"

#include <cmath>

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
  plot.add({"a", 0, SvgMark::line, {0, 1, 2, 3, 4}, {0, 1, estimator::kNaN, 1, 0}});
  EXPECT_EQ(count(plot.svg(), "<polyline"), 2);
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

TEST(SvgPlot, PageLoadsNothing) {
  const std::string page = html_page("t", "");
  for (const char* part : {"http", "src=", "<script", "@import", "url("})
    EXPECT_EQ(page.find(part), std::string::npos) << part;
  for (const char* part : {"prefers-color-scheme", "@media print"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
}

}  // namespace svg_plot_test
}  // namespace framewatch::daemon
