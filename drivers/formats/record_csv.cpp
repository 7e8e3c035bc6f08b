// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "drivers/files/line_reader.h"
#include "drivers/files/number_text.h"
#include "drivers/formats/record_formats.h"
#include "drivers/formats/table.h"
#include "drivers/records/record_builder.h"
#include "drivers/records/unit_text.h"

namespace framewatch::drivers {
namespace {

using Cells = std::vector<std::string>;

/// No building is sampled at a lower rate, so below it times are not in seconds.
constexpr double kMinRateOfSeconds_hz = 5;
/// Samples are closer than this (9 s) when times are days since 1900, as in spreadsheets.
constexpr double kStepOfDays = 1e-4;

constexpr std::int64_t kToa5Lines = 4;  ///< header lines

/// The header of a table and its surroundings.
struct TableLayout {
  char delimiter = ',';
  char decimal = '.';
  std::int64_t header_line = 0, last_header_line = 0;
  Cells titles, units;
  std::int64_t before = 0;  ///< lines of text above the header
  bool trailing = false;    ///< each line ends with a delimiter
};

bool is_units_line(const Cells& cells) {
  bool any = false;
  for (const std::string& cell : cells) {
    const std::string unit = column_title(cell).unit.value_or(cell);
    if (!unit.empty() && !mps2_per(unit) && !seconds_per(unit) && !newtons_per(unit)) return false;
    any = any || !unit.empty();
  }
  return any;
}

std::optional<Cells> cells_of(const LineReader& lines, std::string_view line, char delimiter,
                              FileProblems& problems) {
  auto cells = split_cells(line, delimiter);
  if (!cells) problems.add(lines.number(), "a quote is not closed, or not at the end of its cell");
  return cells;
}

/// Names the first column "time" if it has no title, as the index in a table of pandas, and `row`
/// begins with a time stamp. Another time column, or a step in the options, leaves it an index.
void name_index(TableLayout& layout, std::string_view row, const RecordOptions& options) {
  if (layout.titles.size() < 2 || !layout.titles[0].empty()) return;
  if (!options.time_column.empty() || options.step_s) return;
  if (std::any_of(layout.titles.begin(), layout.titles.end(), is_time_title)) return;
  const auto cells = split_cells(row, layout.delimiter);
  if (cells && parse_time_stamp(cells->front())) layout.titles[0] = "time";
}

/// Finds the header: the first line with a time column, or the last line above the numbers. TOA5,
/// of Campbell loggers, has four lines: the logger, titles, units, and kinds of processing. Leaves
/// `line` at the first row; sets `at_row` to false when there is no row.
std::optional<TableLayout> find_layout(LineReader& lines, std::string_view& line, bool& at_row,
                                       const RecordOptions& options, FileProblems& problems) {
  TableLayout layout;
  bool found = false, toa5 = false;
  std::int64_t texts = 0;
  for (at_row = false; !at_row && lines.next(line);) {
    line = without_header_mark(line);
    if (is_comment(line, found ? layout.delimiter : '\0')) continue;
    const char delimiter = found ? layout.delimiter : delimiter_of(line);
    const auto cells = cells_of(lines, line, delimiter, problems);
    if (!cells) return std::nullopt;
    toa5 = toa5 || (lines.number() == 1 && is_toa5(line));
    if (toa5 && (lines.number() == 1 || lines.number() == kToa5Lines)) {
      layout.last_header_line = lines.number();
      continue;
    }
    const bool units = layout.units.empty() && cells->size() == layout.titles.size() &&
                       (toa5 || is_units_line(*cells));
    at_row = begins_data(cells->front()) || (found && !units);
    if (at_row) break;
    layout.last_header_line = lines.number();
    if (units) {
      layout.units = *cells;
      continue;
    }
    layout.delimiter = delimiter;
    layout.header_line = lines.number();
    layout.titles = *cells;
    layout.before = texts++;
    found = is_table_header(line, options);
  }
  if (problems.any()) return std::nullopt;
  if (layout.titles.empty())
    return problems.add(0, "there is no header: write the names of the columns above the numbers");
  if (at_row) name_index(layout, line, options);
  const auto row = at_row ? split_cells(line, ' ') : std::nullopt;
  if (layout.delimiter == ' ' && row && row->size() != layout.titles.size())
    return problems.add(
        lines.number(),
        fmt::format("{} fields where the header has {}: names with blanks need quotes, or "
                    "semicolons between columns",
                    row->size(), layout.titles.size()));
  layout.trailing = layout.titles.size() > 1 && layout.titles.back().empty();
  if (layout.trailing) layout.titles.pop_back();
  return layout;
}

/// Reads the whole file to find its decimal sign.
std::optional<char> find_decimal(const TableLayout& layout, FileProblems& problems) {
  LineReader lines(problems);
  DecimalScan scan;
  for (std::string_view line; lines.next(line);) {
    if (lines.number() <= layout.last_header_line || is_comment(line, layout.delimiter)) continue;
    const auto cells = split_cells(line, layout.delimiter);
    if (!cells) continue;
    for (const std::string& cell : *cells) scan.add(lines.number(), cell);
  }
  if (problems.any()) return std::nullopt;
  return scan.decimal(problems);
}

/// Adds the rows of a table to a record.
class TableReader {
 public:
  TableReader(TableLayout layout, TableColumns columns, const RecordOptions& options,
              FileProblems& problems)
      : layout_(std::move(layout)),
        columns_(std::move(columns)),
        options_(options),
        problems_(problems),
        builder_(names(), problems),
        row_(columns_.channels.size()) {
    for (const std::string& note : columns_.notes) builder_.note(note);
    if (layout_.before > 0)
      builder_.note(fmt::format("{} lines of text above the header, which is line {}, left out",
                                layout_.before, layout_.header_line));
  }

