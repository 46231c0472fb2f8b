#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>

#include "io/shape_input.h"
#include "pcl_symmetry/completion.h"
#include "scanner/virtual_scanner.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class AlignTool : public ToolTest {
protected:
  AlignTool() : ToolTest(toolPath("align")) {}

  /// Two boxes, a seat and its back: one plane of symmetry, x = 0.
  const std::string chair_ =
      folder_.write("chair.off",
                    "OFF\n16 12 0\n-1 -1 -0.2\n1 -1 -0.2\n1 1 -0.2\n-1 1 -0.2\n-1 -1 0.2\n1 -1 0.2\n1 1 0.2\n-1 1 0.2\n"
                    "-0.8 0.8 0.2\n0.8 0.8 0.2\n0.8 1 0.2\n-0.8 1 0.2\n-0.8 0.8 2\n0.8 0.8 2\n0.8 1 2\n-0.8 1 2\n"
                    "4 3 2 1 0\n4 4 5 6 7\n4 0 1 5 4\n4 2 3 7 6\n4 1 2 6 5\n4 3 0 4 7\n"
                    "4 11 10 9 8\n4 12 13 14 15\n4 8 9 13 12\n4 10 11 15 14\n4 9 10 14 13\n4 11 8 12 15\n");
  const std::string box_ = folder_.write("box.off", boxOFF());

  /// What a scanner sees of the chair, with normals that look to the scanner; the scanner stands where VIEWPOINT says.
  std::string scanOfChair(Eigen::Isometry3d& T_scan_model) const {
    const VirtualScanner scanner(*loadShape(chair_).mesh);
    VirtualScannerOptions options;
    options.num_points = 4000;
    options.random_pose = true;
    options.seed = 5;
    const VirtualScan scan = scanner.scan({-0.6, -1.0, 0.7}, options);
    T_scan_model = scan.T_scan_model;
    pcl::PointCloud<pcl::PointXYZLNormal> seen;
    seen.sensor_origin_ = scan.cloud->sensor_origin_;
    for (const pcl::PointXYZ& point : *scan.cloud) {
      if (!point.getVector3fMap().allFinite()) continue;
      pcl::PointXYZLNormal added;
      added.getVector3fMap() = point.getVector3fMap();
      added.getNormalVector3fMap() = (seen.sensor_origin_.head<3>() - point.getVector3fMap()).normalized();
      added.label = static_cast<std::uint32_t>(seen.size());
      seen.push_back(added);
    }
    pcl::io::savePCDFileBinary(folder_ / "scan.pcd", seen);
    return folder_ / "scan.pcd";
  }

  static Eigen::Isometry3d transformOf(const nlohmann::json& json) {
    const auto numbers = json.at("transform").get<std::vector<double>>();
    EXPECT_EQ(numbers.size(), 16u);
    Eigen::Isometry3d transform;
    transform.matrix() = Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(numbers.data());
    return transform;
  }
};

template <typename T>
T fieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name, std::size_t point) {
  for (const auto& field : cloud.fields) {
    if (field.name != name) continue;
    T value;
    std::memcpy(&value, &cloud.data[point * cloud.point_step + field.offset], sizeof(value));
    return value;
  }
  ADD_FAILURE() << "no field " << name;
  return T();
}

TEST_F(AlignTool, TurnsAWholeIntoItsFrame) {
  const nlohmann::json json = reportOf(box_ + " " + (folder_ / "out.pcd"));
  for (const double x : json["center"].get<std::vector<double>>()) EXPECT_NEAR(x, 0.0, 0.03);
  const Eigen::Isometry3d transform = transformOf(json);
  EXPECT_NEAR(transform.linear().determinant(), 1.0, 1e-9);
  for (int k = 0; k < 3; ++k) {
    EXPECT_GT(transform.linear().row(k).cwiseAbs().maxCoeff(), std::cos(0.02)) << "an axis of the box";
    const auto axis = json["axes"][k].get<std::vector<double>>();
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(axis.at(i), transform(k, i), 1e-9) << "axes are the rows of the transform";
    EXPECT_GT(json["scores"][k].get<double>(), 0.5);
  }
  EXPECT_EQ(json["revolution_axis"], -1);
  EXPECT_NE(reportOf(box_ + " -as_published")["scores"], json["scores"]);
  const Shape out = loadShape(folder_ / "out.pcd");
  EXPECT_EQ(out.points->size(), 10000u);
  EXPECT_NE(output_.find("center"), std::string::npos);
}

