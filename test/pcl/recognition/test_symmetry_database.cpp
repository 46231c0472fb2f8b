#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/base/random.h"
#include "pcl/support/error_message.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace pcl_symmetry {

namespace {

namespace fs = std::filesystem;
using Cloud = SymmetryDatabase::Cloud;

/// A box with a rod on top.
Cloud rodOnBox(const Eigen::Vector3d& half, double rod, const Eigen::Isometry3d& pose, std::uint64_t seed) {
  Cloud cloud;
  RandomStream random(seed);
  const auto side = [&] { return 2.0 * random.uniform() - 1.0; };
  for (int i = 0; i < 5000; ++i) {
    Eigen::Vector3d x(side(), side(), side());
    if (i % 5 == 0) {
      const double angle = M_PI * side();
      x = Eigen::Vector3d(0.1 * std::cos(angle) + 0.5 * half.x(), 0.1 * std::sin(angle),
                          half.z() + rod * random.uniform());
    } else {
      const int axis = i % 3;
      x[axis] = x[axis] < 0.0 ? -1.0 : 1.0;
      x = x.cwiseProduct(half);
    }
    cloud.push_back({});
    cloud.back().getVector3fMap() = (pose * x).cast<float>();
  }
  return cloud;
}

Cloud ball() {
  Cloud cloud;
  RandomStream random(9);
  while (cloud.size() < 5000) {
    const Eigen::Vector3d x = Eigen::Vector3d::NullaryExpr([&] { return 2.0 * random.uniform() - 1.0; });
    if (x.norm() > 1.0 || x.norm() < 0.1) continue;
    cloud.push_back({});
    cloud.back().getVector3fMap() = x.normalized().cast<float>();
  }
  return cloud;
}

/// The points that a scanner there sees.
Cloud seenFrom(const Cloud& whole, const Eigen::Vector3f& viewpoint) {
  const Points points = whole.getMatrixXfMap(3, 4, 0);
  const auto seen = Visibility::fromPoints(points, viewpoint.cast<double>());
  Cloud cloud;
  for (const pcl::PointXYZ& point : whole)
    if (seen->depthBehind(point.getVector3fMap().cast<double>()) < 0.1) cloud.push_back(point);
  cloud.sensor_origin_ << viewpoint, 1.0f;
  return cloud;
}

struct Kind {
  const char* name;
  Eigen::Vector3d half;
  double rod;
};
const Kind kKinds[] = {{"cube", {1.0, 0.95, 0.9}, 0.5},
                       {"plate", {1.0, 0.8, 0.1}, 0.6},
                       {"beam", {1.5, 0.2, 0.3}, 0.3},
                       {"post", {0.3, 0.3, 0.6}, 2.0}};

/// Points drawn at random lie less evenly, and meet less well, than those of scanners and of samples of meshes.
RecognitionOptions optionsForRandomPoints() {
  RecognitionOptions options;
  options.min_merit = 0.5;
  return options;
}

const Eigen::Isometry3d kHere = Eigen::Isometry3d::Identity();

Eigen::Isometry3d elsewhere() {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.3, -1.0, 0.8).normalized()).toRotationMatrix();
  pose.translation() << 4.0, -2.0, 1.0;
  return pose;
}

class SymmetryDatabaseTest : public testing::Test {
protected:
  void SetUp() override { fs::remove_all(folder_); }
  void TearDown() override { fs::remove_all(folder_); }

  void fill() {
    SymmetryDatabase database(folder_);
    for (const Kind& kind : kKinds) database.add(kind.name, rodOnBox(kind.half, kind.rod, kHere, 1));
    database.save();
  }

  /// A beam and a cube, seen from two sides: for what happens to files.
  void fillQuickly() {
    SymmetryDatabase database(folder_, quick());
    for (const Kind& kind : {kKinds[0], kKinds[2]}) database.add(kind.name, rodOnBox(kind.half, kind.rod, kHere, 1));
    database.save();
  }
  static DatabaseOptions quick() {
    DatabaseOptions options;
    options.num_views = 2;
    return options;
  }

