/// Pairs of points that are told apart one by one and many at once.
#include "core/matching/point_pairs.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "core/base/random.h"

namespace pcl_symmetry {

namespace {

Points randomPoints(int count, std::uint64_t seed, const Eigen::Vector3d& center, double radius) {
  RandomStream random(seed);
  Points points(3, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    Eigen::Vector3d x;
    do {
      x = Eigen::Vector3d::NullaryExpr([&] { return 2.0 * random.uniform() - 1.0; });
    } while (x.norm() > 1.0);
    points.col(i) = (center + radius * x).cast<float>();
  }
  return points;
}

}  // namespace

TEST(PointPairs, ManyAtOnceAreThoseOneByOne) {
  for (const double scale : {1.0, 1e-9, 1e9}) {
    const Points points = randomPoints(200, 1, scale * Eigen::Vector3d(1.0, -2.0, 3.0), scale);
    Points normals = randomPoints(200, 2, Eigen::Vector3d::Zero(), 1.0);
    normals.colwise().normalize();
    const PairedSurface surface(points, normals, scale);
    PairRow row;
    int num_pairs = 0, num_other = 0;
    for (int i = 0; i < 200; ++i) {
      surface.fillRow(i, row);
      const Eigen::Matrix3d frame = frameOf(normals.col(i).cast<double>());
      for (int j = 0; j < 200; ++j) {
        const double distance = (points.col(j) - points.col(i)).cast<double>().norm();
        const auto at = static_cast<std::size_t>(j);
        ASSERT_NEAR(row.distance[at], distance / scale, 1e-5);
        if (distance < 0.2 * scale) continue;
        const PointPair pair =
            pairOf(frame, points.col(i).cast<double>(), points.col(j).cast<double>(), normals.col(j).cast<double>());
        ++num_pairs;
        const int turn = (row.turn[at] - pair.turn + 256) % 256;
        const bool same = row.distance_step[at] == static_cast<int>(std::floor(pair.log_distance)) &&
                          row.angle_step[at] == std::min(kPairAngles - 1, static_cast<int>(pair.angle)) &&
                          row.other_step[at] == pair.other_angle && row.between_step[at] == pair.between && turn == 0;
        if (same) continue;
        ++num_other;
        // At a limit of a step.
        EXPECT_LE(std::abs(row.distance_step[at] - static_cast<int>(std::floor(pair.log_distance))), 1);
        EXPECT_LE(std::abs(row.angle_step[at] - static_cast<int>(pair.angle)), 1);
        EXPECT_LE(std::abs(row.other_step[at] - pair.other_angle), 1);
        EXPECT_LE(std::abs(row.between_step[at] - pair.between), 1);
        EXPECT_TRUE(turn <= 1 || turn == 255);
      }
    }
    // derived: an arc that is off by 1e-5 is a 1/256 of another turn with 256 * 1e-5 / (2 pi) = 0.04 %, and rounding of
    // single precision moves the rest by less.
    EXPECT_GT(num_pairs, 30'000);
    EXPECT_LT(num_other, num_pairs / 500) << scale;
  }
}

}  // namespace pcl_symmetry
