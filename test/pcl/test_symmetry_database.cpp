#include "pcl_symmetry/symmetry_database.h"

#include <gtest/gtest.h>
#include <pcl/common/io.h>

#include <Eigen/Geometry>
#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

#include "pcl/kinds.h"
#include "recognition/model_store.h"
#include "recognition/sqlite_connection.h"
#include "shapes/temporary_folder.h"

namespace pcl_symmetry {

namespace {

namespace fs = std::filesystem;
using namespace test;

Cloud modelOf(const Kind& kind) {
  return rodOnBox(kind.half, kind.rod, Eigen::Isometry3d::Identity(), 1);
}

const Eigen::Vector3f kViewpoint(-2.0f, 6.0f, 4.0f);

/// \return what a scanner sees of it elsewhere.
Cloud viewOf(const Kind& kind) {
  return seenFrom(rodOnBox(kind.half, kind.rod, elsewhere(), 2), kViewpoint);
}

class SymmetryDatabaseTest : public testing::Test {
protected:
  static void fill(SymmetryDatabase& database) {
    for (const Kind& kind : kKinds) database.add(kind.name, modelOf(kind));
  }

  /// A beam and a cube, seen from two sides: for what happens to the file.
  void fillQuickly() const {
    SymmetryDatabase database(file_, quick());
    for (const Kind& kind : {kKinds[0], kKinds[2]}) database.add(kind.name, modelOf(kind));
  }
  static DatabaseOptions withViews(int num_views) {
    DatabaseOptions options;
    options.num_views = num_views;
    options.num_references = 20;
    options.max_points = 2000;
    return options;
  }
  static DatabaseOptions quick() { return withViews(2); }
  /// \return a file with a model of each kind.
  std::string filled(const DatabaseOptions& options) const {
    const std::string file = folder_ / "few.db";
    SymmetryDatabase database(file, options);
    fill(database);
    return file;
  }
  static Cloud cube() { return modelOf(kKinds[0]); }

  const TemporaryFolder folder_;
  const std::string file_ = folder_ / "models.db";
};

TEST_F(SymmetryDatabaseTest, FindsShapesOfAnySizeInAnyPose) {
  SymmetryDatabase database(":memory:", quick());
  fill(database);
  EXPECT_EQ(database.names(), (std::vector<std::string>{"beam", "cube", "plate", "post"}));
  for (const Kind& kind : kKinds) {
    Cloud query = rodOnBox(kind.half, kind.rod, elsewhere(), 2);
    for (auto& point : query) point.getVector3fMap() *= 0.01f;
    const auto matches = database.match(query, 3);
    ASSERT_EQ(matches.size(), 3u) << kind.name;
    EXPECT_EQ(matches[0].name, kind.name);
    EXPECT_LT(matches[0].distance, 0.9 * matches[1].distance);
  }
  // Compact forms that are stored give what those give that each program makes for itself.
  const Cloud query = rodOnBox(kKinds[3].half, kKinds[3].rod, elsewhere(), 5);
  const auto before = database.match(query, 4);
  database.save();
  const auto after = database.match(query, 4);
  ASSERT_EQ(after.size(), 4u);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(after[i].name, before[i].name);
    EXPECT_NEAR(after[i].distance, before[i].distance, 1e-3);
  }
}

/// However the same models came there, in one order or another, again, or beside models that are gone.
TEST_F(SymmetryDatabaseTest, DistancesDependOnWhatIsStored) {
  const Cloud query = rodOnBox(kKinds[3].half, kKinds[3].rod, elsewhere(), 5);
  for (const int num_references : {2, 200}) {
    DatabaseOptions options = quick();
    options.num_references = num_references;
    const auto distances = [&](const std::vector<int>& order, const auto& afterTwo) {
      SymmetryDatabase database(":memory:", options);
      for (std::size_t i = 0; i < order.size(); ++i) {
        database.add(kKinds[order[i]].name, modelOf(kKinds[order[i]]));
        if (i == 1) afterTwo(database);
      }
      std::vector<std::pair<std::string, double>> found;
      for (const ModelMatch& match : database.match(query, 10)) found.emplace_back(match.name, match.distance);
      return found;
    };
    const auto expected = distances({0, 1, 2, 3}, [](SymmetryDatabase&) {});
    ASSERT_EQ(expected.size(), 4u);
    EXPECT_EQ(distances({3, 1, 0, 2, 2, 3}, [](SymmetryDatabase& database) { database.save(); }), expected);
    EXPECT_EQ(distances({1, 0, 3, 2},
                        [](SymmetryDatabase& database) {
                          database.add("another", ball());
                          database.save();
                          database.remove("another");
                        }),
              expected);
  }
}

TEST_F(SymmetryDatabaseTest, PreparedOnesRecognizeTheSame) {
  SymmetryDatabase database(":memory:", withViews(20)), prepared(":memory:", withViews(20));
  fill(database);
  prepared.prepare();  // nothing is there yet
  fill(prepared);
  prepared.prepare();
  const Cloud view = viewOf(kKinds[0]);
  const auto expected = database.recognize(view);
  const auto found = prepared.recognize(view);
  ASSERT_FALSE(expected.empty());
  ASSERT_EQ(found.size(), expected.size());
  EXPECT_EQ(found[0].name, expected[0].name);
  EXPECT_EQ(found[0].confidence, expected[0].confidence);
  EXPECT_EQ(found[0].T_model_scan.matrix(), expected[0].T_model_scan.matrix());
}

/// An object, and a wall that hides one side of it from a scanner.
struct HalfHidden {
  Cloud scene;
  pcl::Indices cluster;       // what is seen of the object
  std::size_t num_alone = 0;  // points that are seen without the wall