  void add(std::int64_t line, Cells& cells) {
    if (layout_.trailing && cells.size() == columns_.count + 1) {
      if (!cells.back().empty()) problems_.add(layout_.header_line, "a channel name is empty");
      cells.pop_back();
    }
    if (cells.size() != columns_.count) {
      problems_.add(line, fmt::format("{} fields where the header has {}{}", cells.size(),
                                      columns_.count, hint(cells.size())));
      return;
    }
    const auto time_s =
        columns_.time ? time_of(line, cells[*columns_.time])
                      : std::optional(static_cast<double>(count_) * options_.step_s.value_or(1));
    bool sound = time_s.has_value();
    for (std::size_t i = 0; i < row_.size(); ++i) {
      const TableColumns::Channel& channel = columns_.channels[i];
      const auto value = parse_cell(cells[channel.column], layout_.decimal);
      if (!value)
        problems_.add(line, fmt::format("{}: {} is neither a finite number nor nan", channel.name,
                                        show_text(cells[channel.column])));
      sound = sound && value;
      row_[i] = value.value_or(0) * channel.unit_mps2;
    }
    ++count_;
    if (sound && !doubted_) builder_.add(line, *time_s, row_);
  }

  std::optional<Record> finish() {
    auto record = builder_.finish();
    if (record) say_forces(*record);
    if (!record || !columns_.time || columns_.time_unit_said || stamps_) return record;
    if (record->rate_hz < kMinRateOfSeconds_hz || record->rate_hz > 1e4)
      return problems_.add(
          layout_.header_line,
          fmt::format("{}: the header does not say the unit, and in seconds it would be "
                      "{:g} Hz: declare it with --time-unit s, ms, us or ns",
                      show_text(layout_.titles[*columns_.time]), record->rate_hz));
    record->notes.push_back(fmt::format("{} is taken as seconds: {:g} Hz",
                                        show_text(layout_.titles[*columns_.time]),
                                        record->rate_hz));
    return record;
  }

  bool full() const { return doubted_ || builder_.full() || problems_.full(); }
  void note(const std::string& text) { builder_.note(text); }

 private:
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const TableColumns::Channel& channel : columns_.channels) out.push_back(channel.name);
    return out;
  }

  void say_forces(Record& record) const {
    const auto is_force = [](const TableColumns::Channel& channel) { return channel.is_force; };
    if (std::none_of(columns_.channels.begin(), columns_.channels.end(), is_force)) return;
    for (const TableColumns::Channel& channel : columns_.channels) {
      record.headers.emplace_back().unit = channel.is_force ? "N" : "";
      if (channel.is_force) record.notes.push_back(channel.name + ": a force, N");
    }
  }

