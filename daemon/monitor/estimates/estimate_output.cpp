// SPDX-License-Identifier: MIT
#include "daemon/monitor/estimates/estimate_output.h"

#include <array>
#include <cmath>
#include <iterator>
#include <optional>
#include <utility>

#include <fmt/core.h>

#include <framewatch/parameter_table_t.hpp>
#include <framewatch/window_estimate_t.hpp>

#include "daemon/base/mat_file.h"
#include "daemon/base/printable.h"
#include "daemon/monitor/estimates/estimate_table.h"
#include "drivers/files/number_text.h"
#include "drivers/files/partial_file.h"
#include "drivers/files/standard_streams.h"
#include "drivers/files/text_output.h"
#include "drivers/lcm/lcm_log.h"
#include "drivers/lcm/lcm_provider.h"
#include "drivers/lcm/message_check.h"
#include "estimator/numeric/nan.h"

namespace framewatch::daemon {
namespace {

using drivers::LogEvent;
using drivers::Problem;

constexpr std::array<const char*, 3> kStatus = {"warming_up", "valid", "nothing_identifiable"};

std::string cell(double value) {
  return std::isfinite(value) ? "," + drivers::format_number(value) : ",";
}

/// Returns the names of the parameters of a log. Fails if they change within the log.
std::optional<std::vector<std::string>> parameter_names(const std::string& log,
                                                        std::vector<Problem>& problems) {
  std::optional<std::vector<std::string>> names;
  const bool whole = drivers::for_each_event(
      log,
      [&](const LogEvent& event) {
        if (drivers::fingerprint(event.data) != parameter_table_t::getHash()) return true;
        const auto table = drivers::decoded<parameter_table_t>(event.data);
        if (!table)
          problems.push_back(
              {place_of(log, event), drivers::why_not("parameter_table_t", event.data)});
        else if (names && *names != table->name)
          problems.push_back({place_of(log, event), "the parameter table changes inside the log"});
        else
          names = table->name;
        return problems.empty();
      },
      problems);
  if (whole && problems.empty() && !names)
    problems.push_back({log, "there is no parameter_table_t to name the parameters"});
  if (!problems.empty()) return std::nullopt;
  return names;
}

std::string header(const std::vector<std::string>& names, bool boxplot) {
  std::string line = "window_end_s,status";
  for (const std::string& name : names) {
    for (const char* column : {"", ".std_error", ".observable"})
      line += ',' + csv_text(name + column);
    if (!boxplot) continue;
    for (const char* column :
         {".q1", ".median", ".q3", ".whisker_low", ".whisker_high", ".outliers"})
      line += ',' + csv_text(name + column);
  }
  return line + "\n";
}

std::string boxplot_cells(const window_estimate_t& estimate, std::size_t i) {
  if (i >= static_cast<std::size_t>(estimate.boxplots) || estimate.boxplot_count[i] == 0)
    return ",,,,,,";
  std::string cells;
  for (const BoxColumn& column : kBoxColumns) cells += cell((estimate.*column.values)[i]);
  return cells + fmt::format(",{}", estimate.outliers[i]);
}

std::string row(const window_estimate_t& estimate, bool boxplot) {
  std::string line = drivers::format_number(static_cast<double>(estimate.window_end_us) / 1e6);
  line += fmt::format(",{}", kStatus[static_cast<std::size_t>(estimate.status)]);
  for (std::size_t i = 0; i < estimate.value.size(); ++i) {
    const bool observable = estimate.reason[i] == 0;
    line += observable ? cell(estimate.value[i]) + cell(estimate.std_error[i]) + ",1" : ",,,0";
    if (boxplot) line += boxplot_cells(estimate, i);
  }
  return line + "\n";
}

/// Returns what is wrong with an estimate of that many parameters; empty if it is valid.
std::string fault_of(const window_estimate_t& estimate, std::size_t parameters) {
  if (estimate.value.size() != parameters)
    return fmt::format("{} parameters where the table has {}", estimate.value.size(), parameters);
  if (estimate.boxplots != 0 && estimate.boxplots != estimate.parameters)
    return fmt::format("{} boxplots for {} parameters", estimate.boxplots, estimate.parameters);
  if (estimate.status < 0 || estimate.status >= static_cast<int>(kStatus.size()))
    return fmt::format("status {} is not 0, 1 or 2", estimate.status);
  for (std::size_t i = 0; i < parameters; ++i)
    if (estimate.reason[i] == 0 && !std::isfinite(estimate.value[i]))
      return fmt::format("parameter {} is observable and has no value", i);
  return "";
}

/// Writes estimates as CSV, one row per window (docs/formats.md), compressed if the name ends in
/// .gz. Methods return false when the file cannot be written or a message breaks the rules of its
/// type; error() says why.
class EstimatesCsvWriter {
 public:
  [[nodiscard]] bool open(const EstimateFile& file, const std::vector<std::string>& names,
                          const std::vector<std::string>& /*units*/) {
    parameters_ = names.size();
    boxplot_ = file.boxplot;
    return file_.open(file.path) && (file.goes_on || file_.write(header(names, boxplot_)));
  }
  [[nodiscard]] bool write(const window_estimate_t& estimate) {
    fault_ = fault_of(estimate, parameters_);
    return fault_.empty() && file_.write(row(estimate, boxplot_));
  }
  [[nodiscard]] bool close() { return file_.close(); }
  const std::string& error() const { return fault_.empty() ? file_.error() : fault_; }
  /// Returns true if a message caused the failure.
  bool at_fault() const { return !fault_.empty(); }