TEST_F(AlignTool, KeepsCoordinatesBeyondFloatPrecision) {
  const Eigen::Vector3d center(500000.5, 5000000.4, 100.3);
  const std::string far = folder_.write("far.off", boxOFF(boxCorners({0.5, 0.4, 0.3}).colwise() + center));
  const nlohmann::json report = reportOf(far + " " + (folder_ / "out.pcd"));
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(report["center"][k].get<double>(), center[k], 0.01);
  EXPECT_LT((transformOf(report) * center).norm(), 0.02) << "of the input frame";
  const Shape turned = loadShape(folder_ / "out.pcd");
  for (const pcl::PointXYZ& point : *turned.points)
    ASSERT_LT(point.getVector3fMap().norm(), 0.75f) << "half of the diagonal is 0.71";
}

TEST_F(AlignTool, BringsAScanToItsModel) {
  Eigen::Isometry3d T_scan_model;
  const std::string scan = scanOfChair(T_scan_model);
  const nlohmann::json json = reportOf(scan + " " + (folder_ / "out.pcd") + " -target " + chair_);
  EXPECT_EQ(json["converged"], true);
  const Eigen::Isometry3d transform = transformOf(json);
  const Eigen::Isometry3d error = transform * T_scan_model;
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.02) << "the chair has no rotation of its own";
  EXPECT_LT(error.translation().norm(), 0.03);
  EXPECT_LT(json["fitness"].get<double>(), 0.03 * 0.03) << "mean squared distance";

  const Shape before = loadShape(scan), after = loadShape(folder_ / "out.pcd");
  ASSERT_EQ(before.points->size(), after.points->size());
  const Eigen::Vector3d p = (*before.points)[7].getVector3fMap().cast<double>();
  EXPECT_LT((transform * p - (*after.points)[7].getVector3fMap().cast<double>()).norm(), 1e-4);
  Eigen::Vector3f n, moved;
  const char* names[3] = {"normal_x", "normal_y", "normal_z"};
  for (int k = 0; k < 3; ++k) {
    n[k] = fieldOf<float>(before.cloud, names[k], 7);
    moved[k] = fieldOf<float>(after.cloud, names[k], 7);
  }
  EXPECT_LT((transform.linear().cast<float>() * n - moved).norm(), 1e-4) << "normals turn";
  EXPECT_EQ(fieldOf<std::uint32_t>(after.cloud, "label", 7), 7u) << "other fields stay";
  const Eigen::Vector3d sensor = transform * before.sensor_origin.head<3>().cast<double>();
  EXPECT_LT((sensor - after.sensor_origin.head<3>().cast<double>()).norm(), 1e-3) << "the scanner moves along";
}

TEST_F(AlignTool, SaysThatNothingFits) {
  Eigen::Isometry3d T_scan_model;
  const std::string scan = scanOfChair(T_scan_model);
  EXPECT_EQ(run(scan + " " + (folder_ / "never.pcd") + " -quiet -target " + box_ + " -json " + (folder_ / "r.json")),
            1);
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  EXPECT_NE(error_.find("does not fit"), std::string::npos) << error_;
  EXPECT_EQ(nlohmann::json::parse(contentOf(folder_ / "r.json"))["converged"], false);
  EXPECT_EQ(contentOf(folder_ / "never.pcd"), "");
}

