#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/core.h>

#include "daemon/base/html_page.h"
#include "daemon/base/svg_plot.h"
#include "daemon/tools/report/session_report.h"

namespace framewatch::daemon {
namespace {

std::string in_percent(double ratio) {
  return std::isfinite(ratio) ? fmt::format("{:.1f}", 100 * ratio) : "-";
}

/// Values over the height of the building, measured floors marked.
std::string over_height(const SessionFloors& floors, const estimator::Structure& s,
                        const char* title, const char* unit, bool drift) {
  SvgPlot plot(title, {unit, 0}, {"floor", 0, s.stories + 0.5}, 485, 480);
  for (const int along : {0, 1}) {
    if ((along == 0 ? s.n() : s.m()) == 0) continue;
    SvgSeries line{along == 0 ? "along x" : "along y", along, SvgMark::line, {}, {}};
    SvgSeries dots{"", along, SvgMark::dots, {}, {}};
    for (int floor = drift ? 1 : 0; floor <= s.stories; ++floor) {
      const auto at = static_cast<std::size_t>(floor), d = static_cast<std::size_t>(along);
      const double value =
          drift ? 100 * peak_drift_ratio(floors, s, floor, along) : floors.peak_accel_mps2[at][d];
      line.x.push_back(value);
      line.y.push_back(drift ? floor - 0.5 : floor);
      if (drift || !floors.measured[at][d]) continue;
      dots.x.push_back(value);
      dots.y.push_back(floor);
    }
    plot.add(std::move(line));
    plot.add(std::move(dots));
  }
  return plot.svg();
}

std::string left_out_table(const SessionFloors& floors) {
  std::vector<std::vector<std::string>> rows;
  for (const estimator::LeftOutFloor& one : floors.left_out)
    rows.push_back({fmt::format("floor {}, {}", one.floor, letter(one.direction)),
                    in_percent(one.low_error), in_percent(one.error), in_percent(one.low_spline),
                    in_percent(one.spline)});
  return html_table({"left out", "error below 5 Hz, %", "error, %", "of a spline below 5 Hz, %",
                     "of a spline, %"},
                    rows);
}

std::string largest_error(const SessionFloors& floors) {
  double least = std::numeric_limits<double>::infinity(), most = 0;
  for (const estimator::LeftOutFloor& one : floors.left_out) {
    if (!std::isfinite(one.low_error)) continue;
    least = std::min(least, one.low_error);
    most = std::max(most, one.low_error);
  }
  if (!(most > 0)) return "";
  return fmt::format(
      " Left out in turn, measured floors are missed by {:.0f} to {:.0f} % below "
      "5 Hz: expect no better of floors without a channel.",
      100 * least, 100 * most);
}

}  // namespace

std::string floors_section(const SessionReport& r) {
  if (!r.floors) return "";
  const SessionFloors& floors = *r.floors;
  const estimator::Structure& s = r.config->pipeline.structure;
  std::string out =
      "<h2>Every floor</h2>\n" +
      html_figure({over_height(floors, s, "peak acceleration", "m/s^2", false),
                   over_height(floors, s, "peak story drift", "% of the story height", true)},
                  fmt::format("Dots: floors with a channel; the others are computed from the "
                              "measured floors above and below them, by what was identified.{}",
                              largest_error(floors)));
  std::vector<std::vector<std::string>> rows;
  const auto cells = [](double value, const char* format) {
    return std::isfinite(value) ? fmt::format(fmt::runtime(format), value) : "-";
  };
  for (int floor = s.stories; floor >= 0; --floor) {
    std::vector<std::string> row{floor > 0 ? fmt::format("floor {}", floor) : "base"};
    for (const int along : {0, 1}) {
      if ((along == 0 ? s.n() : s.m()) == 0) continue;
      const auto at = static_cast<std::size_t>(floor), d = static_cast<std::size_t>(along);
      row.push_back(floors.measured[at][d] ? "measured" : "computed");
      row.push_back(cells(floors.peak_accel_mps2[at][d], "{:.3f}"));
      row.push_back(floor > 0 ? cells(100 * peak_drift_ratio(floors, s, floor, along), "{:.4f}")
                              : "-");
    }
    rows.push_back(std::move(row));
  }
  std::vector<std::string> head{""};
  for (const char* along : {"x", "y"}) {
    if ((*along == 'x' ? s.n() : s.m()) == 0) continue;
    for (const char* what : {"", " acceleration, m/s^2", " drift of the story below, %"})
      head.push_back(along + std::string(what));
  }
  out += html_table(head, rows);
  if (floors.left_out.empty()) return out;
  return out + "<h3>Measured floors left out in turn</h3>\n" + left_out_table(floors) +
         fmt::format(
             "<p>Each is predicted from all other floors by the stiffnesses identified in "
             "the strong motion ({:.1f} s to {:.1f} s, 5 to 95 % of the Arias intensity at "
             "the top), rms of the error over rms of the motion. The spline goes through "
             "the other floors; where a channel is one story away it may do as well.</p>\n",
             session_seconds(r, floors.from_us), session_seconds(r, floors.to_us));
}

}  // namespace framewatch::daemon
