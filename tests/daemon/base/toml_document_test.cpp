#include "daemon/base/toml_document.h"

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace toml_document_test {

constexpr int kDeep = 100'000;  // nested as deep, the parser's stack overflows

std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

/// The one problem of a text, and where it is.
std::string problem_of(const std::string& text) {
  std::vector<TextProblem> problems;
  EXPECT_FALSE(parse_toml(text, problems));
  if (problems.size() != 1) return std::to_string(problems.size()) + " problems";
  return std::to_string(problems[0].place.line) + ": " + problems[0].message;
}

TEST(TomlDocument, RefusesKeysThatNestTooDeep) {
  const std::string rule = "a key has at most 8 parts";
  EXPECT_EQ(problem_of("x = 1\n" + key_of(kDeep) + " = 1\n"), "2: " + rule);
  EXPECT_EQ(problem_of("[" + key_of(kDeep) + "]\n"), "1: " + rule);
  EXPECT_EQ(problem_of("x = \"\"\"\n\"\"\"\"\"\ny = {b = 1, " + key_of(kDeep) + " = 1}\n"),
            "3: " + rule);
  EXPECT_EQ(problem_of("x = {s = \"\"\"a\"\"\"\", " + key_of(kDeep) + " = 1}"), "1: " + rule);
  std::string tables = "x = ";
  for (int i = 0; i < kDeep; ++i) tables += "{a.a.a.a.a.a.a.a = ";
  EXPECT_EQ(problem_of(tables).substr(0, 3), "1: ");
}

TEST(TomlDocument, TakesPointsThatAreNoParts) {
  const std::string points(1000, '.');
  std::vector<TextProblem> problems;
  const auto document =
      parse_toml(key_of(8) + " = 1.5  # " + points + "\nx = \"" + points + "\"\ny = '" + points +
                     "'\nz = \"\"\"\n" + points + "\\\"\"\"\n" + points +
                     "\"\"\"\nl = [1.0, 2.0, 3.0, 1.0, 2.0, "
                     "3.0, 1.0, 2.0, 3.0, 4.0]\n",
                 problems);
  for (const TextProblem& p : problems) ADD_FAILURE() << p.place.line << ": " << p.message;
  ASSERT_TRUE(document);
  ASSERT_NE(document->find("x"), nullptr);
  EXPECT_EQ(document->find("x")->value.text, points);
}

}  // namespace toml_document_test
}  // namespace framewatch::daemon
