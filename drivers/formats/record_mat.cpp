// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/caught.h"
#include "drivers/files/input_file.h"
#include "drivers/formats/mat_variables.h"
#include "drivers/formats/record_formats.h"
#include "drivers/formats/table.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// A variable of this name states, as in a table, that times are in s and channels in m/s^2.
constexpr std::string_view kOwnTimeOfMat = "time_s";
constexpr double kMinRateOfMatSeconds_hz = 5, kMaxRateOfMatSeconds_hz = 1e4;
constexpr std::size_t kMaxListed = 20;

/// A column when a MATLAB file is read as a table: a vector, or one row or column of a matrix.
struct MatColumn {
  std::string title;
  const MatVariable* variable = nullptr;
  std::size_t line = 0;  ///< index of that row or column
  bool across = false;   ///< it is a row
  std::size_t samples = 0;
};

/// Returns true for a row or column of numbers. A single number is a setting (fs, T), not a
/// channel.
bool is_vector(const MatVariable& v) {
  return v.is_numbers && std::min(v.rows, v.columns) == 1 && std::max(v.rows, v.columns) > 1;
}

/// Returns "run." if every variable is in the struct `run`, else an empty text.
std::string common_struct(const std::vector<MatVariable>& variables) {
  if (variables.empty()) return {};
  const std::string& first = variables.front().name;
  const std::string stem = first.substr(0, first.find('.') + 1);
  const bool all = std::all_of(variables.begin(), variables.end(),
                               [&](const MatVariable& v) { return v.name.starts_with(stem); });
  return all ? stem : "";
}

/// Chooses the columns of a table from the variables of a MATLAB file.
class MatTable {
 public:
  MatTable(std::vector<MatVariable> variables, RecordOptions options, FileProblems& problems)
      : variables_(std::move(variables)), options_(std::move(options)), problems_(problems) {
    const std::string stem = common_struct(variables_);
    for (MatVariable& v : variables_) v.name.erase(0, stem.size());
  }

  /// Returns the columns and how to read them; nullopt with every problem.
  std::optional<TableColumns> choose() {
    if (options_.decimal || options_.zone_min)
      problems_.add(0, "--decimal and --zone are for tables of text");
    const std::size_t samples = samples_of_time();
    for (const MatVariable& v : variables_) add_columns(v, samples);
    take_whole_matrices();
    check_lengths();
    std::stable_partition(columns_.begin(), columns_.end(),
                          [](const MatColumn& c) { return c.title == kOwnTimeOfMat; });
    const bool own = !columns_.empty() && columns_.front().title == kOwnTimeOfMat;
    if (columns_.empty()) problems_.add(0, "there are no numbers that can be a channel");
    if (columns_.empty() && std::any_of(variables_.begin(), variables_.end(),
                                        [](const MatVariable& v) { return v.is_object; }))
      problems_.add(0,
                    "tables and timetables are MATLAB's own objects: save their columns instead, "
                    "for example t = seconds(tt.Time - tt.Time(1)); acc = tt.Variables; "
                    "save('FILE.mat', 't', 'acc', '-v7')");
    if (!own && !options_.unit_mps2 && !columns_.empty())
      problems_.add(0,
                    "a MATLAB file does not say its unit: declare it with --unit g, mg, gal or "
                    "mps2");
    if (!own && !options_.unit_mps2) options_.unit_mps2 = 1;
    std::vector<std::string> titles;
    for (const MatColumn& c : columns_) titles.push_back(c.title);
    std::optional<TableColumns> chosen;
    if (!columns_.empty()) chosen = table_columns(titles, {}, options_, 0, problems_);
    if (problems_.any()) problems_.add(0, "the file holds " + contents());
    if (problems_.any()) return std::nullopt;
    chosen->notes.insert(chosen->notes.end(), notes_.begin(), notes_.end());
    return chosen;
  }

  const std::vector<MatColumn>& columns() const { return columns_; }

 private:
  /// Returns the length of the vector of times; 0 when no variable, or more than one, has such a
  /// title.
  std::size_t samples_of_time() const {
    std::size_t samples = 0;
    int found = 0;
    for (const MatVariable& v : variables_) {
      const bool is_time =
          options_.time_column.empty() ? is_time_title(v.name) : v.name == options_.time_column;
      if (!is_time || !is_vector(v)) continue;
      samples = std::max(v.rows, v.columns);
      ++found;
    }
    return found == 1 ? samples : 0;
  }

  bool is_wanted(const std::string& name) const {
    const auto& wanted = options_.columns;
    return std::find(wanted.begin(), wanted.end(), name) != wanted.end();
  }

