/// Files of symmetries mean what those who read them make of them.
#include "bop/models_info.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <nlohmann/json.hpp>

#include "core/base/constants.h"
#include "shapes/complaint.h"
#include "shapes/temporary_folder.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

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