  HalfHidden(const Cloud& object, const Eigen::Vector3f& viewpoint) {
    num_alone = seenFrom(object, viewpoint).size();
    const Eigen::Vector3f middle = elsewhere().translation().cast<float>();
    const Eigen::Vector3f ahead = (middle - viewpoint).normalized();
    const Eigen::Vector3f right = ahead.cross(Eigen::Vector3f::UnitZ()).normalized(), up = right.cross(ahead);
    Cloud both = object;
    RandomStream random(3);
    for (int i = 0; i < 20'000; ++i) {
      both.push_back({});
      both.back().getVector3fMap() = viewpoint + 0.5f * (middle - viewpoint) +
                                     static_cast<float>(0.1 + 1.5 * random.uniform()) * right +
                                     static_cast<float>(3.0 * random.uniform() - 1.5) * up;
    }
    scene = seenFrom(both, viewpoint);
    for (std::size_t i = 0; i < scene.size(); ++i)
      if ((scene[i].getVector3fMap() - viewpoint).dot(ahead) > 0.6f * (middle - viewpoint).norm())
        cluster.push_back(static_cast<pcl::index_t>(i));
  }
};

TEST_F(SymmetryDatabaseTest, RecognizesViewsWithTheirPosesAndWhatIsHiddenInPart) {
  DatabaseOptions options = withViews(40);
  options.max_points = 5000;
  SymmetryDatabase database(":memory:", options);
  fill(database);
  Viewpoint given;
  given.mode = Viewpoint::Mode::Given;
  given.position = kViewpoint.cast<double>();
  for (const Kind& kind : kKinds) {
    const Recognition of_view = database.recognize(viewOf(kind));
    ASSERT_FALSE(of_view.empty()) << kind.name;
    EXPECT_EQ(of_view[0].name, kind.name);
    const Eigen::Isometry3d error = of_view[0].T_model_scan * elsewhere();
    EXPECT_LT(error.translation().norm(), 0.05) << kind.name;
    EXPECT_LT(angleOf(error.linear()), 0.05) << kind.name;

    const HalfHidden view(rodOnBox(kind.half, kind.rod, elsewhere(), 2), kViewpoint);
    EXPECT_LT(view.cluster.size(), 0.8 * static_cast<double>(view.num_alone)) << kind.name;
    const auto seen = std::make_shared<const SeenSpace>(view.scene, given);
    const Recognition found = database.recognize(view.scene, view.cluster, {}, seen);
    ASSERT_FALSE(found.empty()) << kind.name;
    EXPECT_EQ(found[0].name, kind.name);
    double sum = 0.0;
    for (const RecognizedModel& model : found) sum += model.confidence;
    EXPECT_LE(sum, 1.0 + 1e-9);
    EXPECT_GE(found[0].confidence, 0.5);
  }
  EXPECT_TRUE(database.recognize(seenFrom(ball(), {0.0f, 0.0f, 6.0f})).empty());
}

TEST_F(SymmetryDatabaseTest, AModelThatIsStoredTwiceIsAsCertainAsOnce) {
  SymmetryDatabase database(":memory:", withViews(20));
  fill(database);
  // Another one of its kind fits, but not well.
  const Cloud view = seenFrom(rodOnBox(1.02 * kKinds[0].half, kKinds[0].rod, elsewhere(), 2), kViewpoint);
  RecognitionOptions options;
  options.min_confidence = 0.25;
  const Recognition once = database.recognize(view, options);
  ASSERT_EQ(once.size(), 1u);
  EXPECT_EQ(once[0].name, "cube");
  database.add("cube again", rodOnBox(kKinds[0].half, kKinds[0].rod, Eigen::Isometry3d::Identity(), 9));
  const Recognition twice = database.recognize(view, options);
  ASSERT_EQ(twice.size(), 2u);
  for (const RecognizedModel& model : twice) {
    EXPECT_EQ(model.name.substr(0, 4), "cube");
    EXPECT_NEAR(model.confidence, once[0].confidence, 0.1) << model.name;
    EXPECT_LT(model.score.merit(), 0.97) << "it does not fit as its own kind does";
  }
}

TEST_F(SymmetryDatabaseTest, ModelsOfAnotherSizeHaveNoPairsInCommon) {
  SymmetryDatabase database(":memory:", quick());
  database.add("cube", cube());
  for (const double scale : {1e-4, 1e4}) {
    Cloud scaled = cube();
    for (auto& point : scaled) point.getVector3fMap() *= static_cast<float>(scale);
    database.add("cube" + std::to_string(scale), scaled);
  }
  const Cloud view = viewOf(kKinds[0]);
  const Recognition found = database.recognize(view);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].name, "cube");
}

