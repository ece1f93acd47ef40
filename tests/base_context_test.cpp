#include <atomic>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <matstruct/context.h>
#include <matstruct/error.h>

namespace matstruct {
namespace {

TEST(Context, ReportsWhatItIsTold) {
  std::vector<std::pair<std::string, double>> seen;
  Context context;
  context.progress = [&](const std::string& stage, double fraction) {
    seen.emplace_back(stage, fraction);
    return true;
  };
  context.report("sampling", 0.25);
  context.report("spheres", 1);
  const std::vector<std::pair<std::string, double>> expected = {{"sampling", 0.25}, {"spheres", 1.0}};
  EXPECT_EQ(seen, expected);
}

TEST(Context, EmptyOneNeverCancels) {
  Context context;
  EXPECT_NO_THROW(context.report("sampling", 0.5));
  EXPECT_NO_THROW(context.check());
}

TEST(Context, ProgressCancelsByReturningFalse) {
  Context context;
  context.progress = [](const std::string&, double fraction) { return fraction < 0.5; };
  EXPECT_NO_THROW(context.report("sampling", 0.4));
  EXPECT_THROW(context.report("sampling", 0.6), Cancelled);
}

TEST(Context, StopFlagCancelsBeforeProgressIsCalled) {
  std::atomic<bool> stop{false};
  int calls = 0;
  Context context;
  context.stop = &stop;
  context.progress = [&](const std::string&, double) { return ++calls > 0; };
  EXPECT_NO_THROW(context.report("sampling", 0));
  stop = true;
  EXPECT_THROW(context.report("sampling", 0), Cancelled);
  EXPECT_THROW(context.check(), Cancelled);
  EXPECT_EQ(calls, 1);
}

}  // namespace
}  // namespace matstruct
