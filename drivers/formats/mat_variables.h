// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "drivers/files/file_problems.h"

struct _mat_t;
struct matvar_t;

namespace framewatch::drivers {

/// Number of bytes at the start of a MATLAB file that tell its level.
inline constexpr std::size_t kMatHeaderBytes = 128;

enum class MatLevel { none, level_5, level_7_3 };

/// Returns the level of a MATLAB file that begins with `head`; none when it is not a MATLAB file.
/// The header states the byte order and the version, 0x0100 or 0x0200.
MatLevel mat_level(std::string_view head);

/// A variable of a MATLAB file, or a field of a struct that is not an array.
struct MatVariable {
  std::string name;   ///< "acc", or "run.acc" for a field
  std::string shape;  ///< for messages: "5000 x 3 double", "1 x 4 char"
  std::size_t rows = 0, columns = 0;
  bool is_numbers = false;    ///< real numbers, dense, in two dimensions, not empty
  bool may_be_meant = false;  ///< other numbers: complex, sparse, of more dimensions
  bool is_object = false;     ///< a table, timetable, string or other object

  std::size_t top = 0;         ///< for MatFileReader: index of the variable in the file
  matvar_t* holder = nullptr;  ///< for MatFileReader: holds the numbers
};

/// Reads a MATLAB file of level 5 or 7.3 through libmatio. libmatio gets the open file, not its
/// name, so the file cannot be exchanged in between. Call variables() once, then load() and
/// number().
class MatFileReader {
 public:
  /// Returns every variable without its values. Returns nullopt with a problem when the file is
  /// damaged or cut off, has more than 10,000 variables, or nests structs more than 8 deep.
  std::optional<std::vector<MatVariable>> variables(FileProblems& problems);
  /// Reads the numbers of a variable. Returns false with a problem when they are damaged or too
  /// many.
  [[nodiscard]] bool load(const MatVariable& variable, FileProblems& problems);
  /// Returns a number of a variable by its index, column after column. Precondition: load()
  /// succeeded.
  static double number(const MatVariable& variable, std::size_t index);

  /// Opens problems.path(). A file that cannot be opened becomes a problem.
  explicit MatFileReader(FileProblems& problems);
  ~MatFileReader();
  MatFileReader(const MatFileReader&) = delete;
  MatFileReader& operator=(const MatFileReader&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace framewatch::drivers
