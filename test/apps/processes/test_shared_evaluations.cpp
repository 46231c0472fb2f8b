#include <gtest/gtest.h>

#include <boost/filesystem.hpp>
#include <nlohmann/json.hpp>
#include <regex>
#include <sstream>
#include <string>

#include "apps/support/lathe_mesh.h"
#include "apps/support/tool_run.h"

namespace {

using nlohmann::json;

/// Evaluations of one process, and of two and four that share them.
class SharedEvaluation : public ToolTest {
protected:
  SharedEvaluation() : ToolTest("") {}

  void SetUp() override {
#ifndef MPI_RUN
    GTEST_SKIP() << "the tools are built without MPI";
#endif
    boost::filesystem::create_directories(folder_ / "meshes");
    int number = 1;
    for (const double height : {0.9, 1.0, 1.1}) {
      folder_.write("meshes/m" + std::to_string(number++) + ".off",
                    latheOFF({{0.001, 0}, {0.5, 0}, {0.8, 0.5 * height}, {0.7, height}, {0.3, 1.5 * height}}, 24));
      folder_.write("meshes/m" + std::to_string(number++) + ".off",
                    latheOFF({{0.001, 0}, {1, 0}, {1, height}, {0.001, height}}, 4));
    }
    folder_.write("some.cla", "PSB 1\n2 7\n\nvase 0 4\n0\n1\n3\n5\n\nblock 0 3\n2\n4\n6\n");
    folder_.write("meshes/m0.off", "OFF\n0 0 0\n");  // cannot be used
  }

  /// \param num_processes 0: without mpirun.
  int evaluate(int num_processes, const std::string& arguments) {
    std::string command = toolPath("evaluate") + " " + arguments + " -quiet";
#ifdef MPI_RUN
    if (num_processes > 0)
      command = "timeout 300 " MPI_RUN " -n " + std::to_string(num_processes) +
                " --allow-run-as-root --oversubscribe --bind-to none " + command;
#endif
    return run(command);
  }

  const std::string meshes_ = folder_ / "meshes";
};

/// The values of all columns but the last one, which is a time.
std::string withoutTimes(const std::string& csv) {
  std::istringstream text(csv);
  std::string all;
  for (std::string line; std::getline(text, line);) all += line.substr(0, line.rfind(',')) + "\n";
  return all;
}

TEST_F(SharedEvaluation, OfRotationsIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& csv) {
    return "rotations -kind nuts -counts 500 -noise 0 -csv " + (folder_ / csv);
  };
  ASSERT_EQ(evaluate(0, arguments("one.csv")), 0) << error_;
  const std::string one = withoutTimes(contentOf(folder_ / "one.csv"));
  ASSERT_GE(std::count(one.begin(), one.end(), '\n'), 3);
  for (const int processes : {1, 2, 4}) {
    ASSERT_EQ(evaluate(processes, arguments("many.csv")), 0) << error_;
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), one);
  }
}

TEST_F(SharedEvaluation, OfPlanesIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& to) {
    boost::filesystem::create_directories(folder_ / to);
    return "planes " + meshes_ + " -max 3 -rows whole,scan -num_views 1 -points 1000 -csv " + (folder_ / to) +
           "/clouds.csv -references " + (folder_ / to) + "/references.json -export " + (folder_ / to) +
           "/clouds -reliability_csv " + (folder_ / to) + "/reliability.csv -json " + (folder_ / to) + "/all.json";
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  EXPECT_EQ(json::parse(contentOf(folder_ / "one/all.json"))["left_out"].size(), 1u);
  for (const int processes : {2, 4}) {
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    for (const char* file :
         {"/references.json", "/reliability.csv", "/clouds/ground_truth.json", "/clouds/m1_scan_0.pcd"})
      if (boost::filesystem::exists(folder_ / "one" + file)) {
        EXPECT_EQ(contentOf(folder_ / "many" + file), contentOf(folder_ / "one" + file)) << file;
      }
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many/clouds.csv")),
              withoutTimes(contentOf(folder_ / "one/clouds.csv")));
    json one = json::parse(contentOf(folder_ / "one/all.json")),
         many = json::parse(contentOf(folder_ / "many/all.json"));
    for (json* summary : {&one, &many})
      for (json& group : (*summary)["groups"]) group.erase("timing_ms");
    EXPECT_EQ(many, one);
  }
}

TEST_F(SharedEvaluation, OfAlignmentIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& to) {
    return "alignment " + meshes_ + " -max 4 -num_views 1 -points 1000 -csv " + (folder_ / to) +
           ".csv -histogram_csv " + (folder_ / to) + "_histogram.csv -json " + (folder_ / to) + ".json";
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  EXPECT_EQ(json::parse(contentOf(folder_ / "one.json"))["left_out"].size(), 1u);
  for (const int processes : {2, 4}) {
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), withoutTimes(contentOf(folder_ / "one.csv")));
    EXPECT_EQ(contentOf(folder_ / "many_histogram.csv"), contentOf(folder_ / "one_histogram.csv"));
  }
}

