#include <algorithm>
#include <atomic>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <matstruct/context.h>
#include <matstruct/error.h>

#include "base/index.h"
#include "base/parallel.h"

namespace matstruct {
namespace {

using Ranges = std::vector<std::pair<Index, Index>>;

Ranges ranges_of(Index n, Index grain, int threads) {
  Context context;
  context.threads = threads;
  Ranges ranges;
  std::mutex guard;
  parallel_for(context, n, grain, [&](Index begin, Index end) {
    const std::lock_guard lock(guard);
    ranges.emplace_back(begin, end);
  });
  std::sort(ranges.begin(), ranges.end());
  return ranges;
}

TEST(ParallelFor, RangesTileTheInterval) {
  for (const Index n : {0, 1, 2, 7, 64, 65, 1000}) {
    for (const Index grain : {1, 3, 64}) {
      Index next = 0;
      for (const auto& [begin, end] : ranges_of(n, grain, 2)) {
        EXPECT_EQ(begin, next);
        EXPECT_LT(begin, end);
        EXPECT_LE(end - begin, grain);
        next = end;
      }
      EXPECT_EQ(next, n);
    }
  }
}

TEST(ParallelFor, RangesDoNotDependOnThreads) {
  const Ranges one = ranges_of(1000, 7, 1);
  for (const int threads : {0, 2, 3, 8}) EXPECT_EQ(ranges_of(1000, 7, threads), one) << threads << " threads";
}

TEST(ParallelFor, ExceptionComesOut) {
  for (const int threads : {1, 2}) {
    Context context;
    context.threads = threads;
    const auto fail_at_37 = [](Index begin, Index) {
      if (begin == 37) throw std::out_of_range("37");
    };
    EXPECT_THROW(parallel_for(context, 100, 1, fail_at_37), std::out_of_range);
  }
}

TEST(ParallelFor, StopsWhenAskedBefore) {
  const std::atomic<bool> stop{true};
  Context context;
  context.stop = &stop;
  EXPECT_THROW(parallel_for(context, 10, 1, [](Index, Index) { FAIL() << "called after the stop"; }), Cancelled);
}

TEST(ParallelFor, StopsWhenAskedMeanwhile) {
  std::atomic<bool> stop{false};
  std::atomic<int> calls{0};
  Context context;
  context.threads = 1;
  context.stop = &stop;
  const auto stop_at_third = [&](Index, Index) {
    if (++calls == 3) stop = true;
  };
  EXPECT_THROW(parallel_for(context, 1000, 1, stop_at_third), Cancelled);
  EXPECT_EQ(calls, 3);
}

}  // namespace
}  // namespace matstruct
