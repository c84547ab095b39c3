#include "luxel/nearest_name.h"

#include <gtest/gtest.h>

#include <vector>

namespace luxel {
namespace {

const std::vector<std::string> keys{"mesh", "unit", "materials", "surfaces", "lights", "camera"};

TEST(NearestName, IsTheOneWithTheFewestKeystrokes) {
  EXPECT_EQ(nearest_name("material", keys), "materials");
  EXPECT_EQ(nearest_name("surfcaes", keys), "surfaces");
  EXPECT_EQ(nearest_name("cam", keys), "camera");
}

TEST(NearestName, CountsASwapAsOneKeystroke) {
  EXPECT_EQ(nearest_name("wlal", std::vector<std::string>{"wxyl", "wall"}), "wall");
}

TEST(NearestName, TakesACapitalForItsSmallLetter) {
  EXPECT_EQ(nearest_name("MESH", keys), "mesh");
  EXPECT_EQ(nearest_name("leftwall", std::vector<std::string>{"leftWalls", "leftWall"}), "leftWall");
}

TEST(NearestName, IsTheFirstOfEquals) {
  EXPECT_EQ(nearest_name("b", std::vector<std::string>{"a", "c"}), "a");
}

TEST(NearestName, IsNothingWithoutCandidates) {
  EXPECT_EQ(nearest_name("a", {}), std::nullopt);
}

TEST(NearestName, IsTheNameItself) {
  EXPECT_EQ(nearest_name("unit", keys), "unit");
}

}  // namespace
}  // namespace luxel