  std::set<std::string> files() const {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_)) names.insert(entry.path().filename().string());
    return names;
  }

  const std::string folder_ =
      testing::TempDir() + "symmetry_database_" + testing::UnitTest::GetInstance()->current_test_info()->name();
};

}  // namespace

TEST_F(SymmetryDatabaseTest, FindsShapesOfAnySizeInAnyPose) {
  fill();
  const SymmetryDatabase database(folder_);
  EXPECT_EQ(database.names(), (std::vector<std::string>{"beam", "cube", "plate", "post"}));
  for (const Kind& kind : kKinds) {
    Eigen::Isometry3d pose = elsewhere();
    Cloud query = rodOnBox(kind.half, kind.rod, pose, 2);
    for (auto& point : query) point.getVector3fMap() *= 0.01f;
    const auto matches = database.match(query, 3);
    ASSERT_EQ(matches.size(), 3u) << kind.name;
    EXPECT_EQ(matches[0].name, kind.name);
    EXPECT_LT(matches[0].distance, 0.9 * matches[1].distance);
  }
}

TEST_F(SymmetryDatabaseTest, RecognizesWithPoseAndKnowsWhatItDoesNotKnow) {
  fill();
  SymmetryDatabase database(folder_);
  const auto found =
      database.recognize(rodOnBox(kKinds[1].half, kKinds[1].rod, elsewhere(), 2), optionsForRandomPoints());
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].name, "plate");
  EXPECT_GT(found[0].confidence, 0.25);
  EXPECT_LE(found[0].confidence, 1.0);
  const Eigen::Isometry3d error = found[0].T_model_scan * elsewhere();
  EXPECT_LT(error.translation().norm(), 0.05);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.05);
  EXPECT_TRUE(database.recognize(ball(), optionsForRandomPoints()).empty());
}

TEST_F(SymmetryDatabaseTest, RecognizesAViewWithItsPose) {
  fill();
  SymmetryDatabase database(folder_);
  for (const Kind& kind : kKinds) {
    const Cloud view = seenFrom(rodOnBox(kind.half, kind.rod, elsewhere(), 2), {-2.0f, 6.0f, 4.0f});
    const auto found = database.recognize(view, optionsForRandomPoints());
    ASSERT_FALSE(found.empty()) << kind.name;
    EXPECT_EQ(found[0].name, kind.name);
    const Eigen::Isometry3d error = found[0].T_model_scan * elsewhere();
    EXPECT_LT(error.translation().norm(), 0.05) << kind.name;
    EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.05) << kind.name;
  }
  EXPECT_TRUE(database.recognize(seenFrom(ball(), {0.0f, 0.0f, 6.0f}), optionsForRandomPoints()).empty());
}

TEST_F(SymmetryDatabaseTest, ChangesAreStored) {
  fill();
  SymmetryDatabase database(folder_);
  database.remove("cube");
  database.add("rod", rodOnBox({0.1, 0.1, 2.0}, 0.5, kHere, 3));
  database.add("beam", rodOnBox(kKinds[2].half, 1.0, kHere, 3));
  EXPECT_EQ(SymmetryDatabase(folder_).names().size(), 4u);
  EXPECT_TRUE(SymmetryDatabase(folder_).contains("cube"));
  database.save();
  const SymmetryDatabase stored(folder_);
  EXPECT_EQ(stored.names(), (std::vector<std::string>{"beam", "plate", "post", "rod"}));
  EXPECT_EQ(stored.match(rodOnBox({0.1, 0.1, 2.0}, 0.5, elsewhere(), 4), 1).at(0).name, "rod");
  EXPECT_EQ(stored.cloud("rod").size(), 5000u);
  // The manifest, a cloud, signature and views of each model, and two files for all; nothing else is left.
  EXPECT_EQ(files().size(), 1u + 3u * 4u + 2u);
  const auto before = database.match(rodOnBox(kKinds[3].half, kKinds[3].rod, elsewhere(), 5), 4);
  database.rebuild();
  EXPECT_EQ(database.match(rodOnBox(kKinds[3].half, kKinds[3].rod, elsewhere(), 5), 4)[0].name, before[0].name);
}

