#pragma once

#include <string>
#include <utility>
#include <vector>

namespace framewatch::fleet {

/// The buildings that a hub lets in, in `DIR/buildings`, a name a line, and the users.conf that its
/// servers read, which is made of them. Names ascend.
class UsersFile {
 public:
  explicit UsersFile(std::string directory) : directory_(std::move(directory)) {}

  /// Empty, or why the list cannot be read: with file and line.
  std::string read();
  const std::vector<std::string>& buildings() const { return buildings_; }
  bool has(const std::string& building) const;
  void add(const std::string& building);
  void remove(const std::string& building);
  /// Both files, each whole or not at all. Empty, or why not.
  std::string write() const;
  std::string users_path() const;

 private:
  std::string directory_;
  std::vector<std::string> buildings_;
};

/// Rule that the name of a building to be let in breaks; empty when it is good. Names of the hub's
/// own programs are none.
std::string problem_of_building(const std::string& name);

/// users.conf: what each certificate may do (docs/fleet.md).
std::string users_text(const std::vector<std::string>& buildings);

/// Replaces a file as a whole. Empty, or "PATH: why not".
std::string replace_file(const std::string& path, const std::string& text);

}  // namespace framewatch::fleet
