#include "daemon/monitor/estimates/estimates_mat.h"

#include <limits>

#include "daemon/base/mat_file.h"
#include "daemon/monitor/estimates/estimates_csv.h"

namespace framewatch::daemon {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

}  // namespace

bool EstimatesMatWriter::open(const std::string& path, const std::vector<std::string>& names,
                              const std::vector<std::string>& units, bool boxplot) {
  names_ = names;
  units_ = units;
  boxplot_ = boxplot;
  for (const char* name : {"value", "std_error", "observable"}) columns_.push_back({name, {}});
  if (boxplot)
    for (const char* name : {"q1", "median", "q3", "whisker_low", "whisker_high", "outliers"})
      columns_.push_back({name, {}});
  // So that a folder that is not there is told before the work.
  if (out_.open(path)) return true;
  error_ = out_.error();
  return false;
}

bool EstimatesMatWriter::write(const window_estimate_t& e) {
  error_ = fault_of(e, names_.size());
  if (!error_.empty()) return false;
  if ((columns_[0].values.size() + names_.size()) * sizeof(double) > MatFile::kMaxBytes) {
    error_ =
        "a variable of a MATLAB 5 file holds at most 2 GiB: shorten with --from and --to, or "
        "write a .csv.gz";
    return false;
  }
  end_s_.push_back(static_cast<double>(e.window_end_us) / 1e6);
  status_.push_back(e.status);
  for (std::size_t i = 0; i < names_.size(); ++i) {
    const bool observable = e.reason[i] == 0;
    columns_[0].values.push_back(observable ? e.value[i] : kNone);
    columns_[1].values.push_back(observable ? e.std_error[i] : kNone);
    columns_[2].values.push_back(observable);
    if (!boxplot_) continue;
    const bool box = e.boxplots > 0 && e.boxplot_count[i] > 0;
    columns_[3].values.push_back(box ? e.q1[i] : kNone);
    columns_[4].values.push_back(box ? e.median[i] : kNone);
    columns_[5].values.push_back(box ? e.q3[i] : kNone);
    columns_[6].values.push_back(box ? e.whisker_low[i] : kNone);
    columns_[7].values.push_back(box ? e.whisker_high[i] : kNone);
    columns_[8].values.push_back(box ? e.outliers[i] : kNone);
  }
  return true;
}

bool EstimatesMatWriter::close() {
  error_ = write_mat_file(out_, [&](MatFile& file) {
    bool good = file.texts("parameter", names_) && file.texts("unit", units_) &&
                file.matrix("window_end_s", end_s_, 1) && file.matrix("status", status_, 1);
    for (const Column& column : columns_)
      good = good && file.matrix(column.name, column.values, names_.size());
    return good;
  });
  return error_.empty();
}

}  // namespace framewatch::daemon
