// SPDX-License-Identifier: MIT
#pragma once

#include <libmseed.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

namespace framewatch::test {

/// Samples of one channel without a gap, in the format of other recorders.
struct SeedSpan {
  std::string location = "01", channel = "HN1";
  std::int64_t start_us = 0;
  double rate_hz = 100;
  int encoding = DE_STEIM2, byte_order = 1;
  std::vector<double> values;
  int record_bytes = 512;
  bool microseconds = true;  ///< blockette 1001; else times are multiples of 100 us
};

inline void append_record(char* record, int length, void* to) {
  static_cast<std::string*>(to)->append(record, static_cast<std::size_t>(length));
}

/// Returns miniSEED 2 of station XX.TEST. Samples are rounded if the encoding needs integers.
inline std::string miniseed(const SeedSpan& span) {
  std::string out;
  MSRecord* record = msr_init(nullptr);
  std::strcpy(record->network, "XX");
  std::strcpy(record->station, "TEST");
  std::strcpy(record->location, span.location.c_str());
  std::strcpy(record->channel, span.channel.c_str());
  record->dataquality = 'D';
  record->reclen = span.record_bytes;
  record->starttime = span.start_us;
  record->samprate = span.rate_hz;
  record->encoding = static_cast<flag>(span.encoding);
  record->byteorder = static_cast<flag>(span.byte_order);
  record->numsamples = static_cast<std::int64_t>(span.values.size());
  std::vector<std::int32_t> integers(span.values.begin(), span.values.end());
  std::vector<float> floats(span.values.begin(), span.values.end());
  std::vector<double> doubles = span.values;
  std::string text(span.values.size(), 'x');
  record->sampletype = 'i';
  record->datasamples = integers.data();
  if (span.encoding == DE_FLOAT32) record->sampletype = 'f', record->datasamples = floats.data();
  if (span.encoding == DE_FLOAT64) record->sampletype = 'd', record->datasamples = doubles.data();
  if (span.encoding == DE_ASCII) record->sampletype = 'a', record->datasamples = text.data();
  blkt_1001_s fraction{};
  if (span.microseconds)
    msr_addblockette(record, reinterpret_cast<char*>(&fraction), sizeof fraction, 1001, 0);
  std::int64_t packed = 0;
  msr_pack(record, &append_record, &out, &packed, 1, 0);
  record->datasamples = nullptr;
  msr_free(&record);
  return out;
}

}  // namespace framewatch::test