/// Stores a model \p count times, under its name and a number.
/// \param views of which it has the looks.
void addCopies(detail::ModelStore& source, const detail::StoredModel& model, const detail::StoredModel& views,
               int count, detail::ModelStore& target) {
  const detail::PackedModel packed{
      source.part(detail::ModelPart::Cloud, model), source.part(detail::ModelPart::Signatures, model),
      source.part(detail::ModelPart::Views, views), source.part(detail::ModelPart::Surfaces, model), 5000};
  for (int i = 0; i < count; ++i) target.add({model.name + std::to_string(i), 0, {}, packed.num_points}, packed, 0, {});
}

TEST_F(SymmetryDatabaseTest, RecognizesByCodesWhereThereAreMoreModelsThanAreCompared) {
  const DatabaseOptions options = withViews(8);
  {
    detail::ModelStore source(filled(options), 10.0, ""), target(file_, 10.0, "");
    // So many that pairs of points are not searched.
    for (const detail::StoredModel& model : source.models()) addCopies(source, model, model, 76, target);
  }
  RecognitionOptions recognition;
  recognition.num_candidates = 2;
  recognition.num_refined = 1;
  const Cloud view = viewOf(kKinds[1]);
  const auto nameIn = [&](const SymmetryDatabase& database) {
    const Recognition found = database.recognize(view, recognition);
    return found.empty() ? "" : found[0].name;
  };
  SymmetryDatabase database(file_, options);
  ASSERT_EQ(database.size(), 304u);
  const std::string made = nameIn(database);
  EXPECT_EQ(made.substr(0, 5), "plate") << "its codes are made";
  database.save();
  EXPECT_EQ(nameIn(database), made) << "its codes are stored";
  database.add("another", cube());
  EXPECT_EQ(nameIn(SymmetryDatabase(file_, options)), made) << "codes of a new model are stored with it";
  EXPECT_TRUE(SymmetryDatabase::check(file_).empty());
}

