#include "daemon/tools/diagnosis/diagnose_records.h"

#include <gtest/gtest.h>

#include "tests/support/config_fixture.h"

namespace framewatch::daemon {
namespace compared_channels_test {

TEST(ComparedChannels, ThoseForACheckAreLeftAside) {
  const std::string check = "name = \"F1-Y1\"\ncheck = true\n";
  Config config = test::good(test::replaced(test::kGoodConfig, "name = \"F1-Y1\"\n", check));
  for (const int channel : {2, 4}) {
    estimator::EffectPlace place;
    place.kind = estimator::PlaceKind::channel;
    place.channel = channel;
    config.effects.push_back(make_effect(estimator::EffectKind::polarity, place));
  }
  std::vector<DiagnoseRecord> records(1);
  records[0].samples.accel.resize(2, 7);
  records[0].samples.accel << 0, 1, 2, 3, 4, 5, 6, 0, 1, 2, 3, 4, 5, 6;  // 6: a component's force
  const ComparedChannels compared = compared_channels(config, records);
  ASSERT_EQ(compared.axes.size(), 5U);
  EXPECT_EQ(compared.axes[2].name, "F1-Y2");
  ASSERT_EQ(compared.known.size(), 1U);
  EXPECT_EQ(compared.known[0].place.channel, 3);
  EXPECT_EQ(records[0].samples.accel.row(1),
            (Eigen::RowVectorXd(6) << 0, 1, 3, 4, 5, 6).finished());
}

}  // namespace compared_channels_test
}  // namespace framewatch::daemon
