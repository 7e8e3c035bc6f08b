#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "drivers/files/file_problems.h"

struct _mat_t;
struct matvar_t;

namespace framewatch::drivers {

/// A variable of a MATLAB file, or a field of a struct that is not an array.
struct MatVariable {
  std::string name;   ///< "acc", or "run.acc" of a field
  std::string shape;  ///< for people: "5000 x 3 double", "1 x 4 char"
  std::size_t rows = 0, columns = 0;
  bool is_numbers = false;    ///< real numbers, dense, in two dimensions, not empty
  bool may_be_meant = false;  ///< numbers of another kind: complex, sparse, of more dimensions

  std::size_t top = 0;         ///< for MatFileReader: the variable of the file it belongs to
  matvar_t* holder = nullptr;  ///< and where its numbers are
};

/// A MATLAB file, level 5 or 7.3, through libmatio, which is told the file that is open, not its
/// name.
class MatFileReader {
 public:
  /// Every variable, without its values, once. Empty with a problem when the file is damaged or cut
  /// off, has more than 10,000 variables or structs in one another deeper than 8.
  std::optional<std::vector<MatVariable>> variables(FileProblems& problems);
  /// Reads the numbers of a variable that has some. False with a problem.
  [[nodiscard]] bool load(const MatVariable& variable, FileProblems& problems);
  /// One of them; they stand column after column. Precondition: load() has read them.
  static double number(const MatVariable& variable, std::size_t index);

  explicit MatFileReader(FileProblems& problems);
  ~MatFileReader();
  MatFileReader(const MatFileReader&) = delete;
  MatFileReader& operator=(const MatFileReader&) = delete;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace framewatch::drivers
