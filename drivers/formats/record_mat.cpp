#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/core.h>

#include "drivers/files/caught.h"
#include "drivers/files/input_file.h"
#include "drivers/formats/mat_signature.h"
#include "drivers/formats/mat_variables.h"
#include "drivers/formats/record_formats.h"
#include "drivers/formats/table_header.h"
#include "drivers/records/record_builder.h"

namespace framewatch::drivers {
namespace {

/// The name that says, as in a table, that times are in s and channels in m/s^2.
constexpr std::string_view kOwnTimeOfMat = "time_s";
constexpr double kMinRateOfMatSeconds_hz = 5, kMaxRateOfMatSeconds_hz = 1e4;
constexpr std::size_t kMaxListed = 20;

/// A column of a table that a MATLAB file would be: a vector, or one line of a matrix.
struct MatColumn {
  std::string title;
  const MatVariable* variable = nullptr;
  std::size_t line = 0;  ///< of the matrix
  bool across = false;   ///< that line is a row
  std::size_t samples = 0;
};

/// A single number is a setting, fs or T, not a channel of one sample.
bool is_vector(const MatVariable& v) {
  return v.is_numbers && std::min(v.rows, v.columns) == 1 && std::max(v.rows, v.columns) > 1;
}

/// "run." where every variable is in that struct.
std::string common_struct(const std::vector<MatVariable>& variables) {
  if (variables.empty()) return {};
  const std::string& first = variables.front().name;
  const std::string stem = first.substr(0, first.find('.') + 1);
  const bool all = std::all_of(variables.begin(), variables.end(),
                               [&](const MatVariable& v) { return v.name.starts_with(stem); });
  return all ? stem : "";
}

class MatTable {
 public:
  MatTable(std::vector<MatVariable> variables, RecordOptions options, FileProblems& problems)
      : variables_(std::move(variables)), options_(std::move(options)), problems_(problems) {
    const std::string stem = common_struct(variables_);
    for (MatVariable& v : variables_) v.name.erase(0, stem.size());
  }

  /// The columns and how they are to be read; empty with every problem.
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
  /// How many times there are, where a vector is called as times are; 0: not said.
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
      problems_.add(0, what + " cannot be a channel: say with --columns which are");
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

  /// "acc" of --columns stands for acc.1, acc.2, ...
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

  /// What is as long as no time can be a channel only where nobody said which are.
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
                           ? "the variables have different lengths: say with --columns which are "
                             "channels"
                           : fmt::format("there are {} times, and variables of other lengths: say "
                                         "with --columns which are channels",
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

/// Times whose unit nobody said are seconds where that is what a sensor samples at.
void check_seconds(const std::string& title, Record& record, FileProblems& problems) {
  if (record.rate_hz < kMinRateOfMatSeconds_hz || record.rate_hz > kMaxRateOfMatSeconds_hz)
    problems.add(0,
                 fmt::format("{}: the file does not say the unit, and in seconds it would be {:g} "
                             "Hz: declare it with --time-unit s, ms, us or ns (of days, save "
                             "86400 times them)",
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
  // A title may stand for a column with its unit cut off: only here it is known which are meant.
  for (const std::size_t c : used)
    if (columns[c].samples != columns[used.front()].samples)
      problems.add(0, fmt::format("{} has {} samples, {} has {}", show_text(columns[c].title),
                                  columns[c].samples, show_text(columns[used.front()].title),
                                  columns[used.front()].samples));
  if (problems.any()) return std::nullopt;
  for (const std::size_t c : used)
    if (!file.load(*columns[c].variable, problems)) return std::nullopt;
  RecordBuilder builder(names, problems);
  for (const std::string& note : chosen->notes) builder.note(note);
  std::vector<double> row(names.size());
  const std::size_t samples = columns[used.front()].samples;
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

/// More than ten times what a good file takes, also one of constants that packs to nothing.
constexpr int kHdf5Least_s = 20, kHdf5BytesPerSecond = 2'000'000;

/// libhdf5 does not survive every damaged file: one in some hundreds ends it, or never ends.
AttemptEnd hdf5_trial(const RecordOptions& options, const std::string& path, std::int64_t bytes) {
  const auto attempt = [&] {
    std::vector<Problem> unsaid;
    FileProblems problems(path, unsaid);
    (void)read_mat_table(options, problems);
  };
  const auto more_s = static_cast<int>(std::min<std::int64_t>(bytes / kHdf5BytesPerSecond, 3600));
  return try_apart(attempt, kHdf5Least_s + more_s);
}

}  // namespace

std::optional<Record> read_mat(const RecordOptions& options, FileProblems& problems) {
  InputFile file(problems.path());
  if (is_hdf5_mat(file)) {
    const AttemptEnd trial = hdf5_trial(options, problems.path(), file.size());
    if (trial == AttemptEnd::crashed)
      problems.add(
          0, "is damaged in a way that the library for such files (libhdf5) does not survive");
    if (trial == AttemptEnd::too_long)
      problems.add(0, "takes the library for such files (libhdf5) longer than a sound one would");
    if (trial == AttemptEnd::not_begun)
      problems.add(0, "is first read in a process of its own, and none can be begun");
  }
  if (problems.any()) return std::nullopt;
  return read_mat_table(options, problems);
}

}  // namespace framewatch::drivers
