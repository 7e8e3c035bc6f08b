#include "daemon/monitor/events/place_words.h"

#include <gtest/gtest.h>

namespace framewatch::daemon {
namespace {

TEST(PlaceWords, SayWhereAParameterIs) {
  EXPECT_EQ(place_words("kx_1_y2"), "story 1, frame y2");
  EXPECT_EQ(place_words("Gk_2_x1y1"), "floor 2, panel x1y1");
  EXPECT_EQ(place_words("kx_6to12"), "stories 6 to 12, along x");
  EXPECT_EQ(place_words("cy_13"), "story 13, along y");
  EXPECT_EQ(place_words("ky_6to12_x1"), "stories 6 to 12, frame x1");
  EXPECT_EQ(place_words("kx_1to5_y1+y2"), "stories 1 to 5, frames y1+y2");
  EXPECT_EQ(place_words("kx_1_y_2"), "story 1, frame y_2") << "names of frames may hold a _";
  EXPECT_EQ(place_words("kry"), "frames along y");
}

TEST(PlaceWords, SayWhatAParameterIsOf) {
  EXPECT_EQ(element_words("kx_1_y2"), "frame y2 of story 1");
  EXPECT_EQ(element_words("Gk_2_x1y1"), "floor panel x1y1 of floor 2");
  EXPECT_EQ(element_words("kx_6to12"), "stories 6 to 12 along x");
  EXPECT_EQ(element_words("ky_6to12_x1"), "frame x1 of stories 6 to 12");
  EXPECT_EQ(element_words("krx"), "bending of frames along x");
}

TEST(PlaceWords, TakeAnyText) {
  for (const char* name : {"", "_", "__", "k_", "k__", "_1_"}) {
    (void)place_words(name);
    (void)element_words(name);
  }
}

}  // namespace
}  // namespace framewatch::daemon
