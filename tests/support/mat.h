// SPDX-License-Identifier: MIT
#pragma once

#include <matio.h>

#include <memory>
#include <string>
#include <vector>

namespace framewatch::test {

/// Writes a MATLAB file, level 5 or 7.3, with variables of every kind.
class MatWriter {
 public:
  explicit MatWriter(const std::string& path, mat_ft level = MAT_FT_MAT5,
                     matio_compression compression = MAT_COMPRESSION_NONE)
      : file_(Mat_CreateVer(path.c_str(), nullptr, level)), compression_(compression) {}
  ~MatWriter() { Mat_Close(file_); }
  MatWriter(const MatWriter&) = delete;
  MatWriter& operator=(const MatWriter&) = delete;

  /// `values` are column by column.
  MatWriter& add(const char* name, const std::vector<double>& values, std::size_t rows,
                 std::size_t columns) {
    return write(array(name, values, rows, columns));
  }
  MatWriter& add_column(const char* name, const std::vector<double>& values) {
    return add(name, values, values.size(), 1);
  }
  MatWriter& add_text(const char* name, std::string text) {
    std::vector<std::size_t> size{1, text.size()};
    return write(Mat_VarCreate(name, MAT_C_CHAR, MAT_T_UTF8, 2, size.data(), text.data(), 0));
  }
  template <typename Number>
  MatWriter& add_as(const char* name, matio_classes kind, matio_types type,
                    std::vector<Number> values, int options = 0) {
    std::vector<std::size_t> size{values.size(), 1};
    return write(Mat_VarCreate(name, kind, type, 2, size.data(), values.data(), options));
  }
  MatWriter& add_complex(const char* name, std::vector<double> values) {
    std::vector<std::size_t> size{values.size(), 1};
    mat_complex_split_t parts{values.data(), values.data()};
    return write(
        Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), &parts, MAT_F_COMPLEX));
  }
  MatWriter& add_struct(const char* name, const std::vector<const char*>& fields,
                        const std::vector<std::vector<double>>& columns) {
    std::vector<std::size_t> size{1, 1};
    matvar_t* made =
        Mat_VarCreateStruct(name, 2, size.data(), const_cast<const char**>(fields.data()),
                            static_cast<unsigned>(fields.size()));
    for (std::size_t i = 0; i < fields.size(); ++i)
      Mat_VarSetStructFieldByName(made, fields[i], 0,
                                  array(nullptr, columns[i], columns[i].size(), 1));
    return write(made);
  }

 private:
  static matvar_t* array(const char* name, std::vector<double> values, std::size_t rows,
                         std::size_t columns) {
    std::vector<std::size_t> size{rows, columns};
    return Mat_VarCreate(name, MAT_C_DOUBLE, MAT_T_DOUBLE, 2, size.data(), values.data(), 0);
  }
  MatWriter& write(matvar_t* variable) {
    Mat_VarWrite(file_, variable, compression_);
    Mat_VarFree(variable);
    return *this;
  }

  mat_t* file_;
  matio_compression compression_;
};

}  // namespace framewatch::test
