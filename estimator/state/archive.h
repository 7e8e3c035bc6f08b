// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <deque>
#include <string>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include "estimator/state/abi.h"

namespace framewatch::estimator {

/// The format of what is written. Increase it whenever archive() of any class changes, and read the
/// older bytes where StateArchive::since() says that they are.
inline constexpr int kStateFormat = 18;

/// Types whose values are written as the bytes they have in memory.
template <typename T>
concept PlainState = std::is_arithmetic_v<T> || std::is_enum_v<T>;

/// The common part of StateWriter and StateReader: divides a value into plain ones. Derived defines
/// plain(T&), block(std::vector<T>&, bool any_size) and count(std::size_t), which returns the size
/// to use.
///
/// A type with state has archive(), which lists every member that outlives a call; the same list
/// serves for writing and for reading. Members that the constructor derives from the configuration
/// are left out, and so are members that are computed anew before they are read.
///
/// State comes from a file, so every value is checked as it is read. A vector keeps its number of
/// elements. Numbers that index or filter are archived with the functions below, which state their
/// range.
template <typename Derived>
class StateArchive {
 public:
  /// Archives values whose range does not matter.
  template <typename... T>
  void operator()(T&... values) {
    (item(values), ...);
  }
  /// Archives numbers and vectors and matrices of numbers. Refuses a value that is not finite or
  /// exceeds kMax.
  template <typename... T>
  void finite(T&... values) {
    (item(values), ...);
    if (!(all_finite(values) && ...)) self().refuse();
  }
  /// Archives a number. Refuses one outside least..most and leaves `value` as it was.
  template <typename T>
  void within(T& value, double least, double most) {
    T archived = value;
    item(archived);
    const auto number = static_cast<double>(archived);
    if (!(number >= least && number <= most)) return self().refuse();
    value = archived;
  }
  /// Archives a vector of numbers. Refuses one outside least..most.
  template <typename T>
  void each_within(std::vector<T>& values, double least, double most) {
    item(values);
    for (const T value : values)
      if (!(static_cast<double>(value) >= least && static_cast<double>(value) <= most))
        return self().refuse();
  }
  /// Archives a vector of variable length. The caller checks the length after reading.
  template <PlainState T>
  void any_size(std::vector<T>& values) {
    self().block(values, true);
  }

  /// Returns true if the bytes have at least this format.
  bool since(int format) const { return format_ >= format; }
  /// Returns the format of the bytes, for a reader of a part of them.
  int format() const { return format_; }

  static constexpr double kMax = 1e100;        ///< magnitude of any sum of squares of motion
  static constexpr double kMaxCount = 4.5e15;  ///< largest whole number: exact, far from overflow

 protected:
  int format_ = kStateFormat;

 private:
  Derived& self() { return static_cast<Derived&>(*this); }

  template <typename T>
  void item(T& value) {
    if constexpr (PlainState<T>)
      self().plain(value);
    else
      value.archive(self());
  }
  template <typename T>
  void item(std::vector<T>& values) {
    if constexpr (PlainState<T>) {
      self().block(values, false);
    } else {
      resize(values);
      for (T& value : values) item(value);
    }
  }
  void item(std::string& text) {
    std::vector<char> characters(text.begin(), text.end());
    self().block(characters, true);
    text.assign(characters.begin(), characters.end());
  }
  template <typename T>
  void item(std::deque<T>& values) {  // the configuration determines the size
    if (self().count(values.size()) != values.size()) return self().refuse();
    for (T& value : values) item(value);
  }
  template <typename T, std::size_t size>
  void item(std::array<T, size>& values) {
    for (T& value : values) item(value);
  }
  template <typename Clock, typename Duration>
  void item(std::chrono::time_point<Clock, Duration>& time) {
    std::int64_t ticks = time.time_since_epoch().count();
    within(ticks, -2 * kMaxCount, 2 * kMaxCount);
    time = std::chrono::time_point<Clock, Duration>(Duration(ticks));
  }
  template <int rows, int columns>
  void item(Eigen::Matrix<double, rows, columns>& matrix) {
    if (self().count(static_cast<std::size_t>(matrix.rows())) !=
            static_cast<std::size_t>(matrix.rows()) ||
        self().count(static_cast<std::size_t>(matrix.cols())) !=
            static_cast<std::size_t>(matrix.cols()))
      return self().refuse();
    for (Eigen::Index i = 0; i < matrix.size(); ++i) self().plain(matrix.data()[i]);
  }
  static bool all_finite(double value) { return std::abs(value) <= kMax; }
  template <int rows, int columns>
  static bool all_finite(const Eigen::Matrix<double, rows, columns>& matrix) {
    for (Eigen::Index i = 0; i < matrix.size(); ++i)
      if (!all_finite(matrix.data()[i])) return false;
    return true;
  }
  template <typename T>
  static bool all_finite(const T& values) {
    for (const double value : values)
      if (!all_finite(value)) return false;
    return true;
  }
  /// Compares the stored number of elements with that of `values`, whose elements the configuration
  /// builds. Refuses another number.
  template <typename T>
  void resize(std::vector<T>& values) {
    if (self().count(values.size()) != values.size()) self().refuse();
  }
};

/// Writes a state as bytes.
class StateWriter : public StateArchive<StateWriter> {
 public:
  static constexpr bool kReading = false;  ///< it writes
  /// Returns the bytes written up to now.
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