  std::string hint(std::size_t fields) const {
    if (layout_.delimiter == ',' && fields == 2 * columns_.count)
      return ": decimal commas look like commas between columns: write semicolons between "
             "columns";
    return {};
  }

  std::optional<double> time_of(std::int64_t line, const std::string& text) {
    const auto number = parse_cell(text, layout_.decimal);
    const bool is_number = number && !std::isnan(*number);
    if (is_number && !stamps_) {
      if (!columns_.time_unit_said) doubt(line, *number);
      return *number * columns_.time_unit_s;
    }
    const auto stamp = parse_time_stamp(text);
    if (!stamp) return problems_.add(line, fmt::format("time {}", why_no_time(text)));
    if (count_ > 0 && !stamps_)
      return problems_.add(line,
                           fmt::format("time {}: the rows above have numbers", show_text(text)));
    stamps_ = true;
    const auto offset_min = stamp->offset_min ? stamp->offset_min : options_.zone_min;
    if (!offset_min && !zone_asked_)
      problems_.add(line, fmt::format("time {} does not say its zone: declare it with --zone Z or, "
                                      "for example, --zone +09:00",
                                      show_text(text)));
    zone_asked_ = zone_asked_ || !offset_min;
    if (!offset_min) return std::nullopt;
    return stamp->local_s - 60.0 * *offset_min;
  }

  /// Reports a time without a unit that cannot be in seconds.
  void doubt(std::int64_t line, double time) {
    const bool days = count_ == 1 && first_time_ > 2e4 && first_time_ < 8e4 && time > first_time_ &&
                      time < first_time_ + kStepOfDays;
    const bool late = count_ == 0 && std::abs(time) > RecordBuilder::kMaxTimeS;
    if (count_ == 0) first_time_ = time;
    doubted_ = days || late;
    if (days)
      problems_.add(
          line,
          "these times look like a spreadsheet's days: format the column as seconds, or as "
          "2026-11-21T17:00:00.01Z");
    if (late)
      problems_.add(line, fmt::format("time {:g}: the header does not say the unit, and these "
                                      "cannot be seconds: declare it with --time-unit ms, us or ns",
                                      time));
  }

  TableLayout layout_;
  TableColumns columns_;
  const RecordOptions& options_;
  FileProblems& problems_;
  RecordBuilder builder_;
  std::vector<double> row_;
  std::int64_t count_ = 0;
  double first_time_ = 0;
  bool stamps_ = false, zone_asked_ = false, doubted_ = false;
};

}  // namespace

bool is_table_header(std::string_view line, const RecordOptions& options) {
  const char delimiter = delimiter_of(line);
  auto cells = split_cells(line, delimiter);
  if (!cells || begins_data(cells->front())) return false;
  if (delimiter == ' ' && cells->front() == "time_s") return true;
  if (cells->size() < 2) return false;
  if (delimiter == ' ') cells->resize(1);  // further words may be prose
  return std::any_of(cells->begin(), cells->end(), [&](const std::string& cell) {
    if (options.time_column.empty()) return is_time_title(cell);
    return cell == options.time_column || column_title(cell).name == options.time_column;
  });
}

std::optional<Record> read_csv(const RecordOptions& options, FileProblems& problems) {
  LineReader lines(problems);
  std::string_view line;
  bool at_row = false;
  auto layout = find_layout(lines, line, at_row, options, problems);
  if (!layout) return std::nullopt;
  auto columns =
      table_columns(layout->titles, layout->units, options, layout->header_line, problems);
  if (!columns) return std::nullopt;
  layout->decimal = options.decimal.value_or('.');
  const bool commas = layout->delimiter != ',' || line.find('"') != std::string_view::npos;
  if (commas && !options.decimal) {
    const auto found = find_decimal(*layout, problems);
    if (!found) return std::nullopt;
    layout->decimal = *found;
  }
  const char delimiter = layout->delimiter;
  TableReader reader(std::move(*layout), std::move(*columns), options, problems);
  for (; at_row && !reader.full(); at_row = lines.next(line)) {
    if (is_comment(line, delimiter)) continue;
    if (!lines.line_ended()) {
      reader.note(lines.left_out_note("row"));
      continue;
    }
    auto cells = cells_of(lines, line, delimiter, problems);
    if (cells) reader.add(lines.number(), *cells);
  }
  return reader.finish();
}

}  // namespace framewatch::drivers
