// SPDX-License-Identifier: MIT
#include "daemon/base/miniseed_file.h"

#include <libmseed.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include <fmt/core.h>

namespace framewatch::daemon {
namespace {

constexpr std::size_t kMaxCounts = 65536;  // counts that wait for a record
constexpr int kRecordBytes = 512;
// Steim-2 holds differences of 30 bits.
constexpr std::int32_t kMaxCount = (1 << 28) - 1;

struct FreeRecord {
  void operator()(MSRecord* record) const {
    record->datasamples = nullptr;  // the record does not own them
    msr_free(&record);
  }
};

struct Sink {
  std::FILE* file;
  bool failed = false;
};

void write_record(char* record, int length, void* sink) {
  auto* out = static_cast<Sink*>(sink);
  const auto bytes = static_cast<std::size_t>(length);
  if (std::fwrite(record, 1, bytes, out->file) != bytes) out->failed = true;
}

void copy_code(char* to, const std::string& code) {
  to[code.copy(to, 10)] = '\0';
}

}  // namespace

SeedChannel seed_channel(const std::string& network, const std::string& station, std::size_t index,
                         double rate_hz) {
  constexpr const char* kDigits = "0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZ";
  const std::size_t number = index + 1;
  const std::string location = number < 100 ? fmt::format("{:02}", number)
                                            : std::string{kDigits[10 + (number - 100) / 36 % 26],
                                                          kDigits[(number - 100) % 36]};
  const char band = rate_hz >= 1000 ? 'F' : rate_hz >= 250 ? 'C' : rate_hz >= 80 ? 'H' : 'B';
  return {network, station, location, std::string{band, 'N', '1'}};
}

MiniseedFile::MiniseedFile(std::vector<SeedChannel> channels, double rate_hz)
    : channels_(std::move(channels)), rate_hz_(rate_hz), runs_(channels_.size()) {}

MiniseedFile::~MiniseedFile() {
  discard();
}

bool MiniseedFile::open(const std::string& path) {
  if (partial_.open(path)) file_ = partial_.stream();
  if (file_ == nullptr) error_ = partial_.error();
  return file_ != nullptr;
}

std::string MiniseedFile::seed_name(std::size_t channel) const {
  const SeedChannel& c = channels_[channel];
  return fmt::format("{}.{}.{}.{}", c.network, c.station, c.location, c.channel);
}

bool MiniseedFile::put(std::size_t channel, std::int64_t time_us, std::int32_t count) {
  Run& run = runs_[channel];
  const double due_us = 1e6 * static_cast<double>(run.counts.size()) / rate_hz_;
  const double off_us = static_cast<double>(time_us - run.start_us) - due_us;
  if ((std::abs(off_us) > 0.5e6 / rate_hz_ || run.counts.size() >= kMaxCounts) &&
      !write_run(channel))
    return false;
  if (run.counts.empty()) run.start_us = time_us;
  run.counts.push_back(std::clamp(count, -kMaxCount, kMaxCount));
  return true;
}

bool MiniseedFile::write_run(std::size_t channel) {
  Run& run = runs_[channel];
  if (run.counts.empty()) return true;
  const std::unique_ptr<MSRecord, FreeRecord> record(msr_init(nullptr));
  if (!record) {
    error_ = "no memory";
    return false;
  }
  const SeedChannel& c = channels_[channel];
  copy_code(record->network, c.network);
  copy_code(record->station, c.station);
  copy_code(record->location, c.location);
  copy_code(record->channel, c.channel);
  record->dataquality = 'D';
  record->reclen = kRecordBytes;
  record->starttime = run.start_us * (HPTMODULUS / 1'000'000);
  record->samprate = rate_hz_;
  record->encoding = DE_STEIM2;
  record->byteorder = 1;
  // Without it times are multiples of 100 us.
  blkt_1001_s microseconds{};
  if (msr_addblockette(record.get(), reinterpret_cast<char*>(&microseconds), sizeof microseconds,
                       1001, 0) == nullptr) {
    error_ = "no memory";
    return false;
  }
  record->datasamples = run.counts.data();
  record->numsamples = static_cast<std::int64_t>(run.counts.size());
  record->sampletype = 'i';
  Sink sink{file_};
  std::int64_t packed = 0;
  msr_pack(record.get(), &write_record, &sink, &packed, 1, 0);
  const bool good = !sink.failed && packed == record->numsamples;
  if (!good)
    error_ = sink.failed ? std::strerror(errno)
                         : fmt::format("{} cannot be packed as Steim-2", seed_name(channel));
  run.counts.clear();
  return good;
}

bool MiniseedFile::close() {
  if (file_ == nullptr) return false;
  for (std::size_t c = 0; c < channels_.size() && error_.empty(); ++c) (void)write_run(c);
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (error_.empty() && !closed) error_ = std::strerror(errno);
  if (error_.empty() && !partial_.commit()) error_ = partial_.error();
  discard();
  return error_.empty();
}

void MiniseedFile::discard() {
  if (file_ != nullptr) std::fclose(std::exchange(file_, nullptr));
  partial_.discard();
}

}  // namespace framewatch::daemon
