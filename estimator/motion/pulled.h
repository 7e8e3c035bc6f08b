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
  class Iterator {
   public:
    explicit Iterator(Source& source) : source_(source), item_(source.next()) {}
    const Item& operator*() const { return *item_; }
    Iterator& operator++() {
      item_ = source_.next();
      return *this;
    }
    bool operator==(std::default_sentinel_t) const { return item_ == nullptr; }

   private:
    Source& source_;
    const Item* item_;
  };

  explicit Pulled(Source& source) : source_(source) {}
  ~Pulled() {
    while (source_.next() != nullptr) {
    }
  }
  Pulled(const Pulled&) = delete;
  Pulled& operator=(const Pulled&) = delete;
  Iterator begin() { return Iterator(source_); }
  std::default_sentinel_t end() const { return {}; }

 private:
  Source& source_;
};

}  // namespace framewatch::estimator
