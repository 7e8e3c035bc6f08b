#pragma once

#include <memory>
#include <string>
#include <vector>

namespace framewatch::drivers {

/// Writes a record CSV: `time_s,<channel names>`, then m/s^2, an empty cell where a value is
/// missing. Numbers are the shortest that read back the same. PATH.gz is compressed.
/// The file is written as PATH.partial and renamed by close(): nothing half-written under its name.
class RecordCsvWriter {
 public:
  RecordCsvWriter();
  /// Removes the partial file when close() was not called.
  ~RecordCsvWriter();
  RecordCsvWriter(const RecordCsvWriter&) = delete;
  RecordCsvWriter& operator=(const RecordCsvWriter&) = delete;

  /// False when the file cannot be made or a name cannot stand in a CSV; error() says why, here and
  /// below.
  [[nodiscard]] bool open(const std::string& path, const std::vector<std::string>& names);
  [[nodiscard]] bool write(double time_s, const std::vector<double>& accel_mps2);
  [[nodiscard]] bool close();
  const std::string& error() const { return error_; }

 private:
  struct GzClose {
    void operator()(void* file) const;
  };

  bool put(const std::string& line);

  std::unique_ptr<void, GzClose> file_;
  std::string path_;
  std::string line_;
  std::string error_;
};

}  // namespace framewatch::drivers
