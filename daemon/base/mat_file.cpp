// SPDX-License-Identifier: MIT
#include "daemon/base/mat_file.h"

#include <matio.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <memory>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

using Variable = std::unique_ptr<matvar_t, decltype(&Mat_VarFree)>;

}  // namespace

bool MatFile::matrix(const char* name, const std::vector<double>& values, std::size_t columns) {
  // MATLAB uses column-major order.
  const std::size_t rows = values.size() / columns;
  std::vector<double> turned(values.size());
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) turned[c * rows + r] = values[r * columns + c];
  std::array<std::size_t, 2> size{rows, columns};
  const Variable variable(
      Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), turned.data(), 0),
      &Mat_VarFree);
  return variable && Mat_VarWrite(file_, variable.get(), MAT_COMPRESSION_NONE) == 0;
}

bool MatFile::texts(const char* name, std::vector<std::string> texts) {
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
  return Mat_VarWrite(file_, cells.get(), MAT_COMPRESSION_NONE) == 0;
}

std::string write_mat_file(drivers::PartialFile& out, const std::function<bool(MatFile&)>& fill) {
  errno = 0;
  // matio's header contains the date, so a fixed header is used. /proc/self/fd opens the file
  // itself, not its name.
  const auto header = fmt::format("MATLAB 5.0 MAT-file, framewatch {}", FRAMEWATCH_VERSION);
  const auto name = fmt::format("/proc/self/fd/{}", out.descriptor());
  mat_t* const opened = Mat_CreateVer(name.c_str(), header.c_str(), MAT_FT_MAT5);
  MatFile file(opened);
  const bool good = opened != nullptr && fill(file);
  const bool closed = opened != nullptr && Mat_Close(opened) == 0;
  if (good && closed) return out.commit() ? "" : out.error();
  const std::string why = errno != 0 ? std::strerror(errno) : "cannot be written as a MATLAB file";
  out.discard();
  return why;
}

std::string write_mat_file(const std::string& path, const std::function<bool(MatFile&)>& fill) {
  drivers::PartialFile out;
  return out.open(path) ? write_mat_file(out, fill) : out.error();
}

}  // namespace framewatch::daemon
