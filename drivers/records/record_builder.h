// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Builds a record row by row and checks the rules for every record: time increases in even steps,
/// values are finite or NaN. Lost samples must leave out whole steps; finish() fills them with NaN
/// and notes them.
class RecordBuilder {
 public:
  static constexpr double kStepTolerance = 0.1;  ///< in steps: files hold rounded times
  static constexpr double kMaxRateHz = 1e5;
  static constexpr double kMaxTimeS = 4e9;
  static constexpr std::size_t kMaxValues = std::size_t{1} << 26;

  /// `names` are the axes. `problems` must outlive this object.
  RecordBuilder(std::vector<std::string> names, FileProblems& problems);

  /// Adds a row at `time_s` with one value in m/s^2 per name. A row that breaks a rule becomes a
  /// problem at `line` and is dropped.
  void add(std::int64_t line, double time_s, std::span<const double> accel_mps2);
  /// Sets the rate when the file states it: one row is then enough, and up to `missing` instants
  /// may be missing. Otherwise at most as many instants may be missing as there are rows.
  void expect(double rate_hz, std::size_t missing);
  void note(const std::string& text) { record_.notes.push_back(text); }
  /// Returns true when the record has reached kMaxValues.
  bool full() const { return full_; }
  std::size_t rows() const { return record_.time_s.size(); }
  /// Returns the record. Returns nullopt when there is any problem, also one that the caller
  /// reported.
  std::optional<Record> finish();

 private:
  double even_step() const;
  void fill_lost_samples(double step);

  FileProblems& problems_;
  Record record_;
  double expected_rate_hz_ = 0;
  std::size_t missing_allowed_ = 0;
  bool full_ = false;
};

/// Reports names that are empty, appear twice, or contain a comma or quote, as problems at `line`.
void check_names(const std::vector<std::string>& names, std::int64_t line, FileProblems& problems);

/// Returns the name of a channel that has the name of its file: "elcentro_NS" for
/// "data/elcentro_NS.dat.gz".
std::string name_of_file(const std::string& path);

enum class MergeSpan {
  common,  ///< the instants that every record has
  all,     ///< from the first to the last instant of any record, NaN where a record has no value
};

/// Merges records of one rate and one clock into one, on the instants of the first record. Axis
/// headers are kept. `where` names each record in messages. Returns nullopt and appends every
/// problem when rates differ, clocks do not overlap, instants lie more than a tenth of a step
/// apart, or a name appears twice.
std::optional<Record> merge_records(std::vector<Record> records,
                                    const std::vector<std::string>& where, MergeSpan span,
                                    std::vector<Problem>& problems);

}  // namespace framewatch::drivers
