#include "pcl_symmetry/register_all.h"

#include <gtest/gtest.h>

#include <cmath>

#include "pcl/clouds.h"
#include "registration/pose_graph.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::test;

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

/// Scans of the blob, which has no symmetry, from all around, each in a frame of its own.
struct Turntable {
  std::vector<Cloud::ConstPtr> scans;
  std::vector<Eigen::Isometry3d> T_scan_object;

  static Eigen::Vector3d viewpoint(double degrees) {
    return {8.0 * std::cos(degrees * kDegree), 8.0 * std::sin(degrees * kDegree), 3.0};
  }
  void add(double degrees) {
    add(visiblePoints(asymmetricBlob(4000, scans.size() + 1).cloud(), viewpoint(degrees), 0.05), viewpoint(degrees));
  }
  void add(const Points& points, const Eigen::Vector3d& viewpoint) {
    T_scan_object.push_back(randomPose(scans.size() + 1));
    const auto cloud = toCloud(moved(points, T_scan_object.back()));
    cloud->sensor_origin_.head<3>() = (T_scan_object.back() * viewpoint).cast<float>();
    scans.push_back(cloud);
  }

  /// Degrees and input units by which the pose of a scan is off.
  std::pair<double, double> error(const RegisteredScans& found, std::size_t k, std::size_t first = 0) const {
    const Eigen::Isometry3d off =
        T_scan_object[first].inverse() * found.scans[k].T_first_scan * T_scan_object[k];  // of the object
    return {angleOf(off.linear()) / kDegree, off.translation().norm()};
  }
};

Turntable turntable(int num_scans, double step) {
  Turntable table;
  for (int k = 0; k < num_scans; ++k) table.add(step * k);
  return table;
}

