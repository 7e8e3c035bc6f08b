// SPDX-License-Identifier: MIT
#include "daemon/tools/report/report_about.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>

#include "daemon/base/html_page.h"

namespace framewatch::daemon {
namespace report_about_test {

class ReportAboutTest : public testing::Test {
 protected:
  ReportAboutTest() {
    char name[] = "/tmp/framewatch-about-XXXXXX";
    directory_ = ::mkdtemp(name);
  }
  ~ReportAboutTest() override { std::filesystem::remove_all(directory_); }

  std::string write(const std::string& name, const std::string& bytes) const {
    std::ofstream(directory_ + "/" + name, std::ios::binary) << bytes;
    return directory_ + "/" + name;
  }

  std::string directory_;
};

TEST_F(ReportAboutTest, ShowsPeopleAndPhotographs) {
  write("specimen.png", std::string("\x89PNG", 4));
  const std::string path = write("about.toml",
                                 "date = \"2026-11-28\"\nlaboratory = \"Lab <A>\"\nclient = \"C\"\n"
                                 "[[photograph]]\nfile = \"specimen.png\"\ncaption = \"A & B\"\n");
  std::vector<ConfigProblem> problems;
  const auto about = read_about(path, problems);
  ASSERT_TRUE(about) << problems[0].message;
  // 89 50 4E 47 in base64, by RFC 4648.
  EXPECT_NE(photograph_section(*about).find("data:image/png;base64,iVBORw==\" alt=\"A &amp; B\""),
            std::string::npos)
      << photograph_section(*about);
  const std::string head = about_section(*about);
  EXPECT_NE(head.find("2026-11-28"), std::string::npos);
  EXPECT_NE(head.find("Lab &lt;A&gt;"), std::string::npos);
  EXPECT_EQ(head.find("author"), std::string::npos) << "not given";
  EXPECT_EQ(about_section({}) + photograph_section({}), "");
}

TEST_F(ReportAboutTest, NamesEveryProblem) {
  write("text.png", "not a picture");
  const std::string path = write(
      "about.toml",
      "clinet = \"C\"\n[[photograph]]\nfile = \"text.png\"\n[[photograph]]\nfile = \"no.jpg\"\n");
  std::vector<ConfigProblem> problems;
  EXPECT_FALSE(read_about(path, problems));
  ASSERT_EQ(problems.size(), 3u);
  EXPECT_EQ(problems[0].where, path + ":1:1");
  EXPECT_NE(problems[1].message.find("neither JPEG nor PNG"), std::string::npos);
  EXPECT_NE(problems[2].message.find("no.jpg"), std::string::npos);
}

TEST(Contents, LinkEveryChapter) {
  EXPECT_EQ(with_contents("<h2>One</h2>\n<h3>x</h3>\n<h2>Two</h2>\n"),
            "<nav aria-label=\"contents\"><ol>\n<li><a href=\"#chapter-1\">One</a></li>\n<li><a "
            "href=\"#chapter-2\">Two</a></li>\n</ol></nav>\n<a id=\"chapter-1\"></a><h2>One</h2>\n"
            "<h3>x</h3>\n<a id=\"chapter-2\"></a><h2>Two</h2>\n");
}

}  // namespace report_about_test
}  // namespace framewatch::daemon
