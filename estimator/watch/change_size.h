// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "estimator/motion/sample.h"
#include "estimator/structure/parameter_table.h"

namespace framewatch::estimator {

/// The size of a lasting change: the mean deviation from the baseline of windows that lie wholly
/// behind the change and do not overlap, weighted with 1 / error^2 (docs/equations.md (43)). The
/// error of the mean follows from the windows' scatter, because their own errors are cautious. One
/// window that lies kFar errors from the mean is left out. Two in a row on the same side restart
/// the mean, because the element has changed further.
class ChangeSize {
 public:
  static constexpr double kFar = 5;
  /// The scatter of a few windows is uncertain: this many windows that scatter as their errors
  /// predict are added to it.
  static constexpr double kPriorWindows = 4;
  static constexpr double kMinExcess = 0.5;

  /// Adds a window that does not overlap earlier ones. ratio: its deviation from the baseline,
  /// relative. std_error: > 0. common_error: >= 0, the error that all windows share and no mean
  /// reduces. Returns true when the mean was restarted.
  bool push(double ratio, double std_error, double common_error = 0);
  /// Adds a window to the mean without the test of push().
  void add(double ratio, double std_error, double common_error = 0);

  bool known() const { return mean_.weight > 0; }
  int count() const { return mean_.count; }
  /// Precondition of the next two: known(). The standard error excludes that of the baseline.
  double ratio() const { return mean_.sum / mean_.weight; }
  double std_error() const;
  /// Returns the variance of the windows over what their errors predict, >= kMinExcess.
  double excess() const;

  void archive(auto& a) {
    for (Mean* m : {&mean_, &aside_}) {
      a.within(m->count, 0, a.kMaxCount / 1e7);
      a.finite(m->weight, m->sum, m->square, m->common);
    }
  }

 private:
  struct Mean {
    int count = 0;
    double weight = 0, sum = 0, square = 0, common = 0;
    void add(double ratio, double std_error, double common_error);
  };
  Mean mean_, aside_;  ///< aside_: a window that was far off
};

/// How the model's error affects a change. The design fixes how stiffness is shared among the
/// stories of a group. When one of them loses stiffness the shares differ, so the group's value
/// changes by more or less than its stiffness, and the values of other groups change, too.
struct ChangeModel {
  std::vector<double> own;   ///< by element: standard error of its change, over the change
  std::vector<double> leak;  ///< largest change of another element's value over the size, at
                             ///< [changed element * elements + other element]

  bool is_of(std::size_t elements) const {
    return own.size() == elements && leak.size() == elements * elements;
  }
};

/// Returns the default model: of elements that are identified one by one, or of groups.
ChangeModel usual_change_model(const ParameterTable& table);

/// Learns how much more the windows of an intact element scatter than their standard errors
/// predict: from one window to the next, which a mean reduces, and slowly, which it does not. Takes
/// windows of one length that do not overlap (docs/equations.md (43)).
class UsualScatter {
 public:
  static constexpr double kMinExcess = 0.35;

  /// Adds a window. off: its deviation from the baseline, relative; std_error: > 0. Ignores a
  /// window that overlaps the one before.
  void push(Time start, Time end, double off, double std_error);

  /// Returns the variance from window to window over what the errors predict, >= kMinExcess.
  double excess() const { return excess_ > kMinExcess ? excess_ : kMinExcess; }
  /// Returns the standard deviation of slow changes, relative to the baseline, >= 0.
  double slow() const;

  void archive(auto& a) {
    a(until_);
    a.within(group_, 0, kGroup);
    a.within(windows_, 0, a.kMaxCount);
    a.within(groups_, 0, a.kMaxCount);
    a.finite(last_off_, last_error_, excess_, weight_, sum_, slow_, chance_);
  }

 private:
  static constexpr int kGroup = 6;  ///< windows whose mean shows slow changes

  Time until_{};
  std::int64_t windows_ = 0, groups_ = 0;
  int group_ = 0;
  double last_off_ = 0, last_error_ = 0;
  double excess_ = 1;
  double weight_ = 0, sum_ = 0;  ///< of the group so far
  double chance_ = 0;            ///< variance of a group's mean by chance
  double slow_ = 0;              ///< variance beyond chance
};

/// An element's deviation from its baseline, relative, with its standard error > 0.
struct Deviation {
  double off, std_error;
};

/// Returns true if a common change describes the deviations better than separate changes, each of
/// which costs `price` in twice the log-likelihood. Returns false for fewer than two deviations.
bool are_alike(const std::vector<Deviation>& deviations, double price);

/// Finds the deviation that many elements share. Temperature, mass, and the scale or the clock of
/// the sensors change all elements alike, and so may an earthquake.
class CommonChange {
 public:
  /// Share of the elements that must agree with the common deviation.
  static constexpr double kAgree = 0.75;

  /// Holds at most `most` elements; further ones are ignored.
  explicit CommonChange(std::size_t most);

  void clear() { elements_.clear(); }
  /// Adds an element's deviation from its baseline, relative, with its standard error > 0.
  void add(double off, double std_error);

  struct Mean {
    double off = 0, std_error = 0;
    bool known = false;
  };
  /// Returns the weighted mean of the elements within three errors of the weighted median. Not
  /// known when fewer than `least` elements were added or fewer than kAgree of them agree.
  Mean mean(std::size_t least);

 private:
  struct Element {
    double off, std_error, weight;
  };
  std::size_t most_;
  std::vector<Element> elements_;
};

}  // namespace framewatch::estimator
