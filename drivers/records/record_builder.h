#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"
#include "drivers/records/record.h"

namespace framewatch::drivers {

/// Builds a record row by row and checks what is required of every record: time that increases in
/// even steps, values that are finite or NaN. Lost samples must leave out whole steps; they are
/// filled with NaN and noted.
class RecordBuilder {
 public:
  static constexpr double kStepTolerance = 0.1;  ///< of a step: files hold rounded times
  static constexpr double kMaxRateHz = 1e5;
  static constexpr double kMaxTimeS = 4e9;
  static constexpr std::size_t kMaxValues = std::size_t{1} << 26;

  RecordBuilder(std::vector<std::string> names, FileProblems& problems);

  /// One value per name. `line` is reported when the row breaks a rule.
  void add(std::int64_t line, double time_s, std::span<const double> accel_mps2);
  /// The rate, when it is known from elsewhere: one row is then enough, and up to `missing`
  /// instants may be missing. Without it at most as many instants may be missing as there are rows.
  void expect(double rate_hz, std::size_t missing);
  void note(const std::string& text) { record_.notes.push_back(text); }
  bool full() const { return full_; }
  std::size_t rows() const { return record_.time_s.size(); }
  /// Empty when `problems` holds any problem, also one that the caller reported.
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

/// Reports names that are empty, appear twice or have a comma or quote in them.
void check_names(const std::vector<std::string>& names, std::int64_t line, FileProblems& problems);

/// "elcentro_NS" for "data/elcentro_NS.dat.gz".
std::string name_of_file(const std::string& path);

}  // namespace framewatch::drivers
