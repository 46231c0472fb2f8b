/// Shapes made by code: their symmetries are what construction says, and each kind prints its table.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"
#include "evaluate/mesh/mesh_reflection.h"
#include "evaluate/shapes/swept_shape.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
using nlohmann::json;

double shareOfPlane(const SweptShape& shape, const ReflectionPlane& plane) {
  const TriangleScene scene(shape.mesh);
  const MeshReflection reflection(scene, 1000, 1);
  const double offset = (plane.offset() - plane.normal().dot(scene.center())) / scene.diagonal();
  return reflection.share(ReflectionPlane(plane.normal(), offset), 0.001);
}

TEST(SweptShape, HasThePlanesOfItsFolds) {
  RandomStream random(1);
  for (const bool report : {false, true})
    for (const std::string& body : foldedBodies())
      for (const int folds : {2, 5, 12}) {
        const SweptShape shape = foldedShape(body, folds, report, random);
        const bool has_ends = body == "prism" || body == "tube" || body == "rim";
        EXPECT_EQ(shape.planes.size(), static_cast<std::size_t>(folds + (has_ends ? 1 : 0))) << body;
        for (const ReflectionPlane& plane : shape.planes) EXPECT_EQ(shareOfPlane(shape, plane), 1.0) << body << folds;
        EXPECT_GT(areaOf(shape.mesh), 0.0);
      }
}

TEST(SweptShape, FewFoldsAreNotRoundAndManySidesAre) {
  RandomStream random(2);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(foldedShape("tube", 5, false, random).isNearlyRound());
  bool is_any_round = false;  // polygons of 24 sides are, flowers are not
  for (int i = 0; i < 20; ++i) is_any_round |= foldedShape("tube", 24, false, random).isRound();
  EXPECT_TRUE(is_any_round);
}

TEST(SweptShape, RoundBodiesHaveEveryPlaneThroughTheAxis) {
  RandomStream random(3);
  for (const bool report : {false, true})
    for (const std::string& body : roundBodies(report)) {
      const SweptShape shape = roundShape(body, random);
      EXPECT_TRUE(shape.isRound());
      EXPECT_EQ(shareOfPlane(shape, ReflectionPlane({std::cos(0.3), std::sin(0.3), 0.0}, 0.0)), 1.0) << body;
    }
  EXPECT_EQ(roundShape("ball", random).planes.size(), 1u) << "the plane across";
  EXPECT_THROW(roundShape("cube", random), std::invalid_argument);
}

class EvaluateShapes : public ToolTest {
protected:
  EvaluateShapes() : ToolTest(toolPath("evaluate")) {}

  /// \return the rows by their names.
  std::map<std::string, json> rows(const std::string& arguments) {
    const std::string path = folder_ / "report.json";
    EXPECT_EQ(run("shapes " + arguments + " -quiet -json " + path), 0) << error_;
    std::map<std::string, json> rows;
    const json report = json::parse(contentOf(path));
    for (const json& row : report["rows"]) rows[row["row"]] = row;
    return rows;
  }
};

TEST_F(EvaluateShapes, CountsPlanesOfFolds) {
  auto tuning = rows("folds -num 6 -points 2000 -csv " + (folder_ / "folds.csv"));
  EXPECT_GT(tuning["all"]["recall, 5 deg"]["count"].get<int>(), 0);
  EXPECT_LE(tuning["all"]["recall, 1 deg"]["count"], tuning["all"]["recall, 5 deg"]["count"]);
  EXPECT_NE(output_.find("% of "), std::string::npos);
  EXPECT_NE(contentOf(folder_ / "folds.csv").find("open cone,"), std::string::npos);
  auto report = rows("folds -num 6 -points 2000 -half report");
  EXPECT_NE(tuning["all"], report["all"]) << "other shapes";
  EXPECT_EQ(rows("folds -num 6 -points 2000 -half report")["all"], report["all"]) << "the same shapes again";
}

TEST_F(EvaluateShapes, CountsViewsRandomCloudsAndComposites) {
  EXPECT_EQ(rows("views -num 2 -points 1500")["all"]["no symmetry"]["total"], 2);
  const auto random = rows("random -num 8");
  EXPECT_EQ(random.size(), 9u) << "eight kinds and all";
  EXPECT_EQ(random.at("fewer than 20 points")["called symmetric"]["count"], 0);
  EXPECT_GT(rows("composites -num 1 -points 1500")["all"]["planes of parts found"]["total"], 0);
}

TEST_F(EvaluateShapes, ComparesModelsAtDifferentNumbersOfPoints) {
  folder_.write("box.off", boxOFF());
  auto counts = rows("counts " + (folder_ / "") + " -num 1");
  EXPECT_EQ(counts["all three"]["same decision"]["count"], 1) << "a box";
}

TEST_F(EvaluateShapes, RefusesUnknownKinds) {
  EXPECT_EQ(run("shapes cubes"), 2);
  EXPECT_NE(error_.find("must be one of folds, views, turns, random, composites, counts"), std::string::npos) << error_;
  EXPECT_EQ(run("shapes counts"), 2) << "needs a folder";
}

}  // namespace