  void leave_out(const MatVariable& v) {
    const std::string what = fmt::format("{}: {}", show_text(v.name), v.shape);
    if (is_wanted(v.name) || v.name == options_.time_column)
      problems_.add(0, what + " cannot be a channel or the times");
    else if (v.may_be_meant && options_.columns.empty())
      problems_.add(0, what + " cannot be a channel: name the channels with --columns");
    else
      notes_.push_back(what + ", left out");
  }

  void add_columns(const MatVariable& v, std::size_t samples) {
    if (!v.is_numbers || v.rows * v.columns == 1) return leave_out(v);
    const std::size_t width = std::min(v.rows, v.columns), length = std::max(v.rows, v.columns);
    if (width == 1) {
      columns_.push_back({v.name, &v, 0, v.columns > 1, length});
      return;
    }
    const bool fits_down = v.rows == samples, fits_across = v.columns == samples;
    if (fits_down == fits_across && (fits_down || v.rows == v.columns)) {
      problems_.add(0,
                    fmt::format("{}: {}: its rows or its columns can be the channels: write them "
                                "as vectors",
                                show_text(v.name), v.shape));
      return;
    }
    const bool across = fits_down || fits_across ? fits_across : v.columns > v.rows;
    if (width > kMaxChannels) {
      problems_.add(0, fmt::format("{}: {}: more than {} channels", show_text(v.name), v.shape,
                                   kMaxChannels));
      return;
    }
    if (across)
      notes_.push_back(fmt::format("{}: its {} rows are channels", show_text(v.name), width));
    for (std::size_t k = 0; k < width; ++k)
      columns_.push_back(
          {fmt::format("{}.{}", v.name, k + 1), &v, k, across, across ? v.columns : v.rows});
  }

  /// Replaces "acc" in --columns by acc.1, acc.2, ... when acc is a matrix.
  void take_whole_matrices() {
    std::vector<std::string> columns;
    for (const std::string& wanted : options_.columns) {
      const std::size_t before = columns.size();
      for (const MatColumn& c : columns_)
        if (c.variable->name == wanted) columns.push_back(c.title);
      if (columns.size() == before) columns.push_back(wanted);
    }
    options_.columns = std::move(columns);
  }

  /// Reports variables of different lengths, among those that --columns names if it is given.
  void check_lengths() {
    std::map<std::size_t, int> lengths;
    const std::string& time = options_.time_column;
    std::size_t wanted_length = 0;
    for (const MatColumn& c : columns_) {
      const bool is_time = time.empty() ? is_time_title(c.title) : c.title == time;
      if (is_time) wanted_length = c.samples;
      if (is_time || options_.columns.empty() || is_wanted(c.title)) ++lengths[c.samples];
    }
    if (lengths.size() > 1) {
      problems_.add(0, wanted_length == 0
                           ? "the variables have different lengths: name the channels with "
                             "--columns"
                           : fmt::format("there are {} times, and variables of other lengths: name "
                                         "the channels with --columns",
                                         wanted_length));
    }
  }

  std::string contents() const {
    std::string out;
    for (std::size_t i = 0; i < std::min(kMaxListed, variables_.size()); ++i)
      out += fmt::format("{}{} ({})", i > 0 ? ", " : "", show_text(variables_[i].name),
                         variables_[i].shape);
    if (variables_.size() > kMaxListed)
      out += fmt::format(" and {} more", variables_.size() - kMaxListed);
    return out.empty() ? "nothing" : out;
  }

  static constexpr std::size_t kMaxChannels = 10'000;
  std::vector<MatVariable> variables_;
  RecordOptions options_;
  FileProblems& problems_;
  std::vector<MatColumn> columns_;
  std::vector<std::string> notes_;
};

double sample_of(const MatColumn& c, std::size_t i) {
  const std::size_t rows = c.variable->rows;
  return MatFileReader::number(*c.variable, c.across ? i * rows + c.line : c.line * rows + i);
}

/// Takes times without a unit as seconds if the rate is then that of a sensor; reports a problem
/// otherwise.
void check_seconds(const std::string& title, Record& record, FileProblems& problems) {
  if (record.rate_hz < kMinRateOfMatSeconds_hz || record.rate_hz > kMaxRateOfMatSeconds_hz)
    problems.add(0,
                 fmt::format("{}: the file does not say the unit, and in seconds it would be {:g} "
                             "Hz: declare it with --time-unit s, ms, us or ns (multiply "
                             "days by 86400 before saving)",
                             show_text(title), record.rate_hz));
  record.notes.push_back(
      fmt::format("{} is taken as seconds: {:g} Hz", show_text(title), record.rate_hz));
}

