#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include <matstruct/error.h>
#include <matstruct/options.h>

namespace matstruct {
namespace {

std::string refusal(const Options& options) {
  try {
    options.validate();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(Options, DefaultsAreValid) {
  EXPECT_EQ(refusal({}), "");
}

TEST(Options, BoundsAreAccepted) {
  EXPECT_EQ(refusal({.gamma = 2}), "");
  EXPECT_EQ(refusal({.gamma = 1000}), "");
  EXPECT_EQ(refusal({.thinning = 0}), "");
  EXPECT_EQ(refusal({.thinning = 1}), "");
  EXPECT_EQ(refusal({.particle_rounds = 1000, .particle_change = 0, .particle_gradient = 1}), "");
  EXPECT_EQ(refusal({.max_rounds = 0}), "");
}

TEST(Options, RefusalNamesTheField) {
  const auto names = [](const Options& options, const char* field) {
    return refusal(options).find(std::string("option ") + field) == 0;
  };
  EXPECT_TRUE(names({.gamma = 1.99}, "gamma"));
  EXPECT_TRUE(names({.gamma = std::nan("")}, "gamma"));
  EXPECT_TRUE(names({.gamma = INFINITY}, "gamma"));
  EXPECT_TRUE(names({.convex_angle = 0}, "convex_angle"));
  EXPECT_TRUE(names({.convex_angle = 180}, "convex_angle"));
  EXPECT_TRUE(names({.concave_angle = -30}, "concave_angle"));
  EXPECT_TRUE(names({.concave_angle = 180}, "concave_angle"));
  EXPECT_TRUE(names({.thinning = 1.01}, "thinning"));
  EXPECT_TRUE(names({.particle_rounds = -1}, "particle_rounds"));
  EXPECT_TRUE(names({.particle_rounds = 1001}, "particle_rounds"));
  EXPECT_TRUE(names({.particle_change = -0.1}, "particle_change"));
  EXPECT_TRUE(names({.particle_change = std::nan("")}, "particle_change"));
  EXPECT_TRUE(names({.particle_gradient = 0}, "particle_gradient"));
  EXPECT_TRUE(names({.max_rounds = -1}, "max_rounds"));
  EXPECT_TRUE(names({.threads = -1}, "threads"));
}

TEST(Options, FirstFieldIsNamed) {
  EXPECT_EQ(refusal({.gamma = 0, .thinning = 7}), "option gamma is 0; it must be between 2 and 1000.");
}

}  // namespace
}  // namespace matstruct
