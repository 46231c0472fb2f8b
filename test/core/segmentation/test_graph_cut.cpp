#include "core/segmentation/graph_cut.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "core/base/random.h"

namespace pcl_symmetry {
namespace {

double costOf(const GraphCut& cut, const std::vector<bool>& with_source) {
  double cost = 0.0;
  for (std::size_t i = 0; i < with_source.size(); ++i) cost += with_source[i] ? cut.to_sink[i] : cut.to_source[i];
  for (const GraphCut::Edge& edge : cut.edges)
    if (with_source[edge.from] != with_source[edge.to]) cost += edge.capacity;
  return cost;
}

TEST(GraphCut, CutsAChainAtItsWeakestEdge) {
  constexpr double kNever = std::numeric_limits<double>::max();
  GraphCut cut;
  cut.to_source = {kNever, 0, 0, 0, 0};
  cut.to_sink = {0, 0, 0, 0, kNever};
  cut.edges = {{0, 1, 3.0}, {1, 2, 2.0}, {3, 2, 1.0}, {3, 4, 5.0}};
  EXPECT_EQ(cut.solve(), (std::vector<bool>{true, true, true, false, false}));
}

TEST(GraphCut, NoAssignmentOfASmallGraphCostsLess) {
  RandomStream random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const int size = 8;
    GraphCut cut;
    for (int i = 0; i < size; ++i) {
      cut.to_source.push_back(random.uniform());
      cut.to_sink.push_back(random.uniform());
      for (int j = 0; j < i; ++j)
        if (random.uniform() < 0.5) cut.edges.push_back({i, j, 0.5 * random.uniform()});
    }
    const double cost = costOf(cut, cut.solve());
    for (int code = 0; code < 1 << size; ++code) {
      std::vector<bool> other(size);
      for (int i = 0; i < size; ++i) other[i] = (code >> i & 1) != 0;
      EXPECT_LE(cost, costOf(cut, other) + 1e-12);
    }
  }
}

TEST(GraphCut, RefusesWhatMakesNoSense) {
  GraphCut cut;
  cut.to_source = {1.0, 0.0};
  cut.to_sink = {0.0};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
  cut.to_sink = {0.0, 1.0};
  cut.edges = {{0, 2, 1.0}};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
  cut.edges = {{0, 1, -1.0}};
  EXPECT_THROW(cut.solve(), std::invalid_argument);
}

}  // namespace
}  // namespace pcl_symmetry
