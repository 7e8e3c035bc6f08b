// SPDX-License-Identifier: MIT
#include "daemon/base/picture_files.h"

#include <array>
#include <atomic>
#include <cctype>
#include <filesystem>
#include <set>
#include <thread>

#include <fmt/core.h>

#include "daemon/base/svg_converter.h"
#include "drivers/files/caught.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kThreads = 2;
constexpr double kPixelsPerMm = 96 / 25.4;

/// Returns the picture's name as a file name that no picture before has.
std::string file_name(const std::string& name, std::set<std::string>& used) {
  std::string out;
  for (const char c : name)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.' ? c : '_';
  const std::string first = out;
  for (int i = 2; !used.insert(out).second; ++i) out = fmt::format("{}-{}", first, i);
  return out;
}

/// A file to write.
struct Drawing {
  const SvgPlot* plot;
  double width_mm;
  std::string format, path;
};

/// Writes files, several at once. Returns an empty string, or the reason of a failure.
std::string draw_all(const SvgConverter& converter, const std::vector<Drawing>& drawings) {
  std::atomic<std::size_t> next = 0;
  std::array<std::string, kThreads> problems;
  const auto work = [&](std::string& problem) {
    for (std::size_t i = next++; i < drawings.size() && problem.empty(); i = next++) {
      const Drawing& d = drawings[i];
      const double width_px = kPixelsPerMm * d.width_mm;
      problem = converter.convert(d.plot->document(d.width_mm), width_px, d.plot->height(),
                                  d.format, d.path);
    }
  };
  std::vector<std::thread> others;
  for (std::size_t t = 1; t < kThreads; ++t)
    others.emplace_back([&, t] {
      if (const std::string thrown = drivers::caught([&] { work(problems[t]); }); !thrown.empty())
        problems[t] = thrown;
    });
  work(problems[0]);
  for (std::thread& thread : others) thread.join();
  return problems[0].empty() ? problems[1] : problems[0];
}

std::string write_all(const std::vector<Picture>& pictures, const std::string& folder,
                      const std::vector<std::string>& formats) {
  std::string problem;
  const auto converter = SvgConverter::load(problem);
  if (!converter) return problem;
  std::set<std::string> used;
  std::vector<Drawing> drawings;
  for (const Picture& picture : pictures) {
    const std::string path = folder + "/" + file_name(picture.name, used);
    problem = drivers::write_text_file(path + ".csv",
                                       picture.csv.empty() ? picture.plot.csv() : picture.csv);
    if (!problem.empty()) return problem;
    for (const std::string& format : formats) {
      drawings.push_back({&picture.plot, kOneColumn_mm, format, path + "-1col." + format});
      drawings.push_back({&picture.plot, kTwoColumns_mm, format, path + "-2col." + format});
    }
  }
  return draw_all(*converter, drawings);
}

}  // namespace

std::string write_pictures(const std::vector<Picture>& pictures, const PictureFiles& files) {
  std::string folder = files.folder;
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  std::error_code error;
  if (fs::exists(folder, error) && !fs::is_empty(folder, error))
    return folder + ": exists and is not empty; name a new folder for the pictures";
  if (error) return fmt::format("{}: {}", folder, error.message());
  const std::string partial = folder + ".partial";
  fs::remove_all(partial, error);
  if (!fs::create_directories(partial, error))
    return fmt::format("{}: cannot be made: {}", partial, error.message());
  const std::string problem = write_all(pictures, partial, files.formats);
  if (problem.empty()) {
    fs::rename(partial, folder, error);
    if (!error) return "";
  }
  std::error_code ignored;
  fs::remove_all(partial, ignored);
  return problem.empty() ? fmt::format("{}: {}", folder, error.message()) : problem;
}

std::string problem_of_page_name(const std::string& path) {
  const std::string ending = fs::path(path).extension().string();
  if (ending.empty() || ending == ".html" || ending == ".htm") return "";
  return fmt::format("{}: the page is HTML, not {}; name it {}", path, ending.substr(1),
                     fs::path(path).replace_extension(".html").string());
}

}  // namespace framewatch::daemon
