#include "daemon/monitor/history/summary_export.h"

#include <algorithm>
#include <cmath>
#include <map>

#include <fmt/core.h>

#include "daemon/base/mat_file.h"
#include "daemon/base/utc_time.h"
#include "daemon/monitor/history/history_files.h"
#include "drivers/files/number_text.h"
#include "drivers/files/text_output.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

struct Column {
  const char* name;
  double (*value)(const SummaryRow&);
};

constexpr Column kColumns[] = {
    {"windows", [](const SummaryRow& r) { return static_cast<double>(r.windows); }},
    {"observable", [](const SummaryRow& r) { return static_cast<double>(r.observable); }},
    {"mean", [](const SummaryRow& r) { return r.mean; }},
    {"std_error", [](const SummaryRow& r) { return r.std_error; }},
    {"min", [](const SummaryRow& r) { return r.min; }},
    {"whisker_low", [](const SummaryRow& r) { return r.whisker_low; }},
    {"q1", [](const SummaryRow& r) { return r.q1; }},
    {"median", [](const SummaryRow& r) { return r.median; }},
    {"q3", [](const SummaryRow& r) { return r.q3; }},
    {"whisker_high", [](const SummaryRow& r) { return r.whisker_high; }},
    {"max", [](const SummaryRow& r) { return r.max; }},
    {"outliers", [](const SummaryRow& r) { return static_cast<double>(r.outliers); }},
};

std::string write_csv(const std::string& path, std::int64_t period_s,
                      const std::vector<NamedSummaries>& summaries) {
  drivers::TextOutput out;
  std::string line = "start,start_s,period_s,parameter,unit";
  for (const Column& column : kColumns) line += fmt::format(",{}", column.name);
  bool good = out.open(path) && out.write(line + "\n");
  for (const NamedSummaries& s : summaries)
    for (const SummaryRow& row : s.rows) {
      line = fmt::format("{},{},{},{},{}", utc_text(row.start_us), row.start_us / 1'000'000,
                         period_s, s.parameter.name, s.parameter.unit);
      for (const Column& column : kColumns) {
        const double value = column.value(row);
        line += ',';
        if (std::isfinite(value)) line += drivers::format_number(value);
      }
      good = good && out.write(line + "\n");
    }
  return good && out.close() ? "" : fmt::format("{}: {}", path, out.error());
}

std::string write_mat(const std::string& path, std::int64_t period_s,
                      const std::vector<NamedSummaries>& summaries) {
  std::map<std::int64_t, std::size_t> row_of;
  for (const NamedSummaries& s : summaries)
    for (const SummaryRow& row : s.rows) row_of[row.start_us];
  std::vector<double> start_s;
  for (auto& [start_us, at] : row_of) {
    at = start_s.size();
    start_s.push_back(1e-6 * static_cast<double>(start_us));
  }
  const std::size_t cells = start_s.size() * summaries.size();
  if (cells * sizeof(double) > MatFile::kMaxBytes)
    return path + ": a variable of a MATLAB 5 file holds at most 2 GiB: a shorter time, please";
  std::vector<std::string> names, units;
  for (const NamedSummaries& s : summaries) {
    names.push_back(s.parameter.name);
    units.push_back(s.parameter.unit);
  }
  const std::string problem = write_mat_file(path, [&](MatFile& file) {
    bool good = file.texts("parameter", names) && file.texts("unit", units) &&
                file.matrix("period_s", {static_cast<double>(period_s)}, 1) &&
                file.matrix("start_s", start_s, 1);
    for (const Column& column : kColumns) {
      std::vector<double> values(cells, estimator::kNaN);
      for (std::size_t p = 0; p < summaries.size(); ++p)
        for (const SummaryRow& row : summaries[p].rows)
          values[row_of[row.start_us] * summaries.size() + p] = column.value(row);
      good = good && file.matrix(column.name, values, summaries.size());
    }
    return good;
  });
  return problem.empty() ? "" : fmt::format("{}: {}", path, problem);
}

}  // namespace

std::string write_summaries(const std::string& path, std::int64_t period_s,
                            const std::vector<NamedSummaries>& summaries) {
  return path.ends_with(".mat") ? write_mat(path, period_s, summaries)
                                : write_csv(path, period_s, summaries);
}

}  // namespace framewatch::daemon
