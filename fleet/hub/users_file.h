// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace framewatch::fleet {

/// The buildings that a hub admits: `DIR/buildings` with one name a line in ascending order, and
/// the users.conf of its servers, which is generated from them.
class UsersFile {
 public:
  explicit UsersFile(std::string directory) : directory_(std::move(directory)) {}

  /// Reads the list. Returns an empty text, or the problem with file and line.
  std::string read();
  const std::vector<std::string>& buildings() const { return buildings_; }
  bool has(const std::string& building) const;
  void add(const std::string& building);
  void remove(const std::string& building);
  /// Replaces both files, each atomically. Returns an empty text, or the problem.
  std::string write() const;
  std::string users_path() const;

 private:
  std::string directory_;
  std::vector<std::string> buildings_;
};

/// Returns the rule that the name of a building breaks; empty if the name is valid. Names of the
/// hub's programs are reserved.
std::string problem_of_building(const std::string& name);

/// Returns the text of users.conf: the permissions of each certificate (docs/fleet.md).
std::string users_text(const std::vector<std::string>& buildings);

/// Replaces a file atomically. Returns an empty text, or "PATH: problem".
std::string replace_file(const std::string& path, const std::string& text);

}  // namespace framewatch::fleet
