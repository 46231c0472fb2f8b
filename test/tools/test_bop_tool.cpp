/// Symmetries of models: files of them, which mean what those who read them make of them, and the tool.
#include <gtest/gtest.h>
#include <pcl/common/io.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "bop/models_info.h"
#include "core/base/constants.h"
#include "io/shape_input.h"
#include "pictures/raster_image.h"
#include "shapes/complaint.h"
#include "shapes/temporary_folder.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

using nlohmann::json;

class BopTool : public ToolTest {
protected:
  BopTool() : ToolTest(toolPath("bop")) {}

  json infoOf(const std::string& arguments) { return reportOf(arguments + " -quiet"); }

  static Eigen::Matrix4d matrixOf(const json& numbers) {
    const auto values = numbers.get<std::vector<double>>();
    EXPECT_EQ(values.size(), 16u);
    return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data());
  }

  const std::string json_ = folder_ / "report.json";
  const std::string box_ = folder_.write("obj_000003.off", boxOFF());
  const std::string vase_ = folder_.write("obj_000012.off", vaseOFF());
};

TEST_F(BopTool, DescribesABoxAsTheBenchmarkDoes) {
  const json info = infoOf(box_);
  ASSERT_EQ(info.size(), 1u);
  const json& box = info.at("3");
  EXPECT_EQ(box["diameter"], 2.0 * std::sqrt(1.0 + 1.5 * 1.5 + 4.0)) << "of the vertices, exactly";
  EXPECT_EQ(box["min_x"], -1.0);
  EXPECT_EQ(box["min_y"], -1.5);
  EXPECT_EQ(box["min_z"], -2.0);
  EXPECT_EQ(box["size_x"], 2.0);
  EXPECT_EQ(box["size_y"], 3.0);
  EXPECT_EQ(box["size_z"], 4.0);
  EXPECT_FALSE(box.contains("symmetries_continuous")) << "what there is none of is left out";
  ASSERT_EQ(box["symmetries_discrete"].size(), 3u);
  for (const json& symmetry : box["symmetries_discrete"]) {
    const Eigen::Matrix4d T = matrixOf(symmetry);
    EXPECT_EQ(T.row(3), Eigen::RowVector4d(0, 0, 0, 1)) << "row by row";
    EXPECT_NEAR(T.determinant(), 1.0, 1e-9);
    EXPECT_NEAR(T.trace(), 0.0, 1e-9) << "by pi";
    EXPECT_LT((T.cwiseAbs() - Eigen::Matrix4d::Identity()).cwiseAbs().maxCoeff(), 0.02) << "about a coordinate axis";
  }
}

TEST_F(BopTool, GivesBodiesOfRevolutionAnAxisAndCylindersAFlip) {
  const json vase = infoOf(vase_).at("12");
  EXPECT_FALSE(vase.contains("symmetries_discrete"));
  ASSERT_EQ(vase["symmetries_continuous"].size(), 1u);
  const auto axis = vase["symmetries_continuous"][0]["axis"].get<std::vector<double>>();
  const auto offset = vase["symmetries_continuous"][0]["offset"].get<std::vector<double>>();
  EXPECT_NEAR(std::abs(axis[2]), 1.0, 1e-4);
  EXPECT_NEAR(offset[0], 0.0, 0.01);
  EXPECT_NEAR(offset[1], 0.0, 0.01);

  const json cylinder = infoOf(folder_.write("can.off", offText(test::cylinderShape()))).at("1");
  ASSERT_EQ(cylinder["symmetries_continuous"].size(), 1u);
  ASSERT_EQ(cylinder["symmetries_discrete"].size(), 1u);
  const Eigen::Matrix4d flip = matrixOf(cylinder["symmetries_discrete"][0]);
  EXPECT_NEAR(flip(2, 2), -1.0, 1e-3) << "end over end";
}