TEST(RegisterAll, BringsScansFromAllAroundTogetherAndLeavesOutAScanOfSomethingElse) {
  Turntable table = turntable(4, 80.0);
  const Scan foreign = test::scan(blockL(), {5.0, 3.0, 3.0});
  table.add(foreign.cloud(), foreign.viewpoint);
  std::swap(table.scans[3], table.scans[4]);
  std::swap(table.T_scan_object[3], table.T_scan_object[4]);
  CloudRegistrationOptions options;
  options.search_parts = false;  // neighbors share more than a part
  options.search.num_rotations = 500;
  const MergedCloud<pcl::PointXYZ> merged = mergeScans<pcl::PointXYZ>(table.scans, options);
  std::size_t num_points = 0;
  for (std::size_t k = 0; k < table.scans.size(); ++k) {
    ASSERT_EQ(merged.registration.scans[k].left_out.empty(), k != 3) << k << merged.registration.scans[k].left_out;
    EXPECT_EQ(merged.registration.scans[k].confidence > 0.5, k != 3) << k;
    if (k == 3) continue;
    const auto [degrees, way] = table.error(merged.registration, k);
    EXPECT_LT(degrees, 1.0) << k;
    EXPECT_LT(way, 0.02) << k;
    num_points += table.scans[k]->size();
  }
  EXPECT_GE(merged.registration.pairs.size(), table.scans.size() - 2);
  for (const ScanPair& pair : merged.registration.pairs) EXPECT_TRUE(pair.overlap > 0.05 || !pair.used);
  ASSERT_EQ(merged.cloud.size(), merged.scans.size());
  EXPECT_LT(merged.cloud.size(), num_points) << "thinned where scans overlap";
  const Points model = asymmetricBlob(50'000, 99).cloud();
  const Points points = moved(merged.cloud.getMatrixXfMap(3, 4, 0), table.T_scan_object[0].inverse());
  for (Eigen::Index i = 0; i < points.cols(); i += 500)
    EXPECT_LT(std::sqrt((model.colwise() - points.col(i)).colwise().squaredNorm().minCoeff()), 0.04f) << i;
}

TEST(RegisterAll, TakesTheSameScanTwiceAndOneAlone) {
  Turntable table = turntable(2, 30.0);
  const RegisteredScans twice = mergeScans<pcl::PointXYZ>({table.scans[0], table.scans[0]}).registration;
  EXPECT_EQ(twice.scans[1].left_out, "");
  EXPECT_LT(angleOf(twice.scans[1].T_first_scan.linear()), 0.2 * kDegree);
  const RegisteredScans two = mergeScans<pcl::PointXYZ>({table.scans[0], table.scans[1]}).registration;
  EXPECT_EQ(two.scans[1].left_out, "");
  EXPECT_LT(table.error(two, 1).first, 1.5);
  const MergedCloud<pcl::PointXYZ> one = mergeScans<pcl::PointXYZ>({table.scans[0]});
  EXPECT_EQ(one.registration.scans[0].left_out, "");
  EXPECT_GT(one.cloud.size(), table.scans[0]->size() / 4);
  EXPECT_TRUE(mergeScans<pcl::PointXYZ>({}).registration.scans.empty());
}

TEST(RegisterAll, LeavesOutWhatHoldsNoAnswer) {
  Turntable table = turntable(2, 30.0);
  const Points all = table.scans[0]->getMatrixXfMap(3, 4, 0);
  const auto few = toCloud<pcl::PointXYZ>(all.leftCols(30).eval());
  const auto empty = pcl::make_shared<Cloud>();
  const RegisteredScans found = mergeScans<pcl::PointXYZ>({few, table.scans[0], empty, table.scans[1]}).registration;
  EXPECT_NE(found.scans[0].left_out, "");
  EXPECT_NE(found.scans[2].left_out, "");
  EXPECT_TRUE(found.scans[1].T_first_scan.isApprox(Eigen::Isometry3d::Identity())) << "the first one that is kept";
  EXPECT_EQ(found.scans[3].left_out, "");
}

/// From opposite sides nothing is seen twice but edges.
TEST(RegisterAll, ScansWithoutOverlapAreLeftOutOrRight) {
  Turntable table;
  table.add(70.0);
  table.add(250.0);
  const RegisteredScans found = mergeScans<pcl::PointXYZ>(table.scans).registration;
  EXPECT_EQ(found.scans[0].left_out, "");
  EXPECT_TRUE(!found.scans[1].left_out.empty() || table.error(found, 1).first < 5.0);
}

TEST(RegisterAll, RefusesBadOptions) {
  CloudRegistrationOptions options;
  options.max_iterations = 0;
  EXPECT_THROW(registerAll({}, options), std::invalid_argument);
  EXPECT_THROW(mergeScans<pcl::PointXYZ>({}, options), pcl::BadArgumentException);
}

/// Pairs of scans whose poses are known, but for one that is wrong.
TEST(JoinScans, OutvotesAPairThatContradictsTheOthers) {
  std::vector<Eigen::Isometry3d> poses;
  for (int k = 0; k < 6; ++k) poses.push_back(randomPose(k + 1, 0.3));
  std::vector<PairAnswer> answers;
  for (int k = 0; k < 6; ++k)
    for (const int step : {1, 2}) {
      const int other = (k + step) % 6;
      answers.push_back({other, k, poses[k].inverse() * poses[other], 1e-4 * Matrix6d::Identity(), 1.0, true});
    }
  answers[4].T_target_source = randomPose(50, 0.3);
  const SamePose same{0.05, 0.05};
  const ScanGroups groups = joinScans(6, answers, same, 1.0);
  for (std::size_t e = 0; e < answers.size(); ++e) EXPECT_EQ(groups.agrees(answers[e], same), e != 4) << e;
  for (int k = 0; k < 6; ++k) {
    const Eigen::Isometry3d found = groups.T_group_scan[0].inverse() * groups.T_group_scan[k];
    EXPECT_TRUE(found.isApprox(poses[0].inverse() * poses[k], 1e-6)) << k;
  }
}

TEST(JoinScans, DoubtfulPairsCountTogether) {
  std::vector<PairAnswer> answers{{1, 0, Eigen::Isometry3d::Identity(), Matrix6d::Identity(), 0.4, false}};
  const SamePose same{0.05, 0.05};
  EXPECT_NE(joinScans(3, answers, same, 0.6).group[0], joinScans(3, answers, same, 0.6).group[1]);
  answers.push_back({2, 1, Eigen::Isometry3d::Identity(), Matrix6d::Identity(), 0.4, false});
  answers.push_back({2, 0, Eigen::Isometry3d::Identity(), Matrix6d::Identity(), 0.4, false});
  const ScanGroups groups = joinScans(3, answers, same, 0.6);
  EXPECT_TRUE(groups.group[0] == groups.group[1] && groups.group[1] == groups.group[2]);
}

TEST(AdjustPoses, SpreadsTheErrorOfALoop) {
  // Four scans in a ring, each pair off by the same small rotation about z: none of it can be taken away, so all stay.
  std::vector<PoseConstraint> ring;
  const Eigen::Isometry3d quarter(Eigen::AngleAxisd(0.5 * kPi + 0.02, Eigen::Vector3d::UnitZ()));
  for (int k = 0; k < 4; ++k) ring.push_back({(k + 1) % 4, k, quarter, Matrix6d::Identity()});
  std::vector<Eigen::Isometry3d> poses(4, Eigen::Isometry3d::Identity());
  for (int k = 1; k < 4; ++k) poses[k] = poses[k - 1] * quarter;
  adjustPoses(ring, poses, 5);
  for (int k = 0; k < 4; ++k)
    EXPECT_NEAR(angleOf((poses[k].inverse() * poses[(k + 1) % 4]).linear()), 0.5 * kPi, 1e-6) << k;
}

}  // namespace
