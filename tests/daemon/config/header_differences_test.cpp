// SPDX-License-Identifier: MIT
// Tests records whose header contradicts the configuration.
#include <string>

#include <gtest/gtest.h>

#include "daemon/config/header_differences.h"

namespace framewatch::daemon {
namespace header_differences_test {

using estimator::Direction;

/// Three floors above a base, two channels of y and one of x.
class HeaderDifferences : public testing::Test {
 protected:
  HeaderDifferences() {
    config_.pipeline.structure.stories = 3;
    config_.azimuth_y_deg = 20;
    add("base", 0, Direction::y, "Ground floor", 20);
    add("second", 1, Direction::y, "2nd floor", 20);
    add("third", 2, Direction::x, "3rd floor", 110);
    add("roof", 3, Direction::y, "Roof", 20);
  }
  void add(const std::string& name, int story, Direction direction, const std::string& place,
           double azimuth_deg) {
    estimator::SensorAxis axis;
    axis.name = name;
    axis.story = story;
    axis.direction = direction;
    config_.pipeline.axes.push_back(axis);
    drivers::AxisHeader header;
    header.place = place;
    header.azimuth_deg = azimuth_deg;
    header.elevation_deg = 0;
    header.unit = "cm/s2";
    record_.names.push_back(name);
    record_.headers.push_back(header);
  }
  estimator::SensorAxis& axis(std::size_t i) { return config_.pipeline.axes[i]; }
  drivers::AxisHeader& header(std::size_t i) { return record_.headers[i]; }
  void expect_one(const std::string& part) {
    const auto found = header_differences(config_, record_);
    ASSERT_EQ(found.size(), 1U) << (found.empty() ? "" : found.back());
    EXPECT_NE(found[0].find(part), std::string::npos) << found[0];
  }

  Config config_;
  drivers::Record record_;
};

TEST_F(HeaderDifferences, AreEmptyIfHeaderAndConfigurationAgree) {
  EXPECT_TRUE(header_differences(config_, record_).empty());
  header(1).azimuth_deg = 23;
  EXPECT_TRUE(header_differences(config_, record_).empty()) << "azimuths are rounded";
  config_.azimuth_y_deg.reset();
  EXPECT_TRUE(header_differences(config_, record_).empty());
  record_.headers.clear();
  config_.pipeline.axes[0].story = 2;
  EXPECT_TRUE(header_differences(config_, record_).empty()) << "no headers";
}

TEST_F(HeaderDifferences, ReportAnOppositeAxisWithItsPolarity) {
  header(1).azimuth_deg = 200;
  expect_one(
      "channel second: the record's header contradicts the configuration: the sensor points to "
      "azimuth 200 deg, but the configuration says 20 deg: its motion would have the wrong sign; "
      "set polarity = -1");
  axis(1).polarity = -1;
  EXPECT_TRUE(header_differences(config_, record_).empty());
  header(1).azimuth_deg = 20;
  expect_one("set polarity = 1");
}

TEST_F(HeaderDifferences, ReportAnotherAzimuthWithTheSharesOfMotion) {
  header(2).azimuth_deg = 170;
  expect_one(
      "its values contain 50 % of the motion in the configured direction and 87 % of the motion "
      "across it");
  axis(2).plan = estimator::PlanPlace{0, 0, -M_PI / 3};
  EXPECT_TRUE(header_differences(config_, record_).empty());
  axis(2).plan.reset();
  axis(2).mount_angle = -M_PI / 3;
  EXPECT_TRUE(header_differences(config_, record_).empty());
}

TEST_F(HeaderDifferences, UseTheMostCommonAzimuthByDefault) {
  config_.azimuth_y_deg.reset();
  header(3).azimuth_deg = 60;
  expect_one(
      "channel roof: the record's header contradicts the configuration: the sensor points to "
      "azimuth 60 deg, but the configuration says 20 deg");
}

TEST_F(HeaderDifferences, ReportAVerticalAxis) {
  header(1).azimuth_deg.reset();
  header(1).elevation_deg = 90;
  expect_one("the sensor measures up, but the configuration says along y");
}

TEST_F(HeaderDifferences, ReportAnotherLevelWithTheStoryToSet) {
  header(1).place = "4th floor";
  expect_one("the sensor is on floor 4 (\"4th floor\"), but the configuration says story 1");
  expect_one("set story 3 (counted as for the other channels)");
  header(1).place = "Roof";
  expect_one("set story 3");
  header(1).place = "Free field";
  expect_one("set use = false");
  header(1).place = "Basement";
  expect_one("set story 0, or use = false");
  for (std::size_t i = 0; i < 3; ++i) header(i).place = "";
  EXPECT_TRUE(header_differences(config_, record_).empty());
}

TEST_F(HeaderDifferences, ReportAScaleBesideTheFilesUnit) {
  axis(0).scale = 0.01;
  expect_one(
      "its values, cm/s2 in the file, are already converted to m/s^2: scale = 0.01 multiplies them "
      "by 0.01 again; set scale = 1");
  header(0).unit = "";
  EXPECT_TRUE(header_differences(config_, record_).empty());
}

}  // namespace header_differences_test
}  // namespace framewatch::daemon
