#include <weft/fast_solver/threads/node_partition.hpp>

#include <gtest/gtest.h>

namespace weft::fast {
namespace {

TEST(NodePartition, EndsWithTheLastBlockOfNodes) {
  for (const int num_nodes : {1, 8, 18, 36, 64, 65, 3000}) {
    const NodePartition parts(num_nodes);
    const int end = parts[parts.count() - 1].end;
    EXPECT_GE(end, num_nodes);
    EXPECT_LT(end, num_nodes + kNodeBlock);
    EXPECT_EQ(end % kNodeBlock, 0);
    EXPECT_EQ(parts[0].begin, 0);
    for (int part = 1; part < parts.count(); ++part)
      EXPECT_EQ(parts[part].begin, parts[part - 1].end);
  }
}

}  // namespace
}  // namespace weft::fast
