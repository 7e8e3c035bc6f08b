#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace framewatch::fleet {

/// What a person may do: look, or give commands to buildings too.
enum class Role { viewer, operator_ };
const char* role_word(Role role);
std::optional<Role> role_of(std::string_view word);

struct Person {
  std::string name;
  Role role = Role::viewer;
  std::string token_sha256;  ///< 64 hexadecimal digits
};
/// 1 to 64 of letters, digits, . _ @ and -.
bool is_person_name(std::string_view name);

/// Who may open the page, each with the SHA-256 of a token: a file of lines "NAME ROLE SHA256", #
/// begins a remark. The tokens themselves are in no file.
class People {
 public:
  /// Reads the file; a line that is none, or a name that stands there twice, is a problem:
  /// "FILE:LINE: why". Empty: read.
  std::string read(const std::string& path);
  /// Replaces the file as a whole. Empty, or why not.
  std::string write(const std::string& path) const;

  /// Replaces one of the same name.
  void put(Person person);
  /// False when there is none of this name.
  [[nodiscard]] bool remove(const std::string& name);
  /// Null when the token is nobody's.
  const Person* of_token(const std::string& token) const;
  const std::vector<Person>& all() const { return people_; }

 private:
  std::vector<Person> people_;
};

}  // namespace framewatch::fleet