TEST_F(BopTool, GivesASphereAnAxisAndTiltsAndAnAsymmetricModelNothing) {
  const std::string ball = folder_.write("ball.off", offText(test::ballShape()));
  const json sphere = infoOf(ball + " -sphere_angle 90").at("1");
  EXPECT_EQ(sphere["symmetries_continuous"].size(), 1u);
  ASSERT_EQ(sphere["symmetries_discrete"].size(), 1u) << "upside down";
  EXPECT_NEAR(matrixOf(sphere["symmetries_discrete"][0])(2, 2), -1.0, 1e-9);
  const json tetrahedron = infoOf(folder_.write("m7.off", tetrahedronOFF())).at("7");
  EXPECT_FALSE(tetrahedron.contains("symmetries_continuous"));
  EXPECT_FALSE(tetrahedron.contains("symmetries_discrete"));
  EXPECT_NE(output_.find("group C1"), std::string::npos) << output_;
}

TEST_F(BopTool, ExplainsWhatFails) {
  const std::string mug = folder_.write("mug.off", offText(test::cupShape(true)));
  infoOf(mug + " -explain -failures " + (folder_ / "failures"));
  EXPECT_NE(output_.find("  tolerance "), std::string::npos) << output_;
  ASSERT_NE(output_.find("  rejected "), std::string::npos) << output_;
  const Shape shape = loadShape(folder_ / "failures/mug_rejected_1.ply");
  EXPECT_EQ(shape.points->size(), 20'000u);
  EXPECT_GE(pcl::getFieldIndex(shape.cloud, "rgb"), 0);
}

TEST_F(BopTool, NumbersModelsAsTheirFilesOrElseByTheFirstFreeNumber) {
  const std::string zero = folder_.write("obj_000000.off", boxOFF()), plain = folder_.write("vase.off", vaseOFF());
  const json info = infoOf(vase_ + " " + box_ + " " + plain + " " + zero + " -points 1000");
  EXPECT_EQ(info.size(), 4u);
  for (const char* key : {"0", "1", "3", "12"}) EXPECT_TRUE(info.contains(key)) << key;
  const std::string text = contentOf(json_);
  EXPECT_LT(text.find("\"3\""), text.find("\"12\"")) << "by number";
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 6) << "a line for each";
}

TEST_F(BopTool, RefusesTwoModelsOfOneNumber) {
  const std::string other = folder_.write("copy_3.off", boxOFF());
  EXPECT_TRUE(fails(box_ + " " + other + " -json " + json_, 2, "both model 3"));
}

TEST_F(BopTool, TakesFolders) {
  std::filesystem::create_directories(folder_ / "models");
  folder_.write("models/obj_000002.off", boxOFF());
  folder_.write("models/obj_000010.off", "OFF\n1 0 0\n0 0 0\n");
  folder_.write("models/obj_000011.off", boxOFF());
  folder_.write("models/other.off", boxOFF());
  folder_.write("models/readme.txt", "no model");
  EXPECT_EQ(run((folder_ / "models") + " -quiet -points 1000 -grid 32 -json " + json_), 1) << "one has no surface";
  const json info = json::parse(contentOf(json_));
  EXPECT_EQ(info.size(), 2u);
  EXPECT_TRUE(info.contains("2") && info.contains("11"));
  EXPECT_NE(error_.find("obj_000010.off"), std::string::npos) << error_;
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  std::filesystem::create_directories(folder_ / "empty");
  EXPECT_TRUE(fails((folder_ / "empty") + " -json " + json_, 1, "holds no .pcd"));
}

/// The box has D2; its file lists one of three half turns, and one turn that is none.
TEST_F(BopTool, SaysWhereAFileDisagreesWithTheSurface) {
  const std::string given =
      folder_.write("given.json", R"({"3": {"symmetries_discrete": [[1,0,0,0, 0,-1,0,0, 0,0,-1,0, 0,0,0,1]]},
          "12": {"symmetries_continuous": [{"axis": [0,0,1], "offset": [0,0,0]}]}})");
  const std::string report = folder_ / "check.json", plain = folder_.write("plain.off", boxOFF());
  ASSERT_EQ(
      run(box_ + " " + vase_ + " " + plain + " -quiet -points 2000 -grid 32 -check " + given + " -report " + report), 0)
      << error_;
  EXPECT_NE(output_.find("model 12     file Cinf  surface Cinf  agree"), std::string::npos) << output_;
  EXPECT_NE(output_.find("1 of 2 models disagree"), std::string::npos) << output_;
  const json checked = json::parse(contentOf(report));
  EXPECT_EQ(checked["missing"], json::array({"1"}));
  EXPECT_EQ(checked["disagreeing"], 1);
  const json& box = checked["models"]["3"];
  EXPECT_EQ(box["file"], "C2");
  EXPECT_EQ(box["surface"], "D2");
  ASSERT_EQ(box["disagreements"].size(), 2u) << "axes y and z";
  for (const json& row : box["disagreements"]) {
    EXPECT_EQ(row["says"], "surface only");
    EXPECT_NEAR(row["angle"].get<double>(), 180.0, 1e-6);
    EXPECT_GT(row["share"].get<double>(), 0.97);
    EXPECT_LT(row["deviation_of_diameter"].get<double>(), 0.01);
  }
  EXPECT_EQ(run(box_ + " -report " + report), 2) << "nothing to compare with";
}