TEST_F(SymmetryDatabaseTest, KeepsCloudsAsPCDFiles) {
  fillQuickly();
  Cloud loaded;
  ASSERT_EQ(pcl::io::loadPCDFile((fs::path(folder_) / "1_beam.pcd").string(), loaded), 0);
  EXPECT_EQ(loaded.size(), 5000u);
}

TEST_F(SymmetryDatabaseTest, AnInterruptedChangeLeavesTheOldStateWhole) {
  fillQuickly();
  // A save that ends before the manifest is renamed leaves the new manifest and some of the files that it names.
  std::ofstream(fs::path(folder_) / "manifest.txt.new") << "pcl_symmetry database 2\n79 2 78_all 2\n"
                                                           "beam 1_beam\nnew 77_new\n";
  std::ofstream(fs::path(folder_) / "77_new.pcd") << "half a clou";
  std::ofstream(fs::path(folder_) / "78_all.compact") << "half";
  SymmetryDatabase database(folder_, quick());
  EXPECT_EQ(database.size(), 2u);
  EXPECT_EQ(database.match(rodOnBox(kKinds[0].half, kKinds[0].rod, elsewhere(), 2), 1).at(0).name, "cube");
  database.remove("cube");
  database.save();
  EXPECT_EQ(SymmetryDatabase(folder_).size(), 1u);
  // The manifest, three files of the model, and two files for all; nothing is left of the interrupted save.
  EXPECT_EQ(files().size(), 1u + 3u + 2u);
  EXPECT_EQ(files().count("1_beam.pcd"), 1u);
  EXPECT_EQ(files().count("77_new.pcd"), 0u);
}

TEST_F(SymmetryDatabaseTest, NeverTouchesFilesOfTheUser) {
  fillQuickly();
  // Names with the extensions of a database, also names that the next save would use, or that look like its own.
  const std::vector<std::string> mine = {"mine.pcd",      "notes.views",    "a.signature",
                                         "b.compact",     "c.projection",   "4_new.pcd",
                                         "6_all.compact", "77_holiday.pcd", "78_all.projection"};
  for (const std::string& name : mine) std::ofstream(fs::path(folder_) / name) << "mine";
  // A new manifest that was being written when the program ended does not count: no file was written after it.
  std::ofstream(fs::path(folder_) / "manifest.txt.new") << "pcl_symmetry database 2\n79 2 78_all 1\nholiday 77_holiday";
  SymmetryDatabase database(folder_, quick());
  database.remove("cube");
  database.add("new", rodOnBox({0.1, 0.1, 2.0}, 0.5, kHere, 3));
  database.save();
  database.remove("new");
  database.save();
  EXPECT_EQ(SymmetryDatabase(folder_).size(), 1u);
  EXPECT_EQ(files().size(), 1u + 3u + 2u + mine.size());
  for (const std::string& name : mine) {
    std::string content;
    std::ifstream(fs::path(folder_) / name) >> content;
    EXPECT_EQ(content, "mine") << name;
  }
}

TEST_F(SymmetryDatabaseTest, ManifestsNameNoFilesElsewhere) {
  fs::create_directories(folder_);
  const auto reasonFor = [&](const std::string& file) -> std::string {
    std::ofstream(fs::path(folder_) / "manifest.txt") << "pcl_symmetry database 2\n6 1 5_all 1\nbeam " << file << '\n';
    try {
      SymmetryDatabase{folder_};
    } catch (const pcl::IOException& error) {
      return error.what();
    }
    return "no exception";
  };
  EXPECT_NE(reasonFor("1_beam").find("5_all.projection"), std::string::npos) << "the first file that is missing";
  for (const char* file : {"../1_beam", "beam", "1_../beam", "/1_beam", "x_beam"})
    EXPECT_NE(reasonFor(file).find("must be a name and a file NUMBER_NAME"), std::string::npos) << file;
}

