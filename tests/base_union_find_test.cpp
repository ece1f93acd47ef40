#include <algorithm>
#include <vector>

#include <gtest/gtest.h>

#include "base/index.h"
#include "base/random.h"
#include "base/union_find.h"

namespace matstruct {
namespace {

TEST(UnionFind, EveryElementStartsAlone) {
  UnionFind sets(5);
  for (Index i = 0; i < 5; ++i) EXPECT_EQ(sets.find(i), i);
}

TEST(UnionFind, UniteSaysWhetherItMerged) {
  UnionFind sets(4);
  EXPECT_TRUE(sets.unite(2, 3));
  EXPECT_FALSE(sets.unite(3, 2));
  EXPECT_FALSE(sets.unite(1, 1));
  EXPECT_TRUE(sets.unite(1, 3));
  EXPECT_EQ(sets.find(3), 1);
  EXPECT_EQ(sets.find(0), 0);
}

/// The same by relabelling the whole array at every merge.
struct RelabelledSets {
  std::vector<Index> label;
  bool unite(Index a, Index b) {
    const Index from = std::max(label[uz(a)], label[uz(b)]), to = std::min(label[uz(a)], label[uz(b)]);
    std::replace(label.begin(), label.end(), from, to);
    return from != to;
  }
};

TEST(UnionFind, AgreesWithRelabelling) {
  constexpr Index n = 200;
  for (std::uint64_t round = 0; round < 20; ++round) {
    UnionFind sets(n);
    RelabelledSets twin{std::vector<Index>(n)};
    for (Index i = 0; i < n; ++i) twin.label[uz(i)] = i;
    KeyedRandom random(3, 0, round);
    for (int merge = 0; merge < 150; ++merge) {
      const auto draw = [&] { return static_cast<Index>(random.uniform() * n); };
      const Index a = draw(), b = draw();
      EXPECT_EQ(sets.unite(a, b), twin.unite(a, b));
    }
    for (Index i = 0; i < n; ++i) EXPECT_EQ(sets.find(i), twin.label[uz(i)]);
  }
}

}  // namespace
}  // namespace matstruct
