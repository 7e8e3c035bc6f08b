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
/// framewatch fleet person: gives a person a token for `fleet serve`, and prints it once; or takes
/// it back.
int person_command(const PersonArguments& arguments);

struct DescribeArguments {
  std::string building, database;
  std::optional<std::string> title, place;
  std::optional<std::string> network, station;  ///< codes of SEED
  std::optional<double> latitude, longitude;
  bool retired = false, not_retired = false;
};
/// framewatch fleet describe: what people say of a building, in the database.
int describe_command(const DescribeArguments& arguments);

}  // namespace framewatch::fleet
