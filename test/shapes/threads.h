/// Comparisons of what several and one thread give.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <functional>
#include <tuple>
#include <type_traits>
#include <vector>

namespace pcl_symmetry::test {

/// Calls \p expectSame with what \p make gives for eight threads and for one. Blocks do not depend on the number of
/// threads, so that more of them only run in more orders; test_parallel.cpp tries others.
template <typename Make, typename ExpectSame>
void compareThreads(const Make& make, const ExpectSame& expectSame) {
  expectSame(make(8), make(1));
}

/// Expects that \p make gives equal values for eight threads and for one.
template <typename Make>
void compareThreads(const Make& make) {
  compareThreads(make, [](const auto& many, const auto& one) { EXPECT_EQ(many, one); });
}

/// \return these members of all items, as values that can be compared.
template <typename Item, typename... Members>
auto valuesOf(const std::vector<Item>& items, const Members&... members) {
  std::vector<std::tuple<std::decay_t<std::invoke_result_t<Members, const Item&>>...>> values;
  for (const Item& item : items) values.emplace_back(std::invoke(members, item)...);
  return values;
}

inline std::vector<Eigen::Matrix4d> matricesOf(const std::vector<Eigen::Isometry3d>& motions) {
  std::vector<Eigen::Matrix4d> matrices;
  for (const Eigen::Isometry3d& motion : motions) matrices.push_back(motion.matrix());
  return matrices;
}

}  // namespace pcl_symmetry::test
