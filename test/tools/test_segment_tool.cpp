#include <gtest/gtest.h>
#include <pcl/PCLPointCloud2.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>

#include "io/mesh_output.h"
#include "pictures/raster_image.h"
#include "shapes/meshes.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using nlohmann::json;

class SegmentTool : public ToolTest {
protected:
  SegmentTool() : ToolTest(toolPath("segment")) {
    folder_.write("dumbbell.off", offText(dumbbell_.vertices.cast<double>(), dumbbell_.polygons));
  }

  const test::Mesh dumbbell_ = test::dumbbell();
  const std::string mesh_ = folder_ / "dumbbell.off", seg_ = folder_ / "out.seg", json_ = folder_ / "tree.json";
};

TEST_F(SegmentTool, WritesASegmentForEachFaceATreeAndAPicture) {
  ASSERT_EQ(run(mesh_ + " " + seg_ + " -parts 3 -json " + json_ + " -size 300 -png " + (folder_ / "p.png")), 0)
      << error_;
  const std::vector<int> labels = apps::readFaceLabels(seg_);
  ASSERT_EQ(labels.size(), dumbbell_.polygons.size());
  EXPECT_EQ(std::set<int>(labels.begin(), labels.end()), (std::set<int>{0, 1, 2}));
  const json tree = json::parse(contentOf(json_));
  EXPECT_EQ(tree["elements"], "faces");
  ASSERT_EQ(tree["segments"].size(), 3u);
  EXPECT_EQ(tree["segments"][0]["size"], std::count(labels.begin(), labels.end(), 0));
  ASSERT_EQ(tree["tree"].size(), 5u) << "three leaves of a binary tree";
  EXPECT_EQ(tree["tree"][0]["parent"], -1);
  EXPECT_FALSE(tree["tree"][0]["planes"].empty());
  EXPECT_NE(error_.find("3 parts"), std::string::npos) << error_;
  const apps::RasterImage picture = apps::readImage(folder_ / "p.png");
  EXPECT_EQ(picture.width, 300);
  EXPECT_EQ(picture.height, 300);
  ASSERT_EQ(run(mesh_ + " -parts 3 -size 300 -up 1,0,0 -png " + (folder_ / "q.png")), 0) << error_;
  EXPECT_NE(apps::readImage(folder_ / "q.png").pixels, picture.pixels);
}

TEST_F(SegmentTool, MethodsOfThePaper) {
  ASSERT_EQ(run(mesh_ + " " + seg_ + " -method splitting -depth 1 -quiet"), 0) << error_;
  const std::vector<int> labels = apps::readFaceLabels(seg_);
  EXPECT_EQ(*std::max_element(labels.begin(), labels.end()), 1);
  EXPECT_EQ(error_, "");
}

TEST_F(SegmentTool, LabelsPointsOfCloudsAndKeepsTheirFields) {
  std::ostringstream pcd;
  pcd << "VERSION .7\nFIELDS x y z weight\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH "
      << dumbbell_.polygons.size() << "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " << dumbbell_.polygons.size()
      << "\nDATA ascii\n";
  for (std::size_t f = 0; f < dumbbell_.polygons.size(); ++f) pcd << dumbbell_.center(f).transpose() << " 7\n";
  const std::string cloud = folder_.write("cloud.pcd", pcd.str()), out = folder_ / "labelled.pcd";
  ASSERT_EQ(run(cloud + " " + out + " -parts 2 -png " + (folder_ / "p.png")), 0) << error_;
  pcl::PCLPointCloud2 labelled;
  ASSERT_EQ(pcl::io::loadPCDFile(out, labelled), 0);
  ASSERT_EQ(labelled.fields.size(), 5u);
  std::set<std::string> names;
  for (const pcl::PCLPointField& field : labelled.fields) names.insert(field.name);
  EXPECT_EQ(names, (std::set<std::string>{"x", "y", "z", "weight", "label"}));
  EXPECT_EQ(labelled.width, dumbbell_.polygons.size());
  EXPECT_EQ(run(cloud + " " + seg_), 1) << "a cloud has no faces";
}

TEST_F(SegmentTool, ColoursTheFacesOfAMeshInPLY) {
  const std::string out = folder_ / "parts.ply";
  ASSERT_EQ(run(mesh_ + " " + out + " -parts 2"), 0) << error_;
  const std::string ply = contentOf(out);
  EXPECT_NE(ply.find("element face " + std::to_string(dumbbell_.polygons.size())), std::string::npos);
  EXPECT_NE(ply.find("property int label"), std::string::npos);
}

TEST_F(SegmentTool, RefusesWhatDoesNotFitTogether) {
  EXPECT_EQ(run(mesh_ + " out.obj"), 2);
  EXPECT_EQ(run(mesh_ + " -depth 2"), 2) << "needs the paper's method";
  EXPECT_EQ(run(mesh_ + " -method splitting -evidence all"), 2);
  EXPECT_EQ(run(mesh_ + " -parts -1"), 2);
  EXPECT_EQ(run(folder_ / "none.off"), 1);
}

}  // namespace
