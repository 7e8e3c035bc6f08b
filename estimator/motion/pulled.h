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
    /// Computes the first item of `items`.
    explicit Iterator(Pulled& items) : items_(items), item_(items.next()) {}
    /// Returns the current item, valid until the next step.
    const Item& operator*() const { return *item_; }
    /// Computes the next item.
    Iterator& operator++() {
      item_ = items_.next();
      return *this;
    }
    /// Returns true after the last item.
    bool operator==(std::default_sentinel_t) const { return item_ == nullptr; }

   private:
    Pulled& items_;
    const Item* item_;
  };

  /// Keeps a reference to `source`, which must outlive this.
  explicit Pulled(Source& source) : source_(source) {}
  ~Pulled() {
    while (!ended_) next();
  }
  Pulled(const Pulled&) = delete;
  Pulled& operator=(const Pulled&) = delete;
  /// Computes the first item. Call it once.
  Iterator begin() { return Iterator(*this); }
  /// Returns the end of the loop.
  std::default_sentinel_t end() const { return {}; }

 private:
  const Item* next() {
    const Item* const item = source_.next();
    ended_ = item == nullptr;
    return item;
  }

  Source& source_;
  bool ended_ = false;
};

}  // namespace framewatch::estimator
