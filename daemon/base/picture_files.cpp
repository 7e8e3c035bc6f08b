// SPDX-License-Identifier: MIT
#include "daemon/base/picture_files.h"

#include <cctype>
#include <chrono>
#include <deque>
#include <filesystem>
#include <set>
#include <thread>

#include <fmt/core.h>

#include "daemon/base/process.h"
#include "drivers/files/text_output.h"

namespace framewatch::daemon {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kConvertersAtOnce = 2;
constexpr const char* kPixelsPerInch = "600";  // of PNG: what journals ask for line drawings
constexpr const char* kCssPixelsPerInch = "96";
constexpr int kNoSuchProgram = 127;  // exit code of env

/// Returns the picture's name as a file name that no picture before has.
std::string file_name(const std::string& name, std::set<std::string>& used) {
  std::string out;
  for (const char c : name)
    out += std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '.' ? c : '_';
  const std::string first = out;
  for (int i = 2; !used.insert(out).second; ++i) out = fmt::format("{}-{}", first, i);
  return out;
}

/// Runs rsvg-convert for many files, some at once.
class Converters {
 public:
  /// Starts a conversion, after others have ended if need be.
  void convert(const std::string& from, const std::string& to, const std::string& format) {
    wait(kConvertersAtOnce - 1);
    if (!problem_.empty()) return;
    // Without a date in the file, the same picture has the same bytes.
    std::string error;
    const char* density = format == "png" ? kPixelsPerInch : kCssPixelsPerInch;
    auto child = ChildProcess::start(
        {"SOURCE_DATE_EPOCH=0", "rsvg-convert", "--format", format, "--dpi-x", density, "--dpi-y",
         density, "--background-color", "white", "--output", to, from},
        error, "/usr/bin/env");
    if (!child)
      problem_ = "rsvg-convert: " + error;
    else
      running_.push_back(*child);
  }

  /// Waits until at most `most` conversions run.
  void wait(std::size_t most) {
    while (running_.size() > most) {
      const auto code = running_.front().ended();
      if (!code) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        continue;
      }
      running_.pop_front();
      if (*code == kNoSuchProgram)
        problem_ = "pictures need the program rsvg-convert: install the package librsvg2-bin";
      else if (*code != 0)
        problem_ = fmt::format("rsvg-convert ended with exit code {}", *code);
    }
  }

  const std::string& problem() const { return problem_; }

 private:
  std::deque<ChildProcess> running_;
  std::string problem_;
};

std::string write_all(const std::vector<Picture>& pictures, const std::string& folder,
                      const std::vector<std::string>& formats) {
  std::set<std::string> used;
  std::vector<std::string> drawings;
  Converters converters;
  for (const Picture& picture : pictures) {
    const std::string path = folder + "/" + file_name(picture.name, used);
    std::string problem = drivers::write_text_file(path + ".csv", picture.plot.csv());
    if (!problem.empty()) return problem;
    for (const auto& [suffix, width_mm] :
         {std::pair("-1col", kOneColumn_mm), std::pair("-2col", kTwoColumns_mm)}) {
      drawings.push_back(path + suffix + ".drawing");
      problem = drivers::write_text_file(drawings.back(), picture.plot.document(width_mm));
      if (!problem.empty()) return problem;
      for (const std::string& format : formats)
        converters.convert(drawings.back(), path + suffix + "." + format, format);
    }
  }
  converters.wait(0);
  std::error_code error;
  for (const std::string& drawing : drawings) fs::remove(drawing, error);
  return converters.problem();
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
