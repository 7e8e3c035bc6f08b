// SPDX-License-Identifier: MIT
#pragma once

#include <iterator>

namespace framewatch::estimator {

/// The results of one call, to be read once by a loop: `for (const Item& item : source.push(x))`.
/// Each item is computed when the loop reaches it, and valid until the next. Items that are not
/// read are computed when this is destroyed, so the source ends in the same state. Source has
/// `const Item* next()`, which returns null when there is nothing left.
template <typename Source, typename Item>
class Pulled {
 public:
  /// Computes the next item at every step.
  class Iterator {
   public:
    /// Computes the first item of `source`.
    explicit Iterator(Source& source) : source_(source), item_(source.next()) {}
    /// Returns the current item, valid until the next step.
    const Item& operator*() const { return *item_; }
    /// Computes the next item.
    Iterator& operator++() {
      item_ = source_.next();
      return *this;
    }
    /// Returns true after the last item.
    bool operator==(std::default_sentinel_t) const { return item_ == nullptr; }

   private:
    Source& source_;
    const Item* item_;
  };

  /// Keeps a reference to `source`, which must outlive this.
  explicit Pulled(Source& source) : source_(source) {}
  ~Pulled() {
    while (source_.next() != nullptr) {
    }
  }
  Pulled(const Pulled&) = delete;
  Pulled& operator=(const Pulled&) = delete;
  /// Computes the first item. Call it once.
  Iterator begin() { return Iterator(source_); }
  /// Returns the end of the loop.
  std::default_sentinel_t end() const { return {}; }

 private:
  Source& source_;
};

}  // namespace framewatch::estimator