TEST_F(SymmetryDatabaseTest, TriesMoreModelsWhereNoneOfTheFirstIsAccepted) {
  const DatabaseOptions options = withViews(8);
  {
    detail::ModelStore source(filled(options), 10.0, ""), target(file_, 10.0, "");
    const auto models = source.models();                  // beam, cube, plate, post
    addCopies(source, models[1], models[2], 30, target);  // cubes that look like the plate
    addCopies(source, models[2], models[2], 1, target);
    addCopies(source, models[0], models[0], 280, target);  // so many that pairs of points are not searched
  }
  const SymmetryDatabase database(file_, options);
  const Cloud view = viewOf(kKinds[1]);
  RecognitionOptions recognition;
  recognition.num_candidates = 2;
  recognition.max_candidates = 2;
  EXPECT_TRUE(database.recognize(view, recognition).empty());
  recognition.max_candidates = 70;
  const Recognition found = database.recognize(view, recognition);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found[0].name, "plate0");
}

TEST_F(SymmetryDatabaseTest, ChangesAreStoredAtOnce) {
  fillQuickly();
  SymmetryDatabase database(file_, quick());
  const SymmetryDatabase reader(file_, quick());
  EXPECT_EQ(reader.size(), 2u);
  database.save();
  database.remove("cube");
  const Cloud rod = rodOnBox({0.1, 0.1, 2.0}, 0.5, Eigen::Isometry3d::Identity(), 3);
  database.add("rod", rod, {"shop/rod.ply", "17", {"long", "thin things"}});
  database.add("beam", rodOnBox(kKinds[2].half, 1.0, Eigen::Isometry3d::Identity(), 3));
  EXPECT_TRUE(reader.contains("cube")) << "it keeps its state";
  EXPECT_EQ(reader.cloud("cube").size(), 2000u);
  SymmetryDatabase other(file_, quick());
  EXPECT_EQ(other.names(), (std::vector<std::string>{"beam", "rod"}));
  EXPECT_EQ(other.match(rodOnBox({0.1, 0.1, 2.0}, 0.5, elsewhere(), 4), 1).at(0).name, "rod");
  const ModelInfo info = other.info("rod");
  EXPECT_EQ(info.num_points, 2000u);
  EXPECT_EQ(info.source.path, "shop/rod.ply");
  EXPECT_EQ(info.source.checksum, "17");
  EXPECT_EQ(info.source.tags, (std::vector<std::string>{"long", "thin things"}));
  database.remove("rod");
  EXPECT_EQ(other.size(), 2u);
  other.refresh();
  EXPECT_EQ(other.names(), std::vector<std::string>{"beam"});
  EXPECT_EQ(other.match(rod, 5).size(), 1u);
}

TEST_F(SymmetryDatabaseTest, BuildsReportFailuresAndGoOnWhereTheyStopped) {
  std::vector<ModelInput> inputs;
  std::atomic<int> num_loaded{0};
  for (const Kind& kind : kKinds)
    inputs.push_back({kind.name,
                      [] {
                        return ModelSource{"here", "checksum of today", {}};
                      },
                      [&] {
                        ++num_loaded;
                        return modelOf(kind);
                      }});
  inputs.push_back({"cube", {}, [] { return ball(); }});
  inputs.push_back({"broken", {}, []() -> Cloud { throw std::runtime_error("cannot be read today"); }});
  inputs.push_back({"flat", {}, [] { return Cloud(10, 1, pcl::PointXYZ(1.0f, 1.0f, 1.0f)); }});
  {
    SymmetryDatabase database(file_, quick());
    EXPECT_TRUE(database.build(inputs, [](double) { return false; }).cancelled);
    EXPECT_GE(database.size(), 1u);
    EXPECT_LT(database.size(), 4u);
  }
  SymmetryDatabase database(file_, quick());
  const std::size_t before = database.size();
  const BuildReport report = database.build(inputs);
  EXPECT_EQ(num_loaded, 4) << "each model once";
  EXPECT_EQ(report.num_kept, before);
  EXPECT_EQ(report.num_added, 4 - before);
  ASSERT_EQ(report.failures.size(), 3u);
  EXPECT_EQ(report.failures[0].first, "cube");
  EXPECT_EQ(report.failures[1].second, "cannot be read today");
  EXPECT_EQ(report.failures[2].first, "flat");
  EXPECT_EQ(database.names(), (std::vector<std::string>{"beam", "cube", "plate", "post"}));
}

