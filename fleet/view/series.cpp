#include "fleet/view/series.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "daemon/base/clocks.h"
#include "fleet/view/rows.h"

namespace framewatch::fleet {
namespace {

using daemon::kSecond_us;
using nlohmann::json;

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

struct Point {
  std::int64_t t_us = 0, windows = 0;
  double median = kNone, q1 = kNone, q3 = kNone, std_error = kNone;
};

// The place of a parameter depends on the configuration that the period was identified with: it is
// looked up once for each.
constexpr const char* kPoints =
    "SELECT start_us, n[i], median[i], q1[i], q3[i], std_error[i], unit FROM ("
    " SELECT config AS of, unit[array_position(name, $2)], array_position(name, $2) AS i"
    " FROM parameters WHERE building = (SELECT id FROM building WHERE name = $1) OFFSET 0) p"
    " JOIN summary s ON s.config = p.of"
    " WHERE i IS NOT NULL AND s.building = (SELECT id FROM building WHERE name = $1)"
    " AND s.period_s = $3 AND s.start_us >= $4 AND s.start_us < $5 ORDER BY start_us";
constexpr const char* kLengths =
    "SELECT p FROM unnest(ARRAY[60, 600, 3600]) p WHERE EXISTS (SELECT 1 FROM summary"
    " WHERE building = (SELECT id FROM building WHERE name = $1) AND period_s = p"
    " AND start_us >= $2 AND start_us < $3) ORDER BY p";

/// The finest period that is there and gives no more points than can be drawn; else the longest.
int best_period(Database& database, const SeriesRequest& r) {
  const auto rows =
      database.query(kLengths, {r.building, std::to_string(r.from_us), std::to_string(r.to_us)});
  if (!rows || rows->empty()) return 600;
  for (const Database::Row& row : *rows)
    if ((r.to_us - r.from_us) / (integer_at(row, 0) * kSecond_us) <=
        static_cast<std::int64_t>(SeriesRequest::kMaxPoints))
      return static_cast<int>(integer_at(row, 0));
  return static_cast<int>(integer_at(rows->back(), 0));
}

Point joined(const std::vector<Point>& points, std::size_t from, std::size_t to) {
  Point out{points[from].t_us, 0, kNone, kNone, kNone, kNone};
  std::vector<double> medians;
  double squares = 0;
  for (std::size_t i = from; i < to; ++i) {
    const Point& p = points[i];
    out.windows += p.windows;
    if (std::isnan(p.median)) continue;
    medians.push_back(p.median);
    squares += p.std_error * p.std_error;
    out.q1 = std::isnan(out.q1) ? p.q1 : std::min(out.q1, p.q1);
    out.q3 = std::isnan(out.q3) ? p.q3 : std::max(out.q3, p.q3);
  }
  if (medians.empty()) return out;
  const auto middle = medians.begin() + static_cast<std::ptrdiff_t>(medians.size() / 2);
  std::nth_element(medians.begin(), middle, medians.end());
  out.median = *middle;
  out.std_error = std::sqrt(squares / static_cast<double>(medians.size()));
  return out;
}

}  // namespace

std::string series_json(Database& database, const SeriesRequest& r) {
  const int period_s = r.period_s > 0 ? r.period_s : best_period(database, r);
  const auto rows = database.query(kPoints, {r.building, r.parameter, std::to_string(period_s),
                                             std::to_string(r.from_us), std::to_string(r.to_us)});
  if (!rows) return json{{"problem", database.error()}}.dump();
  std::vector<Point> points;
  std::string unit;
  for (const Database::Row& row : *rows) {
    Point p{integer_at(row, 0), integer_at(row, 1), kNone, kNone, kNone, kNone};
    if (p.windows > 0) {
      p.median = number_at(row, 2).value_or(kNone);
      p.q1 = number_at(row, 3).value_or(kNone);
      p.q3 = number_at(row, 4).value_or(kNone);
      p.std_error = number_at(row, 5).value_or(kNone);
    }
    unit = text_at(row, 6);
    points.push_back(p);
  }
  const std::size_t of = points.size() / SeriesRequest::kMaxPoints + 1;
  json t = json::array(), windows = t, median = t, q1 = t, q3 = t, error = t;
  for (std::size_t from = 0; from < points.size(); from += of) {
    const Point p =
        of == 1 ? points[from] : joined(points, from, std::min(from + of, points.size()));
    t.push_back(p.t_us);
    windows.push_back(p.windows);
    median.push_back(p.median);
    q1.push_back(p.q1);
    q3.push_back(p.q3);
    error.push_back(p.std_error);
  }
  return json{{"period_s", period_s}, {"of", of},         {"unit", unit}, {"t_us", t},
              {"windows", windows},   {"median", median}, {"q1", q1},     {"q3", q3},
              {"std_error", error}}
      .dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace framewatch::fleet