 private:
  drivers::TextOutput file_;
  std::string fault_;
  std::size_t parameters_ = 0;
  bool boxplot_ = false;
};

/// Collects estimates and writes them as a MATLAB file, version 5 (docs/formats.md). Variables:
/// `parameter` and `unit`, columns of names; `window_end_s` and `status`, columns; `value`,
/// `std_error` and `observable`, windows x parameters; with boxplots also `q1`, `median`, `q3`,
/// `whisker_low`, `whisker_high`, `outliers`, windows x parameters. NaN stands for a missing value.
/// Equal estimates give byte-identical files. The format limits each variable to 2 GiB.
class EstimatesMatWriter {
 public:
  [[nodiscard]] bool open(const EstimateFile& file, const std::vector<std::string>& names,
                          const std::vector<std::string>& units) {
    names_ = names;
    units_ = units;
    boxplot_ = file.boxplot;
    for (const char* name : {"value", "std_error", "observable"}) columns_.push_back({name, {}});
    if (boxplot_) {
      for (const BoxColumn& column : kBoxColumns) columns_.push_back({column.name, {}});
      columns_.push_back({"outliers", {}});
    }
    // Opening the file first reports a missing folder before the work begins.
    if (out_.open(file.path)) return true;
    error_ = out_.error();
    return false;
  }

  [[nodiscard]] bool write(const window_estimate_t& e) {
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
      columns_[0].values.push_back(observable ? e.value[i] : estimator::kNaN);
      columns_[1].values.push_back(observable ? e.std_error[i] : estimator::kNaN);
      columns_[2].values.push_back(observable);
      if (!boxplot_) continue;
      const bool box = e.boxplots > 0 && e.boxplot_count[i] > 0;
      for (std::size_t c = 0; c < std::size(kBoxColumns); ++c)
        columns_[3 + c].values.push_back(box ? (e.*kBoxColumns[c].values)[i] : estimator::kNaN);
      columns_.back().values.push_back(box ? e.outliers[i] : estimator::kNaN);
    }
    return true;
  }

  [[nodiscard]] bool close() {
    error_ = write_mat_file(out_, [&](MatFile& file) {
      bool good = file.texts("parameter", names_) && file.texts("unit", units_) &&
                  file.matrix("window_end_s", end_s_, 1) && file.matrix("status", status_, 1);
      for (const Column& column : columns_)
        good = good && file.matrix(column.name, column.values, names_.size());
      return good;
    });
    return error_.empty();
  }

  const std::string& error() const { return error_; }

 private:
  struct Column {
    const char* name;
    std::vector<double> values;  ///< window-major
  };

