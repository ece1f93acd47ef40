#include <cstdint>
#include <set>

#include <gtest/gtest.h>

#include "base/random.h"

namespace matstruct {
namespace {

TEST(KeyedRandom, DependsOnlyOnItsKey) {
  KeyedRandom a(1, 2, 3), b(1, 2, 3);
  for (int i = 0; i < 100; ++i) EXPECT_EQ(a.next(), b.next());
}

TEST(KeyedRandom, EveryPartOfTheKeyMatters) {
  // 10 x 10 x 10 keys, their order included: (1, 2, 3) and (3, 2, 1) are different streams.
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 10; ++seed)
    for (std::uint64_t stage = 0; stage < 10; ++stage)
      for (std::uint64_t element = 0; element < 10; ++element) first.insert(KeyedRandom(seed, stage, element).next());
  EXPECT_EQ(first.size(), 1000u);
}

TEST(KeyedRandom, UniformFillsTheUnitInterval) {
  constexpr int kDraws = 100'000, kBins = 10;
  int bins[kBins] = {};
  KeyedRandom random(7, 0, 0);
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform();
    ASSERT_GE(u, 0);
    ASSERT_LT(u, 1);
    ++bins[static_cast<int>(u * kBins)];
  }
  // A bin's standard deviation is sqrt(kDraws * 0.1 * 0.9) = 95; five of them.
  for (const int bin : bins) EXPECT_NEAR(bin, kDraws / kBins, 475);
}

TEST(KeyedRandom, FirstDrawsOfNeighbouringElementsAreIndependent) {
  // Stages draw once per element: the first draws over consecutive elements must be as uniform as one stream.
  constexpr int kElements = 100'000;
  double sum = 0, lagged = 0, before = 0.5;
  for (std::uint64_t i = 0; i < kElements; ++i) {
    const double u = KeyedRandom(1, 1, i).uniform();
    sum += u;
    lagged += (u - 0.5) * (before - 0.5);
    before = u;
  }
  EXPECT_NEAR(sum / kElements, 0.5, 5 * 0.2887 / 316.2);       // standard deviation sqrt(1/12) / sqrt(kElements)
  EXPECT_NEAR(lagged / kElements, 0, 5 * (1.0 / 12) / 316.2);  // of the product of two uniforms: 1/12
}

}  // namespace
}  // namespace matstruct
