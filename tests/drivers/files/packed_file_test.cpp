// SPDX-License-Identifier: MIT
#include "drivers/files/packed_file.h"

#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>
#include <zstd.h>

#include <atomic>
#include <memory>

#include <gtest/gtest.h>

#include "drivers/files/input_file.h"
#include "drivers/files/line_reader.h"
#include "tests/support/temporary.h"

namespace framewatch::drivers {
namespace packed_file_test {

using test::read_file;
using test::TemporaryDirectory;
using test::write_file;

constexpr std::int64_t kMiB = std::int64_t{1} << 20;
constexpr std::int64_t kBombBytes = 100 * kMiB;
constexpr const char* kRefusal = "unpacks to more than 64 MiB, from ";

/// Sets --max-size for one test.
struct MaxSize {
  explicit MaxSize(std::int64_t bytes) { set_unpack_limit(bytes); }
  ~MaxSize() { set_unpack_limit(0); }
};

void gzip_lines(const std::string& path, std::int64_t bytes) {
  gzFile file = gzopen(path.c_str(), "wb9");
  const std::string lines(static_cast<std::size_t>(kMiB), '\n');
  for (std::int64_t at = 0; at < bytes; at += kMiB)
    ASSERT_EQ(gzwrite(file, lines.data(), static_cast<unsigned>(kMiB)), kMiB);
  ASSERT_EQ(gzclose(file), Z_OK);
}

/// Reads every line and returns the problem.
std::string read_lines(const std::string& path, std::int64_t& lines) {
  std::vector<Problem> found;
  FileProblems problems(path, found);
  LineReader reader(problems);
  std::string_view line;
  for (lines = 0; reader.next(line);) ++lines;
  return found.empty() ? "" : found[0].message;
}

std::string zeros_in_zstd(std::int64_t bytes, int window_log2 = 0) {
  const std::unique_ptr<ZSTD_CCtx, decltype(&ZSTD_freeCCtx)> context(ZSTD_createCCtx(),
                                                                     &ZSTD_freeCCtx);
  if (window_log2 > 0) ZSTD_CCtx_setParameter(context.get(), ZSTD_c_windowLog, window_log2);
  const std::string zeros(static_cast<std::size_t>(kMiB), '\0');
  std::string out, part(ZSTD_CStreamOutSize(), '\0');
  for (std::int64_t at = 0; at <= bytes; at += kMiB) {
    const bool last = at == bytes;
    ZSTD_inBuffer input{zeros.data(), last ? 0 : zeros.size(), 0};
    for (std::size_t left = 1; left != 0 && (last || input.pos < input.size);) {
      ZSTD_outBuffer output{part.data(), part.size(), 0};
      left =
          ZSTD_compressStream2(context.get(), &output, &input, last ? ZSTD_e_end : ZSTD_e_continue);
      out.append(part.data(), output.pos);
      if (!last && input.pos == input.size) break;
    }
  }
  return out;
}

UnpackedFile unpack(const std::string& path) {
  InputFile file;
  EXPECT_TRUE(file.open(path));
  return unpack_zstd(file.descriptor());
}

TEST(UnpackLimit, IsFourThousandTimesTheFileWithin64MiBAnd4GiB) {
  EXPECT_EQ(unpack_limit(0), 64 * kMiB);
  EXPECT_EQ(unpack_limit(250'000), 1'000'000'000);
  EXPECT_EQ(unpack_limit(4'000'000'000), 4096 * kMiB);
  EXPECT_EQ(unpack_limit(INT64_MAX), 4096 * kMiB);
  const MaxSize asked(7);
  EXPECT_EQ(unpack_limit(0), 7);
  EXPECT_EQ(unpack_limit(INT64_MAX), 7);
}

TEST(UnpackLimit, HoldsForGzipUnlessRaised) {
  const TemporaryDirectory directory;
  const std::string path = directory.path("bomb.csv.gz");
  gzip_lines(path, 8 * kMiB);
  std::int64_t lines = 0;
  EXPECT_EQ(read_lines(path, lines), "");
  EXPECT_EQ(lines, 8 * kMiB);
  const MaxSize asked(2 * kMiB);
  const std::string refusal = read_lines(path, lines);
  EXPECT_EQ(refusal.find("unpacks to more than 2 MiB, from "), 0u) << refusal;
  EXPECT_NE(refusal.find("--max-size"), std::string::npos) << refusal;
  EXPECT_LE(lines, 2 * kMiB);
}

TEST(UnpackLimit, DoesNotApplyToPlainText) {
  const TemporaryDirectory directory;
  write_file(directory.path("plain"), std::string(10'000, '\n'));
  const MaxSize asked(100);
  std::int64_t lines = 0;
  EXPECT_EQ(read_lines(directory.path("plain"), lines), "");
  EXPECT_EQ(lines, 10'000);
}

TEST(UnpackLimit, HoldsForZstdUnlessRaised) {
  const TemporaryDirectory directory;
  const std::string path = directory.path("bomb.zst");
  write_file(path, zeros_in_zstd(kBombBytes));
  ASSERT_LT(read_file(path).size(), 20'000u);
  const UnpackedFile refused = unpack(path);
  EXPECT_EQ(refused.file, -1);
  EXPECT_EQ(refused.error.find(kRefusal), 0u) << refused.error;
  EXPECT_NE(refused.error.find("--max-size"), std::string::npos) << refused.error;
  EXPECT_LE(refused.bytes, 64 * kMiB + kMiB);
  const MaxSize asked(kBombBytes);
  const UnpackedFile allowed = unpack(path);
  EXPECT_EQ(allowed.error, "");
  EXPECT_EQ(allowed.damage, "");
  EXPECT_EQ(allowed.bytes, kBombBytes);
  ASSERT_GE(allowed.file, 0);
  ::close(allowed.file);
}

TEST(UnpackLimit, MemoryForZstdIsBounded) {
  const TemporaryDirectory directory;
  write_file(directory.path("long"), zeros_in_zstd(kMiB, kUnpackMemoryLog2 + 1));
  const UnpackedFile refused = unpack(directory.path("long"));
  EXPECT_EQ(refused.file, -1);
  EXPECT_EQ(refused.error, "needs more than 128 MiB of memory to be unpacked");
  write_file(directory.path("widest"), zeros_in_zstd(kMiB, kUnpackMemoryLog2));
  const UnpackedFile allowed = unpack(directory.path("widest"));
  EXPECT_EQ(allowed.bytes, kMiB) << allowed.error;
  ::close(allowed.file);
}

TEST(UnpackLimit, UnpacksOnlyFiles) {
  const TemporaryDirectory directory;
  const std::atomic<bool> stop{false};
  EXPECT_NE(pack_zstd("/dev/zero", directory.path("out"), stop).find("is a device, not a file"),
            std::string::npos);
  EXPECT_TRUE(directory.names().empty());
}

}  // namespace packed_file_test
}  // namespace framewatch::drivers