TEST_F(BopTool, ShowsThatATurnInAFileIsNone) {
  const std::string given =
      folder_.write("model_info.json", R"({"symmetries_discrete": [[0,-1,0,0, 1,0,0,0, 0,0,1,0, 0,0,0,1]]})");
  const std::string report = folder_ / "check.json";
  ASSERT_EQ(run(box_ + " -quiet -points 2000 -grid 32 -check " + given + " -report " + report), 0) << error_;
  const json box = json::parse(contentOf(report))["models"]["3"];
  EXPECT_EQ(box["file"], "C4");
  EXPECT_EQ(box["remark"], "lists 1 of the 3 rotations of C4");
  const json& row = box["disagreements"][0];
  EXPECT_EQ(row["says"], "file only");
  // A quarter turn about z swaps sides of 2 and 3: the long sides, 2 x 2 x 4 of the area 52, land 0.5 inside or
  // outside.
  EXPECT_LT(row["share"].get<double>(), 0.5);
  EXPECT_GT(row["deviation"].get<double>(), 0.3);
  EXPECT_EQ(run(box_ + " " + vase_ + " -quiet -check " + given), 1) << "a file of one model";
}

TEST_F(BopTool, AgreesWithWhatItWroteInEveryFormat) {
  const std::string isaac = folder_ / "isaac.yaml", dope = folder_ / "dope";
  ASSERT_EQ(run(box_ + " -quiet -points 2000 -grid 32 -json " + json_ + " -isaac " + isaac + " -dope " + dope), 0)
      << error_;
  EXPECT_NE(contentOf(isaac).find(R"("3": ["x_180", "y_180", "z_180"]  # D2)"), std::string::npos) << contentOf(isaac);
  for (const std::string& file : {json_, isaac, dope + "/obj_000003/model_info.json"}) {
    ASSERT_EQ(run(box_ + " -quiet -points 2000 -grid 32 -check " + file), 0) << error_;
    EXPECT_NE(output_.find("0 of 1 models disagree"), std::string::npos) << file << output_;
  }
}

/// A cube whose sides have vertices of their own.
/// \param size squares along an edge.
/// \param more what a vertex has besides its position, of its side, and u and v from 0 to 1 there.
template <typename More>
std::string cubePLY(const std::string& comment, const std::string& properties, int size, const More& more) {
  std::ostringstream vertices, faces;
  int num_vertices = 0;
  for (int side = 0; side < 6; ++side) {
    const Eigen::Vector3d normal = (side % 2 == 0 ? 1.0 : -1.0) * Eigen::Vector3d::Unit(side / 2);
    const Eigen::Vector3d a = Eigen::Vector3d::Unit((side / 2 + 1) % 3), b = normal.cross(a);
    for (int i = 0; i <= size; ++i)
      for (int k = 0; k <= size; ++k, ++num_vertices) {
        const double u = double(i) / size, v = double(k) / size;
        vertices << (normal + (2.0 * u - 1.0) * a + (2.0 * v - 1.0) * b).transpose() << ' ' << more(side, u, v) << '\n';
        if (i == size || k == size) continue;
        faces << "4 " << num_vertices << ' ' << num_vertices + size + 1 << ' ' << num_vertices + size + 2 << ' '
              << num_vertices + 1 << '\n';
      }
  }
  return "ply\nformat ascii 1.0\n" + comment + "element vertex " + std::to_string(num_vertices) +
         "\nproperty float x\nproperty float y\nproperty float z\n" + properties + "element face " +
         std::to_string(6 * size * size) + "\nproperty list uchar int vertex_indices\nend_header\n" + vertices.str() +
         faces.str();
}