  drivers::PartialFile out_;
  std::string error_;
  std::vector<std::string> names_, units_;
  bool boxplot_ = false;
  std::vector<double> end_s_, status_;
  std::vector<Column> columns_;
};

class LogOutput : public EstimateOutput {
 public:
  bool open(const EstimateFile& file) {
    const bool opened = writer_.open(file.path);
    writer_.number_from(file.event);
    return opened;
  }
  std::int64_t events() const override { return writer_.events(); }
  bool put(std::int64_t time_us, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    return writer_.write(time_us, channel, bytes.data(), bytes.size());
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  drivers::LcmLogWriter writer_;
};

/// Writes the main window's estimates as rows of a table.
template <typename Writer>
class TableOutput : public EstimateOutput {
 public:
  explicit TableOutput(const Config& config)
      : channel_(config.lcm.prefix + "ESTIMATE"), table_(config.pipeline.parameters()) {}
  bool open(const EstimateFile& file) {
    std::vector<std::string> names, units;
    for (int i = 0; i < table_.size(); ++i) {
      names.push_back(table_[i].name);
      units.push_back(table_[i].unit);
    }
    return writer_.open(file, names, units);
  }
  bool put(std::int64_t, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    if (channel != channel_) return true;
    const auto estimate = drivers::decoded<window_estimate_t>(bytes);
    return estimate && writer_.write(*estimate);
  }
  bool close() override { return writer_.close(); }
  std::string error() const override { return writer_.error(); }

 private:
  std::string channel_;
  estimator::ParameterTable table_;
  Writer writer_;
};

class LcmOutput : public EstimateOutput {
 public:
  explicit LcmOutput(std::unique_ptr<drivers::LcmProvider> lcm) : lcm_(std::move(lcm)) {}
  bool put(std::int64_t, const std::string& channel,
           const std::vector<std::uint8_t>& bytes) override {
    return lcm_->publish(channel, bytes.data(), static_cast<unsigned>(bytes.size())) == 0;
  }
  bool close() override { return true; }
  std::string error() const override { return "LCM refuses to publish"; }

 private:
  std::unique_ptr<drivers::LcmProvider> lcm_;
};

template <typename Output>
std::unique_ptr<EstimateOutput> opened(std::unique_ptr<Output> output, const EstimateFile& file,
                                       std::string& error) {
  if (output->open(file)) return output;
  error = output->error();
  return nullptr;
}

bool is_csv(const std::string& path) {
  return path == drivers::kStandardOutput || path.ends_with(".csv") || path.ends_with(".csv.gz");
}

}  // namespace

bool write_estimates_csv(const std::string& log, const std::string& channel, bool boxplot,
                         const std::string& out, std::vector<Problem>& problems) {
  const auto names = parameter_names(log, problems);
  if (!names) return false;
  EstimatesCsvWriter file;
  if (!file.open({out, boxplot}, *names, {})) {
    problems.push_back({out, file.error()});
    return false;
  }
  drivers::for_each_event(
      log,
      [&](const LogEvent& event) {
        if (event.channel != channel) return true;
        const auto estimate = drivers::decoded<window_estimate_t>(event.data);
        if (!estimate)
          problems.push_back(
              {place_of(log, event), drivers::why_not("window_estimate_t", event.data)});
        else if (!file.write(*estimate))
          problems.push_back({file.at_fault() ? place_of(log, event) : out, file.error()});
        return problems.empty();
      },
      problems);
  if (problems.empty() && !file.close()) problems.push_back({out, file.error()});
  return problems.empty();
}

std::string problem_of_output_name(const std::string& path) {
  if (path.ends_with(".lcmlog") || path.ends_with(".mat") || is_csv(path)) return {};
  return path +
         ": the output's name must end in .lcmlog, .csv, .csv.gz, .mat or .sqlite, or be - "
         "(standard output, CSV)";
}

std::unique_ptr<EstimateOutput> estimate_output(const Config& config, const EstimateFile& file,
                                                std::string& error) {
  if (is_csv(file.path))
    return opened(std::make_unique<TableOutput<EstimatesCsvWriter>>(config), file, error);
  if (file.path.ends_with(".mat"))
    return opened(std::make_unique<TableOutput<EstimatesMatWriter>>(config), file, error);
  return opened(std::make_unique<LogOutput>(), file, error);
}

std::unique_ptr<EstimateOutput> lcm_estimate_output(const Config& config, const std::string& url,
                                                    std::string& error) {
  auto lcm = drivers::open_lcm(url.empty() ? config.lcm.url : url, config.lcm.reception, error);
  if (!lcm) return nullptr;
  return std::make_unique<LcmOutput>(std::move(lcm));
}

}  // namespace framewatch::daemon