TEST_F(SharedEvaluation, OfSegmentationIsThatOfOneProcess) {
  boost::filesystem::create_directories(folder_ / "people");
  std::string halves;
  const int num_faces = 96;  // of a vase of the folder
  for (int i = 0; i < num_faces; ++i) halves += i < num_faces / 2 ? "0\n" : "1\n";
  for (const char* model : {"m1", "m3"})
    for (const char* person : {"_0.seg", "_1.seg"}) folder_.write("people/" + std::string(model) + person, halves);
  const auto arguments = [&](const std::string& to) {
    return "segmentation " + meshes_ + " " + (folder_ / "people") +
           " -first 1 -max 4 -methods human,one,k-means -csv " + (folder_ / to) + ".csv -resume " + (folder_ / to) +
           ".journal";
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  const std::string one = withoutTimes(contentOf(folder_ / "one.csv"));
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1 + 2 * 3) << one;
  for (const int processes : {2, 4}) {
    boost::filesystem::remove(folder_ / "many.journal");
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), one);
  }
  // What is in the journal is taken from there.
  ASSERT_EQ(evaluate(0, arguments("many")), 0) << error_;
  EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), one);
}

TEST_F(SharedEvaluation, OfRetrievalIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& name) {
    return "retrieval " + meshes_ + " -cla " + (folder_ / "some.cla") + " -points 500 -csv " + (folder_ / name) +
           ".csv" + " -json " + (folder_ / name) + ".json";
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  const std::string printed = output_;
  EXPECT_EQ(json::parse(contentOf(folder_ / "one.json"))["left_out"].size(), 1u);
  for (const int processes : {2, 4}) {
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(output_, printed);
    EXPECT_EQ(contentOf(folder_ / "many.csv"), contentOf(folder_ / "one.csv"));
    EXPECT_EQ(contentOf(folder_ / "many.json"), contentOf(folder_ / "one.json"));
  }
  EXPECT_NE(evaluate(2, arguments("many") + " -database"), 0) << "it is for one process";
  EXPECT_NE(error_.find("one process"), std::string::npos) << error_;
}

TEST_F(SharedEvaluation, GoesOnWhereItWasInterrupted) {
  const std::string journal = folder_ / "journal", csv = folder_ / "clouds.csv";
  const std::string arguments = "planes " + meshes_ + " -max 3 -rows whole -points 1000 -references " +
                                (folder_ / "references.json") + " -csv " + csv;
  ASSERT_EQ(evaluate(0, arguments), 0) << error_;
  const std::string whole = withoutTimes(contentOf(csv));
  ASSERT_EQ(evaluate(2, arguments + " -resume " + journal), 0) << error_;
  EXPECT_EQ(withoutTimes(contentOf(csv)), whole);
  // As if the run had ended in the middle.
  boost::filesystem::resize_file(journal, boost::filesystem::file_size(journal) / 2);
  boost::filesystem::remove(csv);
  ASSERT_EQ(evaluate(2, arguments + " -resume " + journal), 0) << error_;
  EXPECT_EQ(withoutTimes(contentOf(csv)), whole);
  ASSERT_EQ(evaluate(0, arguments + " -threads 1 -resume " + journal), 0) << error_;
  EXPECT_EQ(withoutTimes(contentOf(csv)), whole) << "nothing was left to do";
  EXPECT_NE(evaluate(0, arguments + " -seed 1 -resume " + journal), 0);
  EXPECT_NE(error_.find("other flags"), std::string::npos) << error_;
}

TEST_F(SharedEvaluation, OfShapesIsThatOfOneProcess) {
  for (const std::string kind : {"folds", "composites"}) {
    const auto arguments = [&](const std::string& to) {
      return "shapes " + kind + " -num 5 -points 800 -csv " + (folder_ / to) + ".csv -json " + (folder_ / to) +
             ".json -resume " + (folder_ / (kind + to)) + ".journal";
    };
    ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
    const std::string printed = output_;
    EXPECT_GE(std::count(printed.begin(), printed.end(), '\n'), 2) << printed;
    for (const int processes : {2, 4}) {
      boost::filesystem::remove(folder_ / (kind + "many.journal"));
      ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
      EXPECT_EQ(output_, printed);
      EXPECT_EQ(contentOf(folder_ / "many.csv"), contentOf(folder_ / "one.csv"));
      EXPECT_EQ(contentOf(folder_ / "many.json"), contentOf(folder_ / "one.json"));
    }
    boost::filesystem::remove(folder_ / "many.csv");
    const std::string journal = folder_ / (kind + "many.journal");
    boost::filesystem::resize_file(journal, boost::filesystem::file_size(journal) / 2);
    ASSERT_EQ(evaluate(2, arguments("many")), 0) << error_;
    EXPECT_EQ(contentOf(folder_ / "many.csv"), contentOf(folder_ / "one.csv"));
  }
}

