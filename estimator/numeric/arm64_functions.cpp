// SPDX-License-Identifier: MIT
// Functions whose last bits differ between the libraries of amd64 and arm64, for arm64 with the
// bits of amd64. Debian's libm and libgcc are compiled with fused multiply-add on arm64, and libm's
// hypot then takes another way. These definitions hide the libraries' within one program or shared
// library. tests/estimator/numeric/functions_test.cpp compares them with amd64.
//
// exp, log, pow and the trigonometric functions need none: on amd64 with FMA, libm fuses too. erf
// and erfc may differ by two in the last place; they only enter a pinching law of diagnose and the
// probability of a placard.
#ifdef __aarch64__

#include <cmath>
#include <limits>

namespace framewatch::estimator {
namespace {

/// Returns sqrt(a a + b b) for a >= b >= 0 whose squares neither overflow nor underflow: the
/// rounded root, corrected by the rounding error of its square (Borges, arXiv:1904.09481).
double corrected_root(double a, double b) {
  const double root = std::sqrt(a * a + b * b);
  const bool comparable = root <= 2.0 * b;
  const double over = root - (comparable ? b : a);
  const double first = comparable ? a * (2.0 * over - a) : 2.0 * over * (a - 2.0 * b);
  const double second =
      comparable ? (over - 2.0 * (a - b)) * over : (4.0 * over - b) * b + over * over;
  return root - (first + second) / (2.0 * root);
}

double length_of(double x, double y) {
  if (!std::isfinite(x) || !std::isfinite(y))
    return std::isinf(x) || std::isinf(y) ? std::numeric_limits<double>::infinity() : x + y;
  x = std::abs(x), y = std::abs(y);
  const double a = x < y ? y : x, b = x < y ? x : y;
  const bool huge = a > 0x1p+511, tiny = b < 0x1p-459;
  const bool alone = tiny && !huge ? a >= b / 0x1p-54 : b <= a * 0x1p-54;
  if (alone) return a + b;
  const double scale = huge ? 0x1p-600 : tiny ? 0x1p+600 : 1;
  return corrected_root(a * scale, b * scale) / scale;
}

struct Quotient {
  double re, im;
};

/// Returns (a + i b) / (c + i d), by the ratio of the divisor's smaller part to its larger one
/// (Smith).
Quotient divided(double a, double b, double c, double d) {
  const bool turned = std::abs(c) < std::abs(d);
  const double larger = turned ? d : c, smaller = turned ? c : d;
  const double ratio = smaller / larger;
  const double whole = smaller * ratio + larger;
  // A ratio that is subnormal has lost bits: the other order of the same product keeps them.
  const bool exact = std::abs(ratio) > std::numeric_limits<double>::min();
  const double a_part = exact ? a * ratio : smaller * (a / larger);
  const double b_part = exact ? b * ratio : smaller * (b / larger);
  if (turned) return {(a_part + b) / whole, (b_part - a) / whole};
  return {(b_part + a) / whole, (b - a_part) / whole};
}

/// Returns a factor for all parts, so that the quotient neither overflows nor underflows on its way
/// (Baudin and Smith, arXiv:1210.4539).
double scale_of(double a, double b, double c, double d) {
  constexpr double kLarge = std::numeric_limits<double>::max() / 2;
  constexpr double kSmallest = std::numeric_limits<double>::min();
  constexpr double kSmall = std::numeric_limits<double>::epsilon();
  const double larger = std::abs(std::abs(c) < std::abs(d) ? d : c);
  const auto tiny_beside = [&](double part, double other) {
    return std::abs(part) < kSmallest && std::abs(other) < kLarge * kSmall &&
           larger < kLarge * kSmall;
  };
  if (larger >= kLarge) return 0.5;
  return larger < kSmall || tiny_beside(a, b) || tiny_beside(b, a) ? 1 / kSmall : 1;
}

/// Sizes of infinite parts count, and their signs: infinity becomes 1, anything else 0.
double of_infinity(double part) {
  return std::copysign(std::isinf(part) ? 1.0 : 0.0, part);
}

}  // namespace
}  // namespace framewatch::estimator

// The attribute for this comes too late for functions that the compiler knows.
asm(".hidden hypot\n.hidden cabs\n.hidden __divdc3");

extern "C" {

double hypot(double x, double y) noexcept {
  return framewatch::estimator::length_of(x, y);
}

double cabs(__complex__ double z) noexcept {
  return framewatch::estimator::length_of(__real__ z, __imag__ z);
}

/// Returns (a + i b) / (c + i d). g++ calls this function for std::complex<double> /
/// std::complex<double>. A quotient that would be NaN follows annex G of the C standard.
__complex__ double __divdc3(double a, double b, double c, double d) noexcept {
  using framewatch::estimator::of_infinity;
  const double scale = framewatch::estimator::scale_of(a, b, c, d);
  a *= scale, b *= scale, c *= scale, d *= scale;
  auto [re, im] = framewatch::estimator::divided(a, b, c, d);
  if (std::isnan(re) && std::isnan(im)) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    if (c == 0 && d == 0 && (!std::isnan(a) || !std::isnan(b))) {
      re = std::copysign(kInfinity, c) * a;
      im = std::copysign(kInfinity, c) * b;
    } else if ((std::isinf(a) || std::isinf(b)) && std::isfinite(c) && std::isfinite(d)) {
      a = of_infinity(a), b = of_infinity(b);
      re = kInfinity * (a * c + b * d);
      im = kInfinity * (b * c - a * d);
    } else if ((std::isinf(c) || std::isinf(d)) && std::isfinite(a) && std::isfinite(b)) {
      c = of_infinity(c), d = of_infinity(d);
      re = 0.0 * (a * c + b * d);
      im = 0.0 * (b * c - a * d);
    }
  }
  __complex__ double out;
  __real__ out = re;
  __imag__ out = im;
  return out;
}

}  // extern "C"

#endif