TEST_F(SymmetryDatabaseTest, MergesOtherDatabasesWholeOrNotAtAll) {
  fillQuickly();
  const std::string damaged = folder_ / "damaged.db", same = folder_ / "same.db", merged = folder_ / "merged.db";
  {
    SymmetryDatabase part(damaged, quick());
    part.add("first", cube());
    part.add("second", modelOf(kKinds[3]));
    SymmetryDatabase(same, quick()).add("post", cube());
  }
  detail::SQLiteConnection(damaged, detail::SQLiteAccess::Change, 1.0)
      .run("UPDATE views SET data = zeroblob(100) WHERE model = 2");
  SymmetryDatabase database(merged, quick());
  const auto complaint = [&](const std::vector<std::string>& files) {
    return test::complaintOf<pcl::IOException>([&] { database.merge(files); });
  };
  EXPECT_EQ(complaint({file_, damaged}), damaged + ": the views of model 'second' are damaged");
  EXPECT_FALSE(fs::exists(merged)) << "no file is left of a merge that failed";
  EXPECT_EQ(folder_.names().size(), 3u) << "nor another one";
  EXPECT_EQ(database.merge({file_}, [](double) { return false; }), 0u);
  EXPECT_EQ(database.size(), 0u);
  database.add("post", modelOf(kKinds[3]));
  EXPECT_EQ(complaint({file_, damaged}), damaged + ": the views of model 'second' are damaged");
  EXPECT_EQ(complaint({file_, same}), same + ": model 'post' is also in " + merged + ", names must differ");
  EXPECT_EQ(complaint({merged}), merged + ": is the database that others are merged into");
  EXPECT_EQ(complaint({folder_ / "x"}), (folder_ / "x") + ": there is no such file");
  EXPECT_EQ(database.names(), std::vector<std::string>{"post"}) << "all or nothing";
  EXPECT_EQ(database.merge({file_}), 2u);
  EXPECT_EQ(database.match(cube(), 5).size(), 3u);
  EXPECT_TRUE(SymmetryDatabase::check(merged).empty());
  EXPECT_EQ(test::complaintOf<pcl::IOException>([&] { SymmetryDatabase{folder_ / "."}; }),
            (folder_ / ".") + ": is a folder, must be a file");
}

TEST_F(SymmetryDatabaseTest, TakesAllPointTypes) {
  SymmetryDatabase database(":memory:", quick());
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud;
  pcl::copyPointCloud(cube(), cloud);
  database.add("cube", cloud);
  EXPECT_EQ(database.match(cloud, 1).at(0).name, "cube");
  EXPECT_FALSE(database.recognize(cloud).empty());
}

TEST_F(SymmetryDatabaseTest, CloudsWithoutAnswerExcuseNoViewpoint) {
  const SymmetryDatabase database(file_);
  Cloud few;
  for (const float x : {-1.0f, 1.0f}) few.push_back({x, x * x, 0.0f});
  const Viewpoint nowhere{Viewpoint::Mode::Given, Eigen::Vector3d::Constant(std::nan(""))};
  const Viewpoint among{Viewpoint::Mode::Given, Eigen::Vector3d(0.0, 1.0, 0.0)};
  for (const auto& [cloud, viewpoint] : {std::pair{Cloud(), nowhere}, std::pair{few, nowhere}, std::pair{few, among}}) {
    EXPECT_NE(test::messageOf([&, c = cloud, v = viewpoint] { database.match(c, 3, v); }).find("viewpoint"),
              std::string::npos);
    EXPECT_NE(test::messageOf([&, c = cloud, v = viewpoint] { database.recognize(c, {}, v); }).find("viewpoint"),
              std::string::npos);
  }
}