  /// Writes a plain value.
  template <PlainState T>
  void plain(const T& value) {
    put(&value, sizeof value);
  }
  /// Writes the number of elements and the elements.
  template <PlainState T>
  void block(const std::vector<T>& values, bool) {
    (void)count(values.size());
    put(values.data(), values.size() * sizeof(T));
  }
  /// Writes a number of elements and returns it.
  std::size_t count(std::size_t size) {
    const std::uint64_t stored = size;
    put(&stored, sizeof stored);
    return size;
  }
  /// Does nothing: a value that exists can be written.
  void refuse() {}
  /// Returns true: writing to memory does not fail.
  bool good() const { return true; }

 private:
  void put(const void* data, std::size_t size) {
    if (size == 0) return;
    const std::size_t at = bytes_.size();
    bytes_.resize(at + size);
    std::memcpy(bytes_.data() + at, data, size);
  }

  std::vector<std::uint8_t> bytes_;
};

/// Reads a state. Never reads beyond its bytes. When the bytes do not fit the objects, good()
/// returns false from then on, and the caller must discard these objects.
class StateReader : public StateArchive<StateReader> {
 public:
  static constexpr bool kReading = true;  ///< it reads
  /// Keeps a reference to `bytes`, which must outlive the reader. format: of the bytes.
  explicit StateReader(const std::vector<std::uint8_t>& bytes, int format = kStateFormat)
      : bytes_(bytes) {
    format_ = format;
  }

  /// Returns false after a value that does not fit.
  bool good() const { return good_; }
  /// Returns true if everything was read and no byte remains.
  bool whole() const { return good_ && at_ == bytes_.size(); }

  /// Reads a plain value.
  template <PlainState T>
  void plain(T& value) {
    if (!has(sizeof value)) return;
    if (std::is_same_v<T, bool> && bytes_[at_] > 1) return refuse();
    take(&value, sizeof value);
  }
  /// Reads elements. Refuses another number of them than `values` has, unless `any_size`.
  template <PlainState T>
  void block(std::vector<T>& values, bool any_size) {
    const std::size_t size = count(values.size());
    if (size > (bytes_.size() - at_) / sizeof(T)) return refuse();
    if (!good_ || (!any_size && size != values.size())) return refuse();
    values.resize(size);
    if (size > 0) take(values.data(), size * sizeof(T));
  }
  /// Reads a count and returns it. Refuses one above the number of remaining bytes and returns 0:
  /// every element takes at least one byte.
  std::size_t count(std::size_t) {
    std::uint64_t stored = 0;
    plain(stored);
    if (stored > bytes_.size() - at_) refuse();
    return good_ ? static_cast<std::size_t>(stored) : 0;
  }
  /// Marks the bytes as unfit: good() returns false from now on.
  void refuse() { good_ = false; }

 private:
  bool has(std::size_t size) {
    good_ = good_ && size <= bytes_.size() - at_;
    return good_;
  }
  void take(void* to, std::size_t size) {
    std::memcpy(to, bytes_.data() + at_, size);
    at_ += size;
  }

  const std::vector<std::uint8_t>& bytes_;
  std::size_t at_ = 0;
  bool good_ = true;
};

/// A base class for state behind an interface: archive() calls save() or load() of the derived
/// class.
class SavedByVirtual {
 public:
  virtual ~SavedByVirtual() = default;
  /// Writes the state.
  virtual void save(StateWriter& state) = 0;
  /// Reads the state.
  virtual void load(StateReader& state) = 0;
  /// Calls save().
  void archive(StateWriter& state) { save(state); }
  /// Calls load().
  void archive(StateReader& state) { load(state); }
};

}  // namespace framewatch::estimator
