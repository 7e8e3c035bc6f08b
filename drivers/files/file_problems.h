// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace framewatch::drivers {

/// One thing that is wrong with a file.
struct Problem {
  std::string where;    ///< "rec.csv:12", or "rec.csv" for the whole file
  std::string message;  ///< the rule that it breaks
};

/// Collects the problems of one file, at most kMax of them.
class FileProblems {
 public:
  static constexpr int kMax = 20;

  /// Problems are appended to `problems`, which must outlive this object.
  FileProblems(std::string path, std::vector<Problem>& problems)
      : path_(std::move(path)), problems_(&problems) {}

  /// Adds a problem at a line, counted from 1; line 0 stands for the whole file. Problems beyond
  /// kMax are dropped, after a note that says so. Returns nullopt, for readers that end with it.
  std::nullopt_t add(std::int64_t line, const std::string& message);
  bool any() const { return count_ > 0; }
  bool full() const { return count_ >= kMax; }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
  std::vector<Problem>* problems_;
  int count_ = 0;
};

/// Returns `text` as a message can show it: in quotes, at most 40 characters, with "?" for
/// unprintable ones.
std::string show_text(std::string_view text);

}  // namespace framewatch::drivers
