// SPDX-License-Identifier: MIT
#include "drivers/lcm/axis_binding.h"

#include <gtest/gtest.h>

namespace framewatch::drivers {
namespace axis_binding_test {

using Names = std::vector<std::string>;
constexpr int kNone = AxisBinding::kNone;

int axis_at(const AxisBinding& binding, const std::string& stream, int node, std::size_t axis) {
  const AxisBinding::NodeAxes* axes = binding.axes_of(stream, node);
  return axes == nullptr ? kNone : (*axes)[axis];
}

TEST(AxisBinding, UsesConfiguredAddressesWithoutATable) {
  const AxisBinding binding({{"a", "ACCEL", 3, 0}, {"b", "ACCEL", 3, 1}, {"c", "OTHER", 3, 0}});
  EXPECT_EQ(axis_at(binding, "ACCEL", 3, 0), 0);
  EXPECT_EQ(axis_at(binding, "ACCEL", 3, 1), 1);
  EXPECT_EQ(axis_at(binding, "ACCEL", 3, 2), kNone);
  EXPECT_EQ(axis_at(binding, "OTHER", 3, 0), 2);
  EXPECT_EQ(axis_at(binding, "ACCEL", 4, 0), kNone);
  EXPECT_TRUE(binding.unbound().empty());
  EXPECT_EQ(binding.streams(), (Names{"ACCEL", "OTHER"}));
}

using Contradictions = std::vector<AxisBinding::Contradiction>;

/// Returns the axes that a table contradicts.
std::vector<std::size_t> axes_of(const Contradictions& against) {
  std::vector<std::size_t> out;
  for (const auto& c : against) out.push_back(c.wanted);
  return out;
}

bool never(const std::string&, std::int32_t) {
  return false;
}

using Axes = std::vector<std::size_t>;

TEST(AxisBinding, AConfiguredAddressOverridesEveryTable) {
  AxisBinding binding({{"a", "ACCEL", 1, 0}, {"b", "ACCEL", 2, 0}});
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"b", 1, 0}, {"a", 2, 0}}})), (Axes{0, 1}));
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 0), 1);
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"a", 1, 1}}})), Axes{0});
  EXPECT_EQ(axes_of(binding.apply("OTHER", {100, {{"a", 1, 0}}})), Axes{0});
  EXPECT_FALSE(binding.carries("OTHER"));
}

TEST(AxisBinding, AMatchingTableIsNoContradiction) {
  AxisBinding binding({{"a", "ACCEL", 1, 0}, {"b", "ACCEL", 2, 0}, {"c", "", -1, 0}});
  const ChannelTable table{100, {{"a", 1, 0}, {"b", 2, 0}, {"c", 3, 0}, {"theirs", 3, 1}}};
  EXPECT_TRUE(binding.apply("ACCEL", table, never).empty());
  EXPECT_TRUE(binding.apply("ACCEL", table, never).empty());
  EXPECT_EQ(axis_at(binding, "ACCEL", 3, 0), 2);
}

TEST(AxisBinding, AnotherNameAtAConfiguredAddressIsAContradiction) {
  AxisBinding binding({{"a", "ACCEL", 1, 0}});
  const Contradictions against = binding.apply("ACCEL", {100, {{"theirs", 1, 0}}});
  ASSERT_EQ(axes_of(against), Axes{0});
  EXPECT_EQ(against[0].told, (ChannelTable::Entry{"theirs", 1, 0}));
  EXPECT_FALSE(against[0].elsewhere);
  EXPECT_TRUE(binding.apply("ACCEL", {100, {{"node1.x", 1, 0}}}).empty());
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
}

TEST(AxisBinding, AConfiguredAddressIsNotGivenToAnotherChannel) {
  AxisBinding binding({{"a", "ACCEL", 1, 0}, {"file only", "", -1, 0}});
  EXPECT_EQ(binding.unbound(), Names{"file only"});
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"file only", 1, 0}}})), Axes{0});
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
  EXPECT_EQ(binding.unbound(), Names{"file only"});
}

TEST(AxisBinding, ABindingStaysWhileItsSamplesCome) {
  AxisBinding binding({{"a", "", -1, 0}, {"b", "", -1, 0}});
  EXPECT_TRUE(binding.apply("ACCEL", {100, {{"a", 1, 0}, {"b", 2, 0}}}, never).empty());
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"a", 2, 0}, {"b", 1, 0}}}, never)),
            (Axes{0, 1}));
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"theirs", 2, 0}}}, never)), Axes{1});
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 0), 1);
  EXPECT_TRUE(
      binding.apply("ACCEL", {100, {{"a", 2, 0}, {"b", 1, 0}}}).empty());  // all nodes are silent
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 1);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 0), 0);
}

TEST(AxisBinding, AMoveToATakenAddressChangesNothing) {
  AxisBinding binding({{"a", "", -1, 0}, {"b", "ACCEL", 2, 0}});
  EXPECT_TRUE(binding.apply("ACCEL", {100, {{"a", 1, 0}}}).empty());
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {100, {{"a", 2, 0}}})), Axes{1});
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 0), 1);
}

TEST(AxisBinding, AxesWithoutASourceBindByNameOnAccel) {
  AxisBinding binding({{"a", "", -1, 0}});
  EXPECT_EQ(binding.streams(), Names{"ACCEL"});
  EXPECT_FALSE(binding.carries("RECORD"));
  binding.apply("RECORD", {0, {{"a", 7, 2}}});
  EXPECT_TRUE(binding.carries("RECORD"));
  EXPECT_EQ(axis_at(binding, "RECORD", 7, 2), 0);
}

TEST(AxisBinding, ForeignTablesChangeNothing) {
  AxisBinding binding({{"a", "ACCEL", 1, 0}});
  binding.apply("ELSEWHERE", {0, {{"x", 1, 0}, {"y", 1, 1}}});
  EXPECT_FALSE(binding.carries("ELSEWHERE"));
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
}

TEST(AxisBinding, ImpossibleAxisInATableIsIgnored) {
  AxisBinding binding({{"a", "", -1, 0}, {"b", "", -1, 0}});
  binding.apply("ACCEL", {0, {{"a", 1, 3}, {"b", 1, -1}}});
  EXPECT_EQ(binding.unbound(), (Names{"a", "b"}));
}

TEST(AxisBinding, ANameInTwoPlacesBindsOnce) {
  AxisBinding binding({{"a", "", -1, 0}});
  EXPECT_EQ(axes_of(binding.apply("ACCEL", {0, {{"a", 1, 0}, {"a", 2, 0}}})), Axes{0});
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), 0);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 0), kNone);
}

TEST(AxisBinding, ANewTableMovesASilentChannel) {
  AxisBinding binding({{"a", "", -1, 0}});
  binding.apply("ACCEL", {0, {{"a", 1, 0}}});
  binding.apply("ACCEL", {0, {{"a", 2, 1}}});
  EXPECT_EQ(axis_at(binding, "ACCEL", 1, 0), kNone);
  EXPECT_EQ(axis_at(binding, "ACCEL", 2, 1), 0);
}

}  // namespace axis_binding_test
}  // namespace framewatch::drivers
