#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>
#include <string>

#include "apps/support/lathe_mesh.h"
#include "apps/support/temporary_folder.h"
#include "apps/support/tool_run.h"
#include "evaluate/retrieval/retrieval_statistics.h"
#include "evaluate/shared/class_file.h"

namespace {

using namespace pcl_symmetry::apps;
using nlohmann::json;

/// Models on a line.
Eigen::MatrixXf distancesOf(const std::vector<float>& places) {
  Eigen::MatrixXf distances(places.size(), places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t j = 0; j < places.size(); ++j)
      distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = std::abs(places[i] - places[j]);
  return distances;
}

TEST(RetrievalStatistics, ArePerfectWhereClassesAreApart) {
  const auto s = retrievalStatistics(distancesOf({0.0f, 0.1f, 0.2f, 5.0f, 5.1f}), {"a", "a", "a", "b", "b"});
  EXPECT_EQ(s.num_queries, 5);
  EXPECT_DOUBLE_EQ(s.nearest, 1.0);
  EXPECT_DOUBLE_EQ(s.first_tier, 1.0);
  EXPECT_DOUBLE_EQ(s.second_tier, 1.0);
  EXPECT_DOUBLE_EQ(s.dcg, 1.0);
  for (const double precision : s.precision) EXPECT_DOUBLE_EQ(precision, 1.0);
  // All others are among the first 32: the precision is k of 32.
  EXPECT_DOUBLE_EQ(s.e_measure, (3 * 2.0 * 2 / (32 + 2) + 2 * 2.0 * 1 / (32 + 1)) / 5);
}

TEST(RetrievalStatistics, CountAsTheBenchmarkDoes) {
  // The answers to the first model, of class a: b, a, b, a.
  const auto s = statisticsByClass(distancesOf({0.0f, 1.0f, 2.0f, 3.0f, 4.0f}), {"a", "b", "a", "c", "a"});
  ASSERT_EQ(s.count("a"), 1u);
  EXPECT_EQ(s.count("b"), 0u) << "alone in its class";
  // Ranks of the class: of the first model 2 and 4; of the middle one 3 and 4 (ties by index: b, c behind it at 1, then
  // both ends); of the last one 2 and 4.
  EXPECT_DOUBLE_EQ(s.at("a").nearest, 0.0);
  EXPECT_DOUBLE_EQ(s.at("a").first_tier, (0.5 + 0.0 + 0.5) / 3);
  EXPECT_DOUBLE_EQ(s.at("a").second_tier, 1.0);
  const double best = 1.0 + 1.0;  // ranks 1 and 2
  const double ends = (1.0 / std::log2(2.0) + 1.0 / std::log2(4.0)) / best;
  const double middle = (1.0 / std::log2(3.0) + 1.0 / std::log2(4.0)) / best;
  EXPECT_NEAR(s.at("a").dcg, (2 * ends + middle) / 3, 1e-12);
  // At recall 0.5 the first answer of the class counts, at 1 the second.
  EXPECT_NEAR(s.at("a").precision[9], (0.5 + 1.0 / 3 + 0.5) / 3, 1e-12);
  EXPECT_NEAR(s.at("a").precision[19], 0.5, 1e-12);
}

TEST(RetrievalStatistics, QueriesAloneAddUpToTheMeans) {
  const Eigen::MatrixXf distances = distancesOf({0.0f, 0.4f, 0.5f, 2.0f, 2.1f, 9.0f});
  const std::vector<std::string> classes{"a", "b", "a", "a", "b", "alone"};
  const QueryScores scores = queryScores(distances, classes);
  const RetrievalStatistics all = retrievalStatistics(distances, classes);
  ASSERT_EQ(scores.classes, (std::vector<std::string>{"a", "b", "a", "a", "b"}));
  EXPECT_NEAR(std::accumulate(scores.nearest.begin(), scores.nearest.end(), 0.0) / 5.0, all.nearest, 1e-12);
  EXPECT_NEAR(std::accumulate(scores.dcg.begin(), scores.dcg.end(), 0.0) / 5.0, all.dcg, 1e-12);
  for (std::size_t r = 0; r < kNumRecalls; ++r)
    EXPECT_NEAR(std::accumulate(scores.precision[r].begin(), scores.precision[r].end(), 0.0) / 5.0, all.precision[r],
                1e-12);
}

TEST(RetrievalStatistics, GainsAreOfTheSameQueries) {
  std::vector<double> with, without;
  std::vector<std::string> classes;
  for (int i = 0; i < 400; ++i) {
    // Classes of ten queries differ much, the two methods by 0.1 in every other class.
    const int of = i / 10;
    without.push_back(of / 40.0);
    with.push_back(without.back() + (of % 2 == 0 ? 0.1 : 0.0));
    classes.push_back("class " + std::to_string(of));
  }
  const Gain gain = pairedGain(with, without, classes);
  EXPECT_NEAR(gain.mean, 0.05, 1e-12);
  // Of 40 classes: 0.05 / sqrt(40) is the standard error.
  EXPECT_NEAR(gain.high - gain.low, 2.0 * 1.96 * 0.05 / std::sqrt(40.0), 0.006);
  EXPECT_LT(gain.low, gain.mean);
  EXPECT_EQ(pairedGain(with, with, classes).high, 0.0);
  EXPECT_EQ(pairedGain({}, {}, {}).mean, 0.0);
}

TEST(ClassFile, NamesClassesBehindTheirParents) {
  const TemporaryFolder folder;
  const std::string path = folder.write("c.cla", "PSB 1\n2 2\n\nvessel 0 0\n\nvase vessel 2\n7\n9\n");
  const auto classes = readClassFile(path);
  EXPECT_EQ(classes.at("m7"), "vessel/vase");
  EXPECT_EQ(classes.at("m9"), "vessel/vase");
}

/// Each class is the parent of the next one: their full names would take the square of the size of the file.
TEST(ClassFile, RefusesEndlessFamilies) {
  const TemporaryFolder folder;
  std::string text = "PSB 1\n3000 0\n";
  for (int i = 0; i < 3000; ++i) text += "c" + std::to_string(i) + " c" + std::to_string(i - 1) + " 0\n";
  EXPECT_THROW(readClassFile(folder.write("deep.cla", text)), InputError);
}

/// The tool on three vases and three boxes of different proportions.
class EvaluateRetrieval : public ToolTest {
protected:
  EvaluateRetrieval() : ToolTest(toolPath("evaluate")) {
    boost::filesystem::create_directories(folder_ / "meshes");
    const auto vase = [](double height) {
      return latheOFF({{0.001, 0}, {0.5, 0}, {0.8, 0.5 * height}, {0.7, height}, {0.3, 1.5 * height}}, 48);
    };
    const auto block = [](double height) { return latheOFF({{0.001, 0}, {1, 0}, {1, height}, {0.001, height}}, 4); };
    int number = 1;
    for (const double height : {0.9, 1.0, 1.1}) {
      folder_.write("meshes/m" + std::to_string(number++) + ".off", vase(height));
      folder_.write("meshes/m" + std::to_string(number++) + ".off", block(height));
    }
    folder_.write("some.cla", "PSB 1\n2 6\n\nvase 0 3\n1\n3\n5\n\nblock 0 3\n2\n4\n6\n");
  }

