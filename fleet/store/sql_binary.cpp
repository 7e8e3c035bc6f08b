#include <bit>
#include <cstring>

#include "fleet/store/database.h"

// Arrays of PostgreSQL in binary (src/backend/utils/adt/arrayfuncs.c, array_send): dimensions,
// whether there are nulls, the type of the elements, of each dimension size and first index, of
// each element its bytes and these; all big-endian, 4 bytes each.
namespace framewatch::fleet {
namespace {

constexpr std::size_t kWord = 4, kHead = 5 * kWord, kElement = 2 * kWord;

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t out = 0;
  for (std::size_t i = 0; i < kWord; ++i)
    out = out << 8 | static_cast<unsigned char>(bytes[at + i]);
  return out;
}

template <typename Value>
std::vector<Value> values_of(std::string_view array) {
  std::vector<Value> out;
  if (array.size() < kHead || word_at(array, 0) != 1 || word_at(array, kWord) != 0) return out;
  const std::size_t count = word_at(array, 3 * kWord);
  if (array.size() != kHead + count * kElement) return out;
  out.reserve(count);
  for (std::size_t at = kHead; at < array.size(); at += kElement) {
    if (word_at(array, at) != kWord) return {};
    out.push_back(std::bit_cast<Value>(word_at(array, at + kWord)));
  }
  return out;
}

}  // namespace

std::vector<std::int32_t> integers_of(std::string_view array) {
  return values_of<std::int32_t>(array);
}

std::vector<float> reals_of(std::string_view array) {
  return values_of<float>(array);
}

std::int64_t integer_of(std::string_view number) {
  if (number.size() == kWord) return static_cast<std::int32_t>(word_at(number, 0));
  if (number.size() != 2 * kWord) return 0;
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(word_at(number, 0)) << 32 |
                                   word_at(number, kWord));
}

}  // namespace framewatch::fleet
