#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/file_problems.h"
#include "drivers/record.h"

namespace framewatch::drivers {

/// Puts a record together row by row and holds it to what every record must be: time that
/// increases in even steps, gaps of whole steps (filled with NaN, noted), finite values or NaN.
class RecordBuilder {
 public:
  static constexpr double kStepTolerance = 0.1;  ///< of a step; times are printed rounded
  static constexpr double kMaxRateHz = 1e5;
  static constexpr double kMaxTimeS = 4e9;
  static constexpr std::size_t kMaxValues = std::size_t{1} << 26;

  RecordBuilder(std::vector<std::string> names, FileProblems& problems);

  /// One value per name. `line` is named when the row breaks a rule.
  void add(std::int64_t line, double time_s, std::span<const double> accel_mps2);
  /// The rate when it is known otherwise: then one row is a record, and up to `missing` instants
  /// may be; without it at most as many as there are rows.
  void expect(double rate_hz, std::size_t missing);
  void note(const std::string& text) { record_.notes.push_back(text); }
  bool full() const { return full_; }
  std::size_t rows() const { return record_.time_s.size(); }
  /// Empty when there is any problem, also one that somebody else found.
  std::optional<Record> finish();

 private:
  double even_step() const;
  void fill_gaps(double step);

  FileProblems& problems_;
  Record record_;
  std::vector<std::int64_t> lines_;
  double expected_rate_hz_ = 0;
  std::size_t missing_allowed_ = 0;
  bool full_ = false;
};

/// Names a record's columns must have: not empty, different, printable, no comma or quote.
void check_names(const std::vector<std::string>& names, std::int64_t line, FileProblems& problems);

/// "elcentro_NS" for "data/elcentro_NS.dat.gz".
std::string name_of_file(const std::string& path);

}  // namespace framewatch::drivers