std::optional<Record> read_mat_table(const RecordOptions& options, FileProblems& problems) {
  MatFileReader file(problems);
  auto variables = file.variables(problems);
  if (!variables) return std::nullopt;
  MatTable table(std::move(*variables), options, problems);
  const auto chosen = table.choose();
  if (!chosen) return std::nullopt;

  const std::vector<MatColumn>& columns = table.columns();
  std::vector<std::string> names;
  std::vector<std::size_t> used;
  if (chosen->time) used.push_back(*chosen->time);
  for (const TableColumns::Channel& channel : chosen->channels) {
    names.push_back(channel.name);
    used.push_back(channel.column);
  }
  // --columns may name a title without its unit, so the columns meant are known only here.
  for (const std::size_t c : used)
    if (columns[c].samples != columns[used.front()].samples)
      problems.add(0, fmt::format("{} has {} samples, {} has {}", show_text(columns[c].title),
                                  columns[c].samples, show_text(columns[used.front()].title),
                                  columns[used.front()].samples));
  const std::size_t samples = columns[used.front()].samples;
  if (samples > RecordBuilder::kMaxValues / (names.size() + 1))
    problems.add(
        0, fmt::format("{} has {} samples: a record holds at most {} values, with times",
                       show_text(columns[used.front()].title), samples, RecordBuilder::kMaxValues));
  if (problems.any()) return std::nullopt;
  for (const std::size_t c : used)
    if (!file.load(*columns[c].variable, problems)) return std::nullopt;
  RecordBuilder builder(names, problems);
  for (const std::string& note : chosen->notes) builder.note(note);
  std::vector<double> row(names.size());
  for (std::size_t i = 0; i < samples && !builder.full() && !problems.full(); ++i) {
    const double time_s = chosen->time ? sample_of(columns[*chosen->time], i) * chosen->time_unit_s
                                       : static_cast<double>(i) * options.step_s.value_or(1);
    for (std::size_t c = 0; c < row.size(); ++c) {
      const TableColumns::Channel& channel = chosen->channels[c];
      row[c] = sample_of(columns[channel.column], i) * channel.unit_mps2;
      if (std::isinf(row[c]))
        problems.add(0, fmt::format("{}: sample {} is infinite", show_text(channel.name), i + 1));
    }
    builder.add(0, time_s, row);
  }
  auto record = builder.finish();
  if (record && chosen->time && !chosen->time_unit_said)
    check_seconds(columns[*chosen->time].title, *record, problems);
  if (problems.any()) return std::nullopt;
  return record;
}

bool is_hdf5_mat(InputFile& file) {
  std::string head(kMatHeaderBytes, '\0');
  return file.is_open() && file.read(head.data(), std::ssize(head), 0) == std::ssize(head) &&
         mat_level(head) == MatLevel::level_7_3;
}

/// Allows ten times the time of an intact file, also of one that compresses to almost nothing.
constexpr int kHdf5Least_s = 20, kHdf5BytesPerSecond = 2'000'000;

/// Reads a file in a child process first. libhdf5 crashes or hangs on one of some hundred damaged
/// files.
AttemptEnd try_hdf5(const RecordOptions& options, const std::string& path, std::int64_t bytes) {
  const auto attempt = [&] {
    std::vector<Problem> ignored;
    FileProblems problems(path, ignored);
    (void)read_mat_table(options, problems);
  };
  const auto more_s = static_cast<int>(std::min<std::int64_t>(bytes / kHdf5BytesPerSecond, 3600));
  return try_apart(attempt, kHdf5Least_s + more_s);
}

}  // namespace

std::optional<Record> read_mat(const RecordOptions& options, FileProblems& problems) {
  InputFile file(problems.path());
  if (is_hdf5_mat(file)) {
    const AttemptEnd end = try_hdf5(options, problems.path(), file.size());
    if (end == AttemptEnd::crashed)
      problems.add(0, "is damaged: it crashes the library for such files (libhdf5)");
    if (end == AttemptEnd::too_long)
      problems.add(0,
                   "is damaged: the library for such files (libhdf5) does not finish reading it");
    if (end == AttemptEnd::not_begun)
      problems.add(0, "cannot be checked: the system starts no child process to read it first");
  }
  if (problems.any()) return std::nullopt;
  return read_mat_table(options, problems);
}

}  // namespace framewatch::drivers
