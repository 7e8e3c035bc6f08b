// SPDX-License-Identifier: MIT
// Every processor and library gives the same bits. The digests are those of amd64.
#include <bit>
#include <cmath>
#include <complex>
#include <cstdint>
#include <cstdlib>
#include <limits>

#include <gtest/gtest.h>

namespace framewatch::estimator {
namespace functions_test {

constexpr int kArguments = 200'000;

/// Doubles of any size between two powers of two, from a generator that only uses integers.
class Arguments {
 public:
  /// Returns a number of any sign whose exponent is in low..high - 1.
  double next(int low, int high) {
    const std::uint64_t bits = step();
    const double sign = (bits & 1) != 0 ? -1 : 1;
    const double mantissa = 1 + static_cast<double>(bits >> 11) * 0x1p-53;
    const auto span = static_cast<std::uint64_t>(high - low);
    return sign * std::ldexp(mantissa, low + static_cast<int>(step() % span));
  }
  std::complex<double> next_complex(int low, int high) {
    const double re = next(low, high);
    return {re, next(low, high)};
  }

 private:
  std::uint64_t step() {
    state_ ^= state_ << 13, state_ ^= state_ >> 7, state_ ^= state_ << 17;
    return state_;
  }
  std::uint64_t state_ = 88172645463325252u;
};

/// Returns the FNV-1a digest of a function's values, word by word. Every NaN counts as the word 1,
/// whatever its sign.
template <typename Function>
std::uint64_t digest(Function function) {
  Arguments arguments;
  std::uint64_t out = 1469598103934665603u;
  const auto add = [&](double value) {
    const std::uint64_t bits = std::isnan(value) ? 1 : std::bit_cast<std::uint64_t>(value);
    out = (out ^ bits) * 1099511628211u;
  };
  for (int i = 0; i < kArguments; ++i) {
    const std::complex<double> value = function(arguments);
    add(value.real()), add(value.imag());
  }
  return out;
}

TEST(Functions, HypotHasTheBitsOfAmd64) {
  EXPECT_EQ(digest([](Arguments& a) {
              const double x = a.next(-12, 12);
              return std::hypot(x, a.next(-12, 12));
            }),
            0x908342023d3cdd01u);
  EXPECT_EQ(digest([](Arguments& a) {
              const double x = a.next(-1060, 1024);
              return std::hypot(x, a.next(-1060, 1024));
            }),
            0xca702a5cfe35763cu);
}

TEST(Functions, AbsOfAComplexNumberHasTheBitsOfAmd64) {
  EXPECT_EQ(digest([](Arguments& a) { return std::abs(a.next_complex(-12, 12)); }),
            0x908342023d3cdd01u);
}

TEST(Functions, AComplexQuotientHasTheBitsOfAmd64) {
  EXPECT_EQ(digest([](Arguments& a) {
              const auto x = a.next_complex(-12, 12);
              return x / a.next_complex(-12, 12);
            }),
            0xb8404c662e18c6abu);
  EXPECT_EQ(digest([](Arguments& a) {
              const auto x = a.next_complex(-1060, 1024);
              return x / a.next_complex(-1060, 1024);
            }),
            0xe96d074752de01a7u);
}

TEST(Functions, AQuotientWithInfinityOrZeroFollowsAnnexG) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::nan("");
  volatile double zero = 0;  // so that the compiler does not divide
  const std::complex<double> by_zero = std::complex<double>(1, -2) / std::complex<double>(zero, 0);
  EXPECT_EQ(by_zero, std::complex<double>(inf, -inf));
  const std::complex<double> by_inf = std::complex<double>(1, -2) / std::complex<double>(inf, zero);
  EXPECT_EQ(by_inf, std::complex<double>(0, 0));
  EXPECT_TRUE(std::signbit(by_inf.imag()));
  const std::complex<double> of_nan = std::complex<double>(nan, zero) / std::complex<double>(1, 1);
  EXPECT_TRUE(std::isnan(of_nan.real()) && std::isnan(of_nan.imag()));
}

// libm gives these bits on processors with fused multiply-add: all of arm64, amd64 since 2013.
TEST(Functions, TheLibrarysHaveTheSameBitsWhereItFuses) {
#ifdef __x86_64__
  if (!__builtin_cpu_supports("fma")) GTEST_SKIP() << "this processor has no fused multiply-add";
#endif
  EXPECT_EQ(digest([](Arguments& a) { return std::exp(a.next(-12, 9)); }), 0xd031db08a2fec600u);
  EXPECT_EQ(digest([](Arguments& a) { return std::log(std::abs(a.next(-40, 40))); }),
            0x7b11e7cd5ddb462au);
  EXPECT_EQ(digest([](Arguments& a) {
              const double x = std::abs(a.next(-20, 20));
              return std::pow(x, a.next(-6, 4));
            }),
            0x8c74d92737b086e7u);
  EXPECT_EQ(digest([](Arguments& a) {
              const double x = a.next(-12, 12);
              return std::complex<double>(std::sin(x), std::cos(x));
            }),
            0xaecb264535b558dcu);
  EXPECT_EQ(digest([](Arguments& a) { return std::tan(a.next(-12, 12)); }), 0x77dd7c56e9b163edu);
}

}  // namespace functions_test
}  // namespace framewatch::estimator