/// One side is red where it is told, all others are gray.
std::string coloredCube(bool has_red_side) {
  return cubePLY("", "property uchar red\nproperty uchar green\nproperty uchar blue\n", 6,
                 [=](int side, double, double) { return side == 4 && has_red_side ? "200 20 20" : "120 120 120"; });
}

/// The sides show the white half of the picture, but one: that shows the whole picture if \p is_printed.
std::string texturedCube(const std::string& texture, bool is_printed) {
  return cubePLY("comment TextureFile " + texture + "\n", "property float texture_u\nproperty float texture_v\n", 1,
                 [=](int side, double u, double v) {
                   const double top = is_printed && side == 4 ? 1.0 : 0.45;
                   return std::to_string(0.05 + 0.9 * u) + " " + std::to_string(0.05 + (top - 0.1) * v);
                 });
}

TEST_F(BopTool, AsksForColorsOnlyWhenItIsTold) {
  const std::string plain = folder_.write("obj_1.ply", coloredCube(false)),
                    red = folder_.write("obj_2.ply", coloredCube(true));
  ASSERT_EQ(run(red + " -quiet -points 2000 -grid 32"), 0) << error_;
  EXPECT_NE(output_.find("1 of 1 models have colors, which were not looked at"), std::string::npos) << output_;
  EXPECT_NE(output_.find("obj_2.ply  group O"), std::string::npos) << output_;
  ASSERT_EQ(run(plain + " " + red + " -quiet -points 2000 -grid 32 -colour"), 0) << error_;
  EXPECT_EQ(output_.find("not looked at"), std::string::npos) << output_;
  EXPECT_NE(output_.find("obj_1.ply  group O"), std::string::npos) << output_;
  EXPECT_NE(output_.find("obj_2.ply  group C4"), std::string::npos) << output_;
  EXPECT_NE(output_.find("without its colors the group is O"), std::string::npos) << output_;
  // The same red cube with its colors as coordinates in a texture that it does not name.
  std::string textured = coloredCube(true);
  for (const auto& [from, to] : {std::pair("uchar red", "uchar texture_u"), std::pair("uchar green", "uchar texture_v"),
                                 std::pair("uchar blue", "uchar other")})
    textured.replace(textured.find(from), std::string(from).size(), to);
  ASSERT_EQ(run(folder_.write("obj_3.ply", textured) + " -quiet -points 1000 -grid 32 -colour"), 0) << error_;
  EXPECT_NE(output_.find("only those of vertices, and textures that PLY files name, can be read"), std::string::npos)
      << output_;
}

TEST_F(BopTool, ReadsTheTextureThatAModelOfTheBenchmarkNames) {
  apps::RasterImage image(64, 64);
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) image.set(x, y, {1.0, 0.0, 0.0});
  apps::writeImage(image, folder_ / "print.png");
  const std::string red = texturedCube("print.png", true), white = texturedCube("print.png", false);
  ASSERT_EQ(run(folder_.write("obj_1.ply", white) + " " + folder_.write("obj_2.ply", red) +
                " -quiet -points 2000 -grid 32 -colour"),
            0)
      << error_;
  EXPECT_EQ(output_.find("not looked at"), std::string::npos) << output_;
  EXPECT_NE(output_.find("obj_1.ply  group O"), std::string::npos) << output_;
  // v runs from bottom to top: half of that side is red.
  EXPECT_NE(output_.find("obj_2.ply  group C1"), std::string::npos) << output_;
  EXPECT_TRUE(
      fails(folder_.write("obj_3.ply", texturedCube("missing.png", true)) + " -quiet -colour", 1, "missing.png"));
}

const Eigen::Vector3d kX = Eigen::Vector3d::UnitX(), kZ = Eigen::Vector3d::UnitZ(), kCenter(10.0, -4.0, 7.0);

Eigen::Isometry3d turn(const Eigen::Vector3d& axis, double angle, const Eigen::Vector3d& center = kCenter) {
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = rotationAbout(axis, angle);
  motion.translation() = center - motion.linear() * center;
  return motion;
}

double angleBetween(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
  return Eigen::AngleAxisd(a.transpose() * b).angle();
}

