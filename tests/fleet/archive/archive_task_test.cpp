// SPDX-License-Identifier: MIT
#include "fleet/archive/archive_task.h"

#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/temporary.h"

namespace framewatch::fleet {
namespace archive_task_test {

const std::string kKey = "0123456789ab-00112233ffff-deadbeef0000";

ArchiveTask example(int number = 1) {
  ArchiveTask task;
  task.number = number;
  task.key = kKey;
  task.config = "/etc/a building.toml";
  task.out = "/out/20260101T000000Z";
  task.warm_up_us = -5'000'000;
  task.from_us = 0;
  task.to_us = 172'800'000'000;
  task.logs = {"/h/raw/one.lcmlog.zst", "/h/raw/two, and more.lcmlog"};
  return task;
}

TEST(ArchiveTask, ReadsBackItsLine) {
  const std::string line = manifest_line(example());
  EXPECT_TRUE(line.ends_with('\n'));
  std::string problem;
  const auto read = read_manifest_line(line.substr(0, line.size() - 1), problem);
  ASSERT_TRUE(read) << problem;
  EXPECT_EQ(*read, example());
}

TEST(ArchiveTask, RefusesMalformedLinesWithTheRule) {
  const std::string times = "\t0\t0\t1";
  const std::pair<std::string, std::string> bad[] = {
      {"", "1 words between tabs"},
      {"1\t" + kKey + "\tc\to\t0\t0\t1", "7 words between tabs"},
      {"0\t" + kKey + "\tc\to" + times + "\tlog", "is not the number of a task"},
      {"x\t" + kKey + "\tc\to" + times + "\tlog", "is not the number of a task"},
      {"99999999999\t" + kKey + "\tc\to" + times + "\tlog", "is not the number of a task"},
      {"1\tkey\tc\to" + times + "\tlog", "key: is not a key"},
      {"1\t0123456789AB-00112233ffff-deadbeef0000\tc\to" + times + "\tlog", "is not a key"},
      {"1\t" + kKey + "\tc\to\t0\t0\tsoon\tlog", "soon: is not a time"},
      {"1\t" + kKey + "\tc\to\t1\t0\t2\tlog", "in the order warm-up"},
      {"1\t" + kKey + "\tc\to\t0\t2\t2\tlog", "in the order warm-up"},
      {"1\t" + kKey + "\t\to" + times + "\tlog", "a name is empty"}};
  for (const auto& [line, rule] : bad) {
    std::string problem;
    EXPECT_FALSE(read_manifest_line(line, problem)) << line;
    EXPECT_NE(problem.find(rule), std::string::npos) << line << ": " << problem;
  }
}

TEST(ArchiveTask, ReportsTheLineOfAManifestsError) {
  const test::TemporaryDirectory directory;
  const std::string path = directory.path("m.tsv");
  const auto refused = [&](const std::string& text) {
    test::write_file(path, text);
    std::string problem;
    EXPECT_FALSE(read_manifest(path, problem));
    return problem;
  };
  EXPECT_EQ(refused(manifest_line(example(1)) + manifest_line(example(3))),
            path + ":2: is numbered 3");
  EXPECT_EQ(refused(""), path + ": has no task");
  EXPECT_EQ(refused(manifest_line(example()) + "\n").find(path + ":2: 1 words"), 0u);
  std::string problem;
  EXPECT_FALSE(read_manifest(directory.path("none"), problem));
  EXPECT_NE(problem.find("none"), std::string::npos);
  test::write_file(path, manifest_line(example(1)) + manifest_line(example(2)));
  EXPECT_EQ(read_manifest(path, problem)->size(), 2u);
}

TEST(ArchiveTask, KeyCoversEverythingThatTheOutputDependsOn) {
  const std::string making = making_of(std::string(64, 'a'), std::string(64, 'b'));
  EXPECT_EQ(making, "aaaaaaaaaaaa-bbbbbbbbbbbb");
  const std::vector<std::string> digests{"1", "2"};
  const std::string key = task_key(making, example(), digests);
  EXPECT_EQ(key, task_key(making, example(), digests));
  EXPECT_TRUE(key.starts_with(making + "-"));
  ArchiveTask later = example();
  later.to_us += 1;
  EXPECT_NE(key, task_key(making, later, digests));
  EXPECT_NE(key, task_key(making, example(), {"1", "3"}));
  EXPECT_NE(key,
            task_key(making_of(std::string(64, 'c'), std::string(64, 'b')), example(), digests));
  ArchiveTask elsewhere = example();
  elsewhere.out = "/elsewhere";
  EXPECT_EQ(key, task_key(making, elsewhere, digests));
}

}  // namespace archive_task_test
}  // namespace framewatch::fleet