TEST_F(SymmetryDatabaseTest, EmptyOnesFindNothing) {
  SymmetryDatabase database(file_, quick());
  EXPECT_TRUE(database.match(cube()).empty());
  EXPECT_TRUE(database.recognize(cube()).empty());
  testing::internal::CaptureStderr();
  EXPECT_TRUE(database.match(Cloud()).empty());
  EXPECT_NE(testing::internal::GetCapturedStderr().find("[pcl_symmetry::SymmetryDatabase] input cloud: "),
            std::string::npos);
  database.save();
  EXPECT_FALSE(fs::exists(file_)) << "nothing was added";
  database.add("only", cube());
  database.remove("only");
  EXPECT_TRUE(database.match(cube()).empty());
  EXPECT_EQ(SymmetryDatabase(file_).size(), 0u);
}

TEST_F(SymmetryDatabaseTest, NamesAreAnyTextButPaths) {
  SymmetryDatabase database(file_, quick());
  database.add("first", cube());
  const std::string good[] = {"O'Neill; DROP TABLE models",
                              "Gr\xc3\xbc\xc3\x9f"
                              "e aus \xe6\x9d\xb1\xe4\xba\xac",
                              "a \"b\" %s \\", std::string(200, 'x')};
  for (const std::string& name : good) {
    database.add(name, cube());
    EXPECT_EQ(SymmetryDatabase(file_).info(name).name, name);
  }
  const std::string bad[] = {"",         "../evil",   "a/b",
                             ".hidden",  "new\nline", std::string("nul\0", 4),
                             "\xff\xfe", "\xc3",      std::string(10'000, 'x')};
  for (const std::string& name : bad) {
    const std::string message = test::messageOf([&] { database.add(name, cube()); });
    EXPECT_NE(message.find("must be 1 to 200 bytes of UTF-8 without '/' and control characters, not '.' first"),
              std::string::npos);
    EXPECT_LT(message.size(), 250u);
    EXPECT_FALSE(database.contains(name));
  }
  EXPECT_EQ(database.size(), 5u);
  EXPECT_TRUE(SymmetryDatabase::check(file_).empty());
}

TEST_F(SymmetryDatabaseTest, SaysWhatIsWrong) {
  SymmetryDatabase database(file_);
  EXPECT_THROW(database.add("flat", Cloud(10, 1, pcl::PointXYZ(1.0f, 1.0f, 1.0f))), pcl::BadArgumentException);
  EXPECT_EQ(test::messageOf([&] { database.remove("nobody"); }), "name = 'nobody', must be that of a model");
  EXPECT_THROW(database.cloud("nobody"), pcl::BadArgumentException);
  RecognitionOptions options;
  options.num_candidates = 0;
  EXPECT_EQ(test::messageOf([&] { database.recognize(cube(), options); }), "num_candidates = 0, must be >= 1");
  options.num_candidates = 1;
  options.max_candidates = 0;
  EXPECT_EQ(test::messageOf([&] { database.recognize(cube(), options); }), "max_candidates = 0, must be >= 1");
  options = {};
  options.min_confidence = 1.5;
  EXPECT_EQ(test::messageOf([&] { database.recognize(cube(), options); }), "min_confidence = 1.5, must be in [0, 1]");
  EXPECT_EQ(test::messageOf([&] { database.match(cube(), 0); }), "num_nearest = 0, must be >= 1");
  EXPECT_EQ(test::complaintOf<pcl::IOException>([&] { SymmetryDatabase::check(file_); }),
            file_ + ": there is no such file");
}

}  // namespace

}  // namespace pcl_symmetry