TEST(ModelsInfo, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  const ObjectSymmetries prism = ObjectSymmetries::from({turn(kZ, kPi / 3.0), turn(kX, kPi)}, {});
  const nlohmann::ordered_json file{{"7", symmetriesJson({prism.discrete, {}})},
                                    {"12", symmetriesJson({{}, {{kZ, kCenter}}})},
                                    {"13", {{"diameter", 3.0}}}};
  const auto models = readModelsInfo(folder.write("models_info.json", file.dump()));
  ASSERT_EQ(models.size(), 3u);
  const ListedSymmetries& read = models.at("7");
  ASSERT_EQ(read.discrete.size(), 11u);
  for (std::size_t i = 0; i < 11; ++i) EXPECT_TRUE(read.discrete[i].isApprox(prism.discrete[i], 1e-9));
  ASSERT_EQ(models.at("12").continuous.size(), 1u);
  EXPECT_EQ(models.at("12").continuous[0].offset, kCenter);
  EXPECT_TRUE(models.at("13").discrete.empty() && models.at("13").continuous.empty());
}

TEST(ModelsInfo, OfDopeIsAFileOfOneModel) {
  const TemporaryFolder folder;
  const ObjectSymmetries can = ObjectSymmetries::from({turn(kX, kPi)}, {{kZ, kCenter}});
  const nlohmann::ordered_json entry = dopeJson(can, 0.3);
  ASSERT_EQ(entry["align_axes"].size(), 2u);
  const auto across = entry["align_axes"][0]["object"].get<std::vector<double>>();
  EXPECT_NEAR(across[2], 0.0, 1e-12) << "across the axis";
  EXPECT_EQ(entry["align_axes"][1]["object"].get<std::vector<double>>(), (std::vector<double>{0.0, 0.0, 1.0}));
  const auto models = readModelsInfo(folder.write("model_info.json", entry.dump()));
  ASSERT_EQ(models.count(""), 1u);
  EXPECT_EQ(models.at("").discrete.size(), 1u);
  EXPECT_TRUE(dopeJson(ObjectSymmetries::from({}, {}), 0.3).empty()) << "nothing to choose from";
  const auto rows = readModelsInfo(folder.write(
      "rows.json", R"({"symmetries_discrete": [[[1, 0, 0, 0], [0, -1, 0, 0], [0, 0, -1, 0], [0, 0, 0, 1]]]})"));
  EXPECT_EQ(rows.at("").discrete.size(), 1u) << "a matrix as rows";
}

TEST(ModelsInfo, RefusesWhatIsNoMotion) {
  const TemporaryFolder folder;
  const auto messageOf = [&](const std::string& text) {
    return test::complaintOf<InputError>([&] { readModelsInfo(folder.write("bad.json", text)); });
  };
  const std::pair<const char*, const char*> wrong[] = {
      {"[1]", "bad.json: must be a JSON object"},
      {R"({"3": {"symmetries_discrete": [[1, 2]]}})", "model 3: symmetries_discrete[0], must be 16"},
      {R"({"3": {"symmetries_discrete": [[2,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]}})", "rigid motion"},
      {R"({"3": {"symmetries_discrete": [[-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]]}})", "rigid motion"},  // a reflection
      {R"({"3": {"symmetries_continuous": [{"axis": [0,0,0]}]}})", "must not be zero"},
      {R"({"3": {"symmetries_continuous": {"axis": [0,0,1]}}})", "must be a list"}};
  for (const auto& [text, said] : wrong) EXPECT_NE(messageOf(text).find(said), std::string::npos) << text;
}

/// Isaac composes a turn about z with one about y and one about x, the identity among each.
std::size_t numIsaacRotations(const std::vector<std::string>& axes) {
  std::vector<Eigen::Matrix3d> about[3], all;
  for (int k = 0; k < 3; ++k) about[k].push_back(Eigen::Matrix3d::Identity());
  for (const std::string& text : axes) {
    const int k = text[0] - 'x';
    about[k].push_back(rotationAbout(Eigen::Vector3d::Unit(k), std::stod(text.substr(2)) * kDegree));
  }
  for (const auto& x : about[0])
    for (const auto& y : about[1])
      for (const auto& z : about[2]) {
        const Eigen::Matrix3d rotation = z * y * x;
        if (std::none_of(all.begin(), all.end(),
                         [&](const auto& other) { return angleBetween(rotation, other) < 1e-4; }))
          all.push_back(rotation);
      }
  return all.size();
}