TEST_F(SymmetryDatabaseTest, ModelsThatWereRemovedAreNotFound) {
  fillQuickly();
  SymmetryDatabase database(folder_, quick());
  const Cloud cube = rodOnBox(kKinds[0].half, kKinds[0].rod, elsewhere(), 2);
  ASSERT_EQ(database.match(cube, 2).size(), 2u);
  database.remove("cube");
  for (const ModelMatch& match : database.match(cube, 2)) EXPECT_NE(match.name, "cube");
  for (const RecognizedModel& model : database.recognize(cube, optionsForRandomPoints())) EXPECT_NE(model.name, "cube");
}

TEST_F(SymmetryDatabaseTest, CanBeMoved) {
  SymmetryDatabase database(folder_);
  database.add("cube", rodOnBox(kKinds[0].half, kKinds[0].rod, kHere, 1));
  SymmetryDatabase moved = std::move(database);
  EXPECT_TRUE(moved.contains("cube"));
  database = std::move(moved);
  EXPECT_EQ(database.cloud("cube").size(), 5000u);
}

TEST_F(SymmetryDatabaseTest, CloudsWithoutAnswerFindNothing) {
  SymmetryDatabase database(folder_);
  const Cloud same(100, 1, pcl::PointXYZ(1.0f, 1.0f, 1.0f));
  Viewpoint given;
  given.mode = Viewpoint::Mode::Given;
  for (const Cloud& cloud : {Cloud(), same}) {
    testing::internal::CaptureStderr();
    EXPECT_TRUE(database.match(cloud, 3, given).empty());
    EXPECT_TRUE(database.recognize(cloud, {}, given).empty());
    EXPECT_NE(testing::internal::GetCapturedStderr().find("[pcl_symmetry::SymmetryDatabase] input cloud: "),
              std::string::npos);
  }
}

TEST_F(SymmetryDatabaseTest, EmptyOnesFindNothing) {
  SymmetryDatabase database(folder_);
  EXPECT_TRUE(database.match(rodOnBox(kKinds[0].half, 0.5, kHere, 1)).empty());
  EXPECT_TRUE(database.recognize(rodOnBox(kKinds[0].half, 0.5, kHere, 1)).empty());
  database.add("only", rodOnBox(kKinds[0].half, 0.5, kHere, 1));
  database.save();
  database.remove("only");
  database.save();
  EXPECT_EQ(SymmetryDatabase(folder_).size(), 0u);
}

TEST_F(SymmetryDatabaseTest, SaysWhatIsWrong) {
  SymmetryDatabase database(folder_);
  const Cloud cloud = rodOnBox(kKinds[0].half, 0.5, kHere, 1);
  EXPECT_EQ(test::messageOf([&] { database.add("../evil", cloud); }),
            "name = '../evil', must be 1 to 100 letters, digits, '_', '-' or '.', not '.' first");
  EXPECT_THROW(database.add("", cloud), pcl::BadArgumentException);
  EXPECT_THROW(database.add("flat", Cloud(10, 1, pcl::PointXYZ(1.0f, 1.0f, 1.0f))), pcl::BadArgumentException);
  EXPECT_THROW(database.remove("nobody"), pcl::BadArgumentException);
  EXPECT_THROW(database.cloud("nobody"), pcl::BadArgumentException);
  RecognitionOptions options;
  options.num_candidates = 0;
  EXPECT_EQ(test::messageOf([&] { database.recognize(cloud, options); }), "num_candidates = 0, must be >= 1");
  EXPECT_EQ(test::messageOf([&] { database.match(cloud, -1); }), "num_nearest = -1, must be >= 0");
  fs::create_directories(folder_);
  std::ofstream(fs::path(folder_) / "holiday.jpg") << "x";
  EXPECT_THROW(SymmetryDatabase{folder_}, pcl::IOException);
  std::ofstream(fs::path(folder_) / "manifest.txt") << "something else\n";
  try {
    SymmetryDatabase{folder_};
    ADD_FAILURE() << "no exception";
  } catch (const pcl::IOException& error) {
    EXPECT_EQ(std::string(error.what()),
              (fs::path(folder_) / "manifest.txt").string() + ": must begin with 'pcl_symmetry database 2'");
  }
}

}  // namespace pcl_symmetry
