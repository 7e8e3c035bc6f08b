// SPDX-License-Identifier: MIT
#include "fleet/serve/people.h"

#include <algorithm>
#include <sstream>
#include <utility>

#include <fmt/core.h>

#include "daemon/base/file_digest.h"
#include "daemon/page/web/web_admission.h"
#include "drivers/files/number_text.h"
#include "fleet/hub/users_file.h"

namespace framewatch::fleet {
namespace {

constexpr std::size_t kLongestName = 64, kDigestDigits = 64;

bool is_digest(std::string_view text) {
  return text.size() == kDigestDigits &&
         text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

}  // namespace

const char* role_word(Role role) {
  return role == Role::operator_ ? "operator" : "viewer";
}

std::optional<Role> role_of(std::string_view word) {
  if (word == "viewer") return Role::viewer;
  if (word == "operator") return Role::operator_;
  return std::nullopt;
}

bool is_person_name(std::string_view name) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789._@-";
  return !name.empty() && name.size() <= kLongestName &&
         name.find_first_not_of(kAllowed) == std::string_view::npos;
}

std::string People::read(const std::string& path) {
  people_.clear();
  std::string error;
  const auto text = daemon::read_text_file(path, error);
  if (!text) return fmt::format("{}: {}", path, error);
  std::istringstream lines(*text);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::vector<std::string_view> words;
    drivers::split_blanks(std::string_view(line).substr(0, line.find('#')), words);
    if (words.empty() || (words.size() == 1 && words[0].empty())) continue;
    const auto problem = [&](const char* why) {
      people_.clear();
      return fmt::format("{}:{}: {}", path, number, why);
    };
    if (words.size() != 3) return problem("must be NAME ROLE SHA256");
    const auto role = role_of(words[1]);
    if (!is_person_name(words[0]))
      return problem("a name has 1 to 64 letters, digits, '.', '_', '@' and '-'");
    if (!role) return problem("a role is viewer or operator");
    if (!is_digest(words[2])) return problem("a SHA-256 has 64 digits of 0-9 and a-f");
    const bool twice = std::any_of(people_.begin(), people_.end(),
                                   [&](const Person& p) { return p.name == words[0]; });
    if (twice) return problem("this name occurs twice");
    people_.push_back({std::string(words[0]), *role, std::string(words[2])});
  }
  return {};
}

std::string People::write(const std::string& path) const {
  std::string text = "# Made by `framewatch fleet person`: NAME ROLE SHA256-OF-TOKEN\n";
  for (const Person& p : people_)
    text += fmt::format("{} {} {}\n", p.name, role_word(p.role), p.token_sha256);
  return replace_file(path, text);
}

void People::put(Person person) {
  (void)remove(person.name);
  people_.push_back(std::move(person));
}

bool People::remove(const std::string& name) {
  return std::erase_if(people_, [&](const Person& p) { return p.name == name; }) > 0;
}

const Person* People::of_token(const std::string& token) const {
  if (token.empty()) return nullptr;
  const std::string digest = daemon::sha256(token);
  const Person* found = nullptr;
  for (const Person& p : people_)
    if (daemon::same_token(digest, p.token_sha256)) found = &p;
  return found;
}

}  // namespace framewatch::fleet
