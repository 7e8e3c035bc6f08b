// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <string>

namespace framewatch::fleet {

struct PersonArguments {
  std::string name;
  std::string role = "viewer";
  std::string people = "people";  ///< file
  bool remove = false;
};
/// Runs `framewatch fleet person`: creates and prints a token of a person for `fleet serve`, or
/// removes the person. Returns the exit status.
int person_command(const PersonArguments& arguments);

struct DescribeArguments {
  std::string building, database;
  std::optional<std::string> title, place;
  std::optional<std::string> network, station;  ///< codes of SEED
  std::optional<double> latitude, longitude;
  bool retired = false, not_retired = false;
};
/// Runs `framewatch fleet describe`: stores the description of a building in the database. Returns
/// the exit status.
int describe_command(const DescribeArguments& arguments);

}  // namespace framewatch::fleet
