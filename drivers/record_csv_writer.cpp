#include "drivers/record_csv_writer.h"

#include <zlib.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <iterator>

#include <fmt/format.h>

namespace framewatch::drivers {
void RecordCsvWriter::GzClose::operator()(void* file) const {
  ::gzclose(static_cast<gzFile>(file));
}

RecordCsvWriter::RecordCsvWriter() = default;

RecordCsvWriter::~RecordCsvWriter() {
  if (!file_) return;
  file_.reset();
  std::remove((path_ + ".partial").c_str());
}

bool RecordCsvWriter::open(const std::string& path, const std::vector<std::string>& names) {
  path_ = path;
  for (const std::string& name : names) {
    if (name.find_first_of(",\"\r\n") == std::string::npos) continue;
    error_ = fmt::format("channel name '{}' has a comma, quote or line end in it", name);
    return false;
  }
  // "T" writes the bytes as they are.
  file_.reset(::gzopen((path + ".partial").c_str(), path.ends_with(".gz") ? "wbe6" : "wbeT"));
  if (!file_) {
    error_ = std::strerror(errno);
    return false;
  }
  line_ = "time_s";
  for (const std::string& name : names) line_ += "," + name;
  return put(line_ + "\n");
}

bool RecordCsvWriter::write(double time_s, const std::vector<double>& accel_mps2) {
  line_.clear();
  fmt::format_to(std::back_inserter(line_), "{}", time_s);
  for (const double value : accel_mps2) {
    line_ += ',';
    if (!std::isnan(value)) fmt::format_to(std::back_inserter(line_), "{}", value);
  }
  line_ += '\n';
  return put(line_);
}

bool RecordCsvWriter::put(const std::string& line) {
  const auto size = static_cast<unsigned>(line.size());
  if (file_ &&
      ::gzwrite(static_cast<gzFile>(file_.get()), line.data(), size) == static_cast<int>(size))
    return true;
  if (error_.empty()) error_ = std::strerror(errno);
  return false;
}

bool RecordCsvWriter::close() {
  const std::string partial = path_ + ".partial";
  const bool written =
      error_.empty() && file_ && ::gzclose(static_cast<gzFile>(file_.release())) == Z_OK;
  if (written && std::rename(partial.c_str(), path_.c_str()) == 0) return true;
  if (error_.empty()) error_ = std::strerror(errno);
  file_.reset();
  std::remove(partial.c_str());
  return false;
}

}  // namespace framewatch::drivers
