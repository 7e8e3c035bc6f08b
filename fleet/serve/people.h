// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::fleet {

/// A viewer may only view; an operator may also give commands to buildings.
enum class Role { viewer, operator_ };
const char* role_word(Role role);
std::optional<Role> role_of(std::string_view word);

struct Person {
  std::string name;
  Role role = Role::viewer;
  std::string token_sha256;  ///< 64 hexadecimal digits
};
/// Returns true for 1 to 64 letters, digits, . _ @ and -.
bool is_person_name(std::string_view name);

/// The people who may open the page, each with the SHA-256 of a token: a file of lines "NAME ROLE
/// SHA256"; # starts a comment. Tokens themselves are never stored.
class People {
 public:
  /// Reads the file. Returns an empty text, or "FILE:LINE: problem" for a malformed line or a name
  /// that occurs twice.
  std::string read(const std::string& path);
  /// Replaces the file atomically. Returns an empty text, or the problem.
  std::string write(const std::string& path) const;

  /// Adds a person or replaces the one of the same name.
  void put(Person person);
  /// Removes a person. Returns false if the name is unknown.
  [[nodiscard]] bool remove(const std::string& name);
  /// Returns the person with this token; nullptr if the token is unknown.
  const Person* of_token(const std::string& token) const;
  const std::vector<Person>& all() const { return people_; }

 private:
  std::vector<Person> people_;
};

}  // namespace framewatch::fleet