TEST(IsaacAxes, ComposeTheGroup) {
  using Kind = RotationGroupKind;
  const auto groupOf = [](Kind kind, int fold) {
    std::vector<Eigen::Isometry3d> generators;
    for (const Eigen::Matrix3d& rotation : RotationGroup{kind, fold}.generators()) {
      const Eigen::AngleAxisd angle_axis(rotation);
      generators.push_back(turn(angle_axis.axis(), angle_axis.angle()));
    }
    return ObjectSymmetries::from(generators, {});
  };
  for (const auto& [kind, fold] : {std::pair(Kind::Cyclic, 1), std::pair(Kind::Cyclic, 4), std::pair(Kind::Cyclic, 7),
                                   std::pair(Kind::Dihedral, 2), std::pair(Kind::Dihedral, 3),
                                   std::pair(Kind::Dihedral, 6), std::pair(Kind::Octahedral, 4)}) {
    const ObjectSymmetries group = groupOf(kind, fold);
    SCOPED_TRACE(group.name());
    const IsaacAxes axes = isaacAxes(group);
    EXPECT_TRUE(axes.is_complete);
    EXPECT_EQ(numIsaacRotations(axes.axes), group.discrete.size() + 1);
  }
  EXPECT_FALSE(isaacAxes(groupOf(Kind::Tetrahedral, 3)).is_complete);
  EXPECT_FALSE(isaacAxes(groupOf(Kind::Icosahedral, 5)).is_complete);
  EXPECT_FALSE(isaacAxes(ObjectSymmetries::from({turn({0.6, 0.8, 0.0}, kPi)}, {})).is_complete) << "a slanted axis";
  EXPECT_EQ(isaacAxes(ObjectSymmetries::from({}, {{kX, kCenter}})).axes, std::vector<std::string>{"x_full"});
  EXPECT_EQ(isaacAxes(ObjectSymmetries::from({}, {{kX, kCenter}, {kZ, kCenter}})).axes,
            (std::vector<std::string>{"x_full", "y_full", "z_full"}));
}

TEST(IsaacAxes, ComeBackAsTheyWereWritten) {
  const TemporaryFolder folder;
  const std::string path = folder.write("axes.yaml", "# two models\n" + isaacLine("\"2\"", {"z_90", "z_180", "z_-90"}) +
                                                         "  # C4\n7: ['x_full', y_180]\n");
  const auto models = readIsaacAxes(path);
  ASSERT_EQ(models.size(), 2u);
  EXPECT_EQ(ObjectSymmetries::from(models.at("2").discrete, models.at("2").continuous).name(), "C4");
  EXPECT_EQ(ObjectSymmetries::from(models.at("7").discrete, models.at("7").continuous).name(), "Dinf");
  const auto one = readIsaacAxes(
      folder.write("node.yaml", "/**:\n  ros__parameters:\n    symmetry_axes: [\"z_180\"]\n    max_hypothesis: 252\n"));
  ASSERT_EQ(one.count(""), 1u);
  EXPECT_EQ(one.at("").discrete.size(), 1u);
  EXPECT_THROW(readIsaacAxes(folder.write("bad.yaml", "symmetry_axes: [\"w_180\"]\n")), InputError);
  EXPECT_THROW(readIsaacAxes(folder.write("word.yaml", "symmetry_axes: [\"z_half\"]\n")), InputError);
  EXPECT_THROW(readIsaacAxes(folder.write("none.yaml", "a: 1\n")), InputError);
  EXPECT_THROW(readIsaacAxes(folder.write("blank.yaml", "symmetry_axes: [z 180]\n")), InputError);
}

/// A long line takes memory in proportion to it, and no more of the stack than a short one.
TEST(IsaacAxes, ReadsLinesOfAnyLength) {
  const TemporaryFolder folder;
  std::string list = "z_1";
  for (int i = 0; i < 100'000; ++i) list += ", z_1";
  EXPECT_EQ(readIsaacAxes(folder.write("long.yaml", "a: [" + list + "]\n")).at("a").discrete.size(), 100'001u);
  EXPECT_THROW(readIsaacAxes(folder.write("letters.yaml", std::string(1'000'000, 'a') + "\n")), InputError);
}

}  // namespace