  int evaluate(const std::string& arguments) {
    return run("retrieval " + (folder_ / "meshes") + " -points 2000 -references 4 " + arguments);
  }
};

TEST_F(EvaluateRetrieval, ComparesMethods) {
  ASSERT_EQ(evaluate("-cla " + (folder_ / "some.cla") + " -json " + (folder_ / "s.json") + " -csv " +
                     (folder_ / "c.csv") + " -class_csv " + (folder_ / "k.csv") + " -png " + (folder_ / "a.png")),
            0)
      << error_;
  const json summary = json::parse(contentOf(folder_ / "s.json"));
  EXPECT_EQ(summary["num_queries"], 6);
  EXPECT_EQ(summary["methods"].size(), 37u);  // 7 in each of 3 frames, 8 in all turns, each also scaled
  for (const auto& [name, method] : summary["methods"].items()) EXPECT_EQ(method["precision"].size(), 20u) << name;
  EXPECT_GE(summary["methods"]["compact signatures"]["nearest"].get<double>(), 0.6);
  EXPECT_NE(output_.find("compact signatures, scaled"), std::string::npos);
  EXPECT_NE(output_.find("PRST x GEDT, all turns - GEDT, all turns"), std::string::npos) << output_;
  EXPECT_NE(contentOf(folder_ / "k.csv").find("vase,3,"), std::string::npos);
  for (const char* chart : {"a_files.png", "a_turned.png", "a_classes.png"})
    EXPECT_EQ(contentOf(folder_ / chart).substr(1, 3), "PNG") << chart;
}

TEST_F(EvaluateRetrieval, SaysWhatIsWrong) {
  EXPECT_EQ(evaluate(""), 2);
  EXPECT_NE(error_.find("-cla"), std::string::npos) << error_;
  folder_.write("other.cla", "PSB 1\n1 1\n\nvase 0 1\n77\n");
  EXPECT_EQ(evaluate("-cla " + (folder_ / "other.cla")), 1);
  EXPECT_NE(error_.find("fewer than 3"), std::string::npos) << error_;
}

TEST_F(EvaluateRetrieval, AsksADatabaseForScans) {
  ASSERT_EQ(run("recognition " + (folder_ / "meshes") + " -points 2000 -leave_out 6 -json " + (folder_ / "r.json") +
                " -csv " + (folder_ / "q.csv")),
            0)
      << error_;
  const json summary = json::parse(contentOf(folder_ / "r.json"));
  EXPECT_EQ(summary["models"], 5);
  EXPECT_EQ(summary["scans"], 6);
  EXPECT_GE(summary["class_rate"].get<double>(), summary["very_model_rate"].get<double>());
  EXPECT_NE(contentOf(folder_ / "q.csv").find("m6,0,"), std::string::npos);
}

}  // namespace
