// SPDX-License-Identifier: MIT
#include "daemon/base/toml_document.h"

#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace toml_document_test {

constexpr int kDeep = 100'000;  // nested this deep, the parser's stack overflows

std::string key_of(int parts) {
  std::string key = "a";
  for (int i = 1; i < parts; ++i) key += ".a";
  return key;
}

/// Returns the only problem of a text with its place.
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

TEST(TomlDocument, AcceptsPointsOutsideOfKeys) {
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

namespace toml_advice_test {

struct Mistake {
  const char* text;
  int line, column;
  const char* words;
};

const Mistake kMistakes[] = {
    {"a = 1\nname = \u201cTower\u201d\n", 2, 8, "a curly quote"},
    {"a = \u2018x\u2019\n", 1, 5, "a curly quote"},
    {"[channel]\na = 1\n[channel]\na = 2\n", 3, 1, "write [[channel]], in double brackets"},
    {"a =\n", 1, 4, "nothing stands after the ="},
    {"a = 1,5\n", 1, 6, "a point, not a comma: write 1.5"},
    {"a = True\n", 1, 5, "true or false, in lower case"},
    {"a = 1 ; half\n", 1, 7, "a remark begins with #"},
    {"[structure\n", 1, 11, "the ] is missing"},
    {"stories 3\n", 1, 9, "neither a [section] nor a line of the form key = value"},
    {"name = \"Tower\n", 1, 14, "the \" is missing"},
    {"floor = rigid\n", 1, 9, "a text stands between quotes: \"rigid\""},
};

TEST(TomlAdvice, ExplainsKnownMistakes) {
  for (const Mistake& m : kMistakes) {
    std::vector<TextProblem> problems;
    EXPECT_FALSE(parse_toml(m.text, problems).has_value()) << m.text;
    ASSERT_EQ(problems.size(), 1u) << m.text;
    EXPECT_NE(problems[0].message.find(m.words), std::string::npos)
        << m.text << problems[0].message;
    EXPECT_EQ(problems[0].place.line, m.line) << m.text;
    EXPECT_EQ(problems[0].place.column, m.column) << m.text << problems[0].message;
  }
}

TEST(TomlAdvice, RepeatsTheParserForUnknownMistakes) {
  int column = 3;
  EXPECT_EQ(toml_advice("leading zeroes are prohibited", "a = 01", column),
            "leading zeroes are prohibited");
  EXPECT_EQ(column, 3);
}

TEST(TomlAdvice, AcceptsCurlyQuotesInTextsAndComments) {
  std::vector<TextProblem> problems;
  EXPECT_TRUE(
      parse_toml("a = \"the \u201ctower\u201d\"  # \u201cso\u201d\n", problems).has_value());
  EXPECT_TRUE(problems.empty());
}

}  // namespace toml_advice_test

}  // namespace framewatch::daemon
