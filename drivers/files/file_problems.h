#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "drivers/files/problem.h"

namespace framewatch::drivers {

/// Collects the problems of one file, the first kMax of them.
class FileProblems {
 public:
  static constexpr int kMax = 20;

  FileProblems(std::string path, std::vector<Problem>& problems)
      : path_(std::move(path)), problems_(&problems) {}

  /// Line 0 is the file as a whole.
  void add(std::int64_t line, const std::string& message);
  bool any() const { return count_ > 0; }
  bool full() const { return count_ >= kMax; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<Problem>* problems_;
  int count_ = 0;
};

/// A piece of a file as a message can show it: quoted, short, printable.
std::string show_text(std::string_view text);

}  // namespace framewatch::drivers