TEST_F(SharedEvaluation, OfRecognitionIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& to) {
    return "recognition " + meshes_ + " -leave_out 3 -points 800 -min_merit 0.3 -csv " + (folder_ / to) +
           ".csv -json " + (folder_ / to) + ".json -resume " + (folder_ / to) + ".journal";
  };
  const auto summary = [&](const std::string& to) {
    json read = json::parse(contentOf(folder_ / (to + ".json")));
    for (const char* time : {"median_ms", "p95_ms"}) read.erase(time);
    return read;
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  EXPECT_EQ(summary("one")["left_out"].size(), 1u);
  EXPECT_EQ(summary("one")["scans"], 6);
  EXPECT_GT(summary("one")["very_model_rate"], 0.0);
  for (const int processes : {2, 4}) {
    boost::filesystem::remove(folder_ / "many.journal");
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), withoutTimes(contentOf(folder_ / "one.csv")));
    EXPECT_EQ(summary("many"), summary("one"));
  }
}

TEST_F(SharedEvaluation, OfRegistrationIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& to) {
    return "registration " + meshes_ + " -max 4 -num_views 1 -points 800 -impostors -methods symmetry,pca -csv " +
           (folder_ / to) + ".csv -references " + (folder_ / to) + ".references -json " + (folder_ / to) +
           ".json -resume " + (folder_ / to) + ".journal";
  };
  const auto summary = [&](const std::string& to) {
    json read = json::parse(contentOf(folder_ / (to + ".json")));
    for (json& method : read["methods"])
      for (const char* time : {"median_ms", "p95_ms", "median_processor_ms"}) method.erase(time);
    return read;
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  const std::string one = withoutTimes(contentOf(folder_ / "one.csv"));
  // Three of the four models can be used, and two of them have another one before them.
  EXPECT_EQ(std::count(one.begin(), one.end(), '\n'), 1 + 2 * (3 + 2)) << one;
  for (const int processes : {2, 4}) {
    for (const char* file : {"many.journal", "many.references"}) boost::filesystem::remove(folder_ / file);
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), one);
    EXPECT_EQ(contentOf(folder_ / "many.references"), contentOf(folder_ / "one.references"));
    EXPECT_EQ(summary("many"), summary("one"));
  }
}

/// A table whose last column is a time.
std::string withoutLastNumbers(const std::string& text) {
  return std::regex_replace(text, std::regex(" +[0-9]+\n"), "\n");
}

TEST_F(SharedEvaluation, OfScenesIsThatOfOneProcess) {
  const auto arguments = [&](const std::string& to) {
    return "scenes " + meshes_ + " -max 5 -scenes 2 -objects 4 -most_in_band 2 -noise 1 -leave_out 3 -csv " +
           (folder_ / to) + ".csv -references " + (folder_ / to) + ".references -json " + (folder_ / to) +
           ".json -export " + (folder_ / to) + " -resume " + (folder_ / to) + ".journal";
  };
  const auto summary = [&](const std::string& to) {
    json read = json::parse(contentOf(folder_ / (to + ".json")));
    for (json& row : read["rows"]) row.erase("median_ms");
    return read;
  };
  const auto expectSame = [&] {
    EXPECT_EQ(withoutTimes(contentOf(folder_ / "many.csv")), withoutTimes(contentOf(folder_ / "one.csv")));
    EXPECT_EQ(contentOf(folder_ / "many.references"), contentOf(folder_ / "one.references"));
    EXPECT_EQ(contentOf(folder_ / "many/ground_truth.json"), contentOf(folder_ / "one/ground_truth.json"));
    EXPECT_EQ(summary("many"), summary("one"));
  };
  ASSERT_EQ(evaluate(0, arguments("one")), 0) << error_;
  const std::string printed = withoutLastNumbers(output_), csv = contentOf(folder_ / "one.csv");
  EXPECT_GE(std::count(csv.begin(), csv.end(), '\n'), 4) << csv;
  for (const int processes : {2, 4}) {
    for (const char* file : {"many.journal", "many.references"}) boost::filesystem::remove(folder_ / file);
    ASSERT_EQ(evaluate(processes, arguments("many")), 0) << error_;
    EXPECT_EQ(withoutLastNumbers(output_), printed);
    expectSame();
  }
  // As if the run had ended in the middle.
  boost::filesystem::resize_file(folder_ / "many.journal", boost::filesystem::file_size(folder_ / "many.journal") / 2);
  for (const char* file : {"many.csv", "many.references"}) boost::filesystem::remove(folder_ / file);
  ASSERT_EQ(evaluate(2, arguments("many")), 0) << error_;
  expectSame();
}

}  // namespace
