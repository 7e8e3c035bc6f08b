#include "daemon/estimates_mat.h"

#include <matio.h>

#include <array>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>

#include <fmt/core.h>

#include "daemon/estimates_csv.h"

namespace framewatch::daemon {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t kMostBytes = std::size_t{1} << 31;

using File = std::unique_ptr<mat_t, decltype(&Mat_Close)>;
using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

/// rows x columns from values in row-major order; MATLAB's is the other.
bool write_matrix(mat_t* file, const char* name, const std::vector<double>& values,
                  std::size_t columns) {
  const std::size_t rows = values.size() / columns;
  std::vector<double> turned(values.size());
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) turned[c * rows + r] = values[r * columns + c];
  std::array<std::size_t, 2> size{rows, columns};
  const Variable variable(
      Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), turned.data(), 0),
      &Mat_VarFree);
  return variable && Mat_VarWrite(file, variable.get(), MAT_COMPRESSION_NONE) == 0;
}

bool write_texts(mat_t* file, const char* name, std::vector<std::string> texts) {
  std::array<std::size_t, 2> size{texts.size(), 1};
  const Variable cells(Mat_VarCreate(name, MAT_C_CELL, MAT_T_CELL, 2, size.data(), nullptr, 0),
                       &Mat_VarFree);
  if (!cells) return false;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    std::array<std::size_t, 2> length{1, texts[i].size()};
    matvar_t* text =
        Mat_VarCreate(nullptr, MAT_C_CHAR, MAT_T_UTF8, 2, length.data(), texts[i].data(), 0);
    if (text == nullptr) return false;
    Mat_VarSetCell(cells.get(), static_cast<int>(i), text);
  }
  return Mat_VarWrite(file, cells.get(), MAT_COMPRESSION_NONE) == 0;
}

}  // namespace

bool EstimatesMatWriter::open(const std::string& path, const std::vector<std::string>& names,
                              const std::vector<std::string>& units, bool boxplot) {
  path_ = path;
  names_ = names;
  units_ = units;
  boxplot_ = boxplot;
  for (const char* name : {"value", "std_error", "observable"}) columns_.push_back({name, {}});
  if (boxplot)
    for (const char* name : {"q1", "median", "q3", "whisker_low", "whisker_high", "outliers"})
      columns_.push_back({name, {}});
  // So that a folder that is not there is told before the work.
  std::FILE* probe = std::fopen((path + ".partial").c_str(), "wbe");
  if (probe == nullptr) {
    error_ = std::strerror(errno);
    return false;
  }
  std::fclose(probe);
  std::remove((path + ".partial").c_str());
  return true;
}

bool EstimatesMatWriter::write(const window_estimate_t& e) {
  error_ = fault_of(e, names_.size());
  if (!error_.empty()) return false;
  if ((columns_[0].values.size() + names_.size()) * sizeof(double) > kMostBytes) {
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
  const std::string partial = path_ + ".partial";
  // A header of our own: matio's has the date in it.
  File file(
      Mat_CreateVer(partial.c_str(),
                    fmt::format("MATLAB 5.0 MAT-file, framewatch {}", FRAMEWATCH_VERSION).c_str(),
                    MAT_FT_MAT5),
      &Mat_Close);
  bool good = file != nullptr && write_texts(file.get(), "parameter", names_) &&
              write_texts(file.get(), "unit", units_) &&
              write_matrix(file.get(), "window_end_s", end_s_, 1) &&
              write_matrix(file.get(), "status", status_, 1);
  for (const Column& column : columns_)
    good = good && write_matrix(file.get(), column.name, column.values, names_.size());
  const bool closed = file != nullptr && Mat_Close(file.release()) == 0;
  if (good && closed && std::rename(partial.c_str(), path_.c_str()) == 0) return true;
  error_ = errno != 0 ? std::strerror(errno) : "cannot be written as a MATLAB file";
  std::remove(partial.c_str());
  return false;
}

}  // namespace framewatch::daemon
