// SPDX-License-Identifier: MIT
#include "daemon/base/picture_files.h"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

#include <gtest/gtest.h>

#include "daemon/base/svg_converter.h"

namespace framewatch::daemon {
namespace picture_files_test {

namespace fs = std::filesystem;

class PictureFilesTest : public testing::Test {
 protected:
  PictureFilesTest() {
    char name[] = "/tmp/framewatch-pictures-XXXXXX";
    directory_ = ::mkdtemp(name);
  }
  ~PictureFilesTest() override { fs::remove_all(directory_); }

  static std::vector<Picture> pictures() {
    SvgPlot plot("title", {"time, s"}, {"force, kN"});
    plot.add({"measured", 0, SvgMark::line, {0, 1}, {2, 3}});
    return {{"transfer-x", plot}, {"north wall", plot}, {"north/wall", plot}};
  }
  std::set<std::string> names() const {
    std::set<std::string> out;
    for (const auto& entry : fs::directory_iterator(directory_))
      out.insert(entry.path().filename());
    return out;
  }
  static std::string text_of(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
  }
  static bool can_convert() {
    std::string problem;
    return SvgConverter::load(problem).has_value();
  }

  std::string directory_;
};

TEST_F(PictureFilesTest, WritesEveryFormatInBothWidths) {
  if (!can_convert()) GTEST_SKIP() << "librsvg is not installed (librsvg2-2)";
  const std::string folder = directory_ + "/figures";
  ASSERT_EQ(write_pictures(pictures(), {folder, {"svg", "pdf", "png"}}), "");
  std::set<std::string> wanted;
  for (const char* name : {"transfer-x", "north_wall", "north_wall-2"}) {
    wanted.insert(std::string(name) + ".csv");
    for (const char* width : {"-1col", "-2col"})
      for (const char* format : {".svg", ".pdf", ".png"})
        wanted.insert(name + (width + std::string(format)));
  }
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(folder)) found.insert(entry.path().filename());
  EXPECT_EQ(found, wanted);
  EXPECT_EQ(names(), std::set<std::string>{"figures"});
  EXPECT_EQ(text_of(folder + "/transfer-x.csv"),
            "series,time (s),force (kN)\nmeasured,0,2\nmeasured,1,3\n");
  // 85 mm are 240.94 points, and 2008 pixels at 600 per inch: bytes 16 to 19 of a PNG.
  const std::string pdf = text_of(folder + "/transfer-x-1col.pdf");
  EXPECT_NE(pdf.find("240.94"), std::string::npos);
  EXPECT_NE(pdf.find("/FontFile"), std::string::npos);
  const std::string png = text_of(folder + "/transfer-x-1col.png");
  ASSERT_GT(png.size(), 20u);
  EXPECT_EQ(static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]), 2008);
  const std::string svg = text_of(folder + "/transfer-x-1col.svg");
  EXPECT_EQ(svg.find("<text"), std::string::npos);
  EXPECT_NE(svg.find("width=\"321."), std::string::npos) << "85 mm at 96 per inch";
}

TEST_F(PictureFilesTest, RefusesAFolderWithFilesAndLeavesIt) {
  std::ofstream(directory_ + "/mine.txt") << "x";
  EXPECT_EQ(write_pictures(pictures(), {directory_, {"svg"}}),
            directory_ + ": exists and is not empty; name a new folder for the pictures");
  EXPECT_EQ(names(), std::set<std::string>{"mine.txt"});
}

TEST_F(PictureFilesTest, SamePictureHasTheSameBytes) {
  if (!can_convert()) GTEST_SKIP() << "librsvg is not installed (librsvg2-2)";
  for (const char* folder : {"/one", "/other"})
    ASSERT_EQ(write_pictures(pictures(), {directory_ + folder, {"svg", "pdf", "png"}}), "");
  for (const auto& entry : fs::directory_iterator(directory_ + "/one"))
    EXPECT_EQ(text_of(entry.path()),
              text_of(directory_ + "/other/" + entry.path().filename().string()))
        << entry.path();
}

TEST_F(PictureFilesTest, SaysWhatFailedAndLeavesNothing) {
  std::string problem;
  const auto converter = SvgConverter::load(problem);
  if (!converter) {
    EXPECT_EQ(write_pictures(pictures(), {directory_ + "/figures", {"pdf"}}), problem);
    EXPECT_NE(problem.find("install the package librsvg2-2"), std::string::npos);
    EXPECT_EQ(names(), std::set<std::string>{});
    return;
  }
  const std::string absent = directory_ + "/absent/x.pdf";
  EXPECT_EQ(converter->convert(pictures()[0].plot.document(85), 321, 240, "pdf", absent)
                .rfind(absent + ": ", 0),
            0u);
  EXPECT_NE(converter->convert("<svg", 321, 240, "pdf", directory_ + "/x.pdf").find("librsvg: "),
            std::string::npos);
}

TEST(PageName, OtherFormatsAreRefused) {
  for (const char* good : {"report.html", "report.htm", "report", "/dev/stdout", "a.b/report"})
    EXPECT_EQ(problem_of_page_name(good), "") << good;
  EXPECT_EQ(problem_of_page_name("out/x.png"),
            "out/x.png: the page is HTML, not png; name it out/x.html");
  EXPECT_NE(problem_of_page_name("x.pdf"), "");
}

}  // namespace picture_files_test
}  // namespace framewatch::daemon