TEST_F(AlignTool, CompletesAScanAndMarksWhatItAdds) {
  Eigen::Isometry3d T_scan_model;
  const std::string scan = scanOfChair(T_scan_model);
  ASSERT_EQ(run(scan + " " + (folder_ / "out.pcd") + " -complete -target " + chair_ + " -html " + (folder_ / "o.html")),
            0)
      << error_;
  EXPECT_NE(contentOf(folder_ / "o.html").find("what completes it"), std::string::npos);
  const Shape before = loadShape(scan), after = loadShape(folder_ / "out.pcd");
  const Eigen::Vector3d normal = T_scan_model.linear().col(0);
  const ReflectionPlane true_plane(normal, normal.dot(T_scan_model.translation()));
  pcl::PointCloud<pcl::PointXYZ> cloud = *before.points;
  cloud.sensor_origin_ = before.sensor_origin;
  const auto expected = static_cast<double>(completeBySymmetry(cloud, true_plane).added.size());
  ASSERT_GT(expected, 100.0) << "a side of it was hidden";
  EXPECT_NEAR(static_cast<double>(after.points->size() - before.points->size()), expected, 0.2 * expected);
  for (std::size_t i = 0; i < after.points->size(); ++i) {
    const int source = fieldOf<std::int32_t>(after.cloud, "reflected_of", i);
    if (i < before.points->size()) {
      ASSERT_EQ(source, -1) << i;
      continue;
    }
    ASSERT_GE(source, 0);
    ASSERT_EQ(fieldOf<std::uint32_t>(after.cloud, "label", i), static_cast<std::uint32_t>(source));
    const auto p = (*after.points)[i].getVector3fMap(), q = (*after.points)[source].getVector3fMap();
    ASSERT_LT((Eigen::Vector3f(-q.x(), q.y(), q.z()) - p).norm(), 0.1) << "reflected at x = 0 of the model";
  }
}

/// A box whose right end stands 0.02 further out than its left one, about x = 0.01.
TEST_F(AlignTool, SymmetrizesAMeshAndACloud) {
  Eigen::Matrix3Xd corners = boxCorners({2.0, 1.5, 1.0});
  corners(0, 1) = corners(0, 5) = 2.02;
  const std::string mesh = folder_.write("m.off", boxOFF(corners));
  const std::string landmarks = folder_.write("l.txt", "# ends\n-2 0 0, 2 0 0\n0 1.5 0\n");
  const nlohmann::json found =
      reportOf(mesh + " " + (folder_ / "s.ply") + " -symmetrise mean -landmarks " + landmarks)["symmetrised"];
  EXPECT_LT(found["deviation"].get<double>(), 1e-5 * 5.0);
  EXPECT_LT(found["greatest_asymmetry"].get<double>(), 0.025);
  EXPECT_EQ(found["landmarks"]["paired"].size(), 1u);
  EXPECT_EQ(found["landmarks"]["midline"].size(), 1u);
  const Shape written = loadShape(folder_ / "s.ply");
  ASSERT_TRUE(written.mesh);
  EXPECT_EQ(written.mesh->polygons.size(), 6u);
  EXPECT_TRUE(std::isfinite(fieldOf<float>(written.cloud, "asymmetry", 3)));
  EXPECT_NE(output_.find("from its own reflection, exact with -cut\nlandmarks: object asymmetry"), std::string::npos);
  ASSERT_EQ(run(mesh + " " + (folder_ / "c.ply") + " -symmetrise mean -cut"), 0) << error_;
  EXPECT_EQ(loadShape(folder_ / "c.ply").mesh->polygons.size(), 28u) << "two triangles of an end, twelve of four sides";
  EXPECT_TRUE(fails(mesh + " " + (folder_ / "s.pcd") + " -symmetrise mean", 2, ".ply"));
  const std::string bad = folder_.write("bad.txt", "1 2 3\n1 2\n");
  EXPECT_TRUE(fails(mesh + " -symmetrise mean -landmarks " + bad, 1, "bad.txt: line 2"));
  ASSERT_EQ(run(mesh + " -complete -symmetrise mean"), 2);

  Eigen::Isometry3d T_scan_model;
  const std::string scan = scanOfChair(T_scan_model);
  ASSERT_EQ(run(scan + " " + (folder_ / "out.pcd") + " -symmetrise left -target " + chair_), 0) << error_;
  const Shape after = loadShape(folder_ / "out.pcd");
  const std::size_t half = after.points->size() / 2;
  for (std::size_t i = 0; i < half; ++i) {
    ASSERT_EQ(fieldOf<std::int32_t>(after.cloud, "reflected_of", half + i), static_cast<int>(i));
    const auto p = (*after.points)[half + i].getVector3fMap(), q = (*after.points)[i].getVector3fMap();
    ASSERT_LT((Eigen::Vector3f(-q.x(), q.y(), q.z()) - p).norm(), 0.1) << "reflected at x = 0 of the model";
  }
}

}  // namespace
