#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <set>
#include <sstream>
#include <thread>

#include "command_line/csv.h"
#include "command_line/input_files.h"
#include "command_line/run_on_files.h"
#include "io/standard_streams.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

struct BatchTest : testing::Test {
  BatchTest() {
    for (const char* name : {"a.xyz", "b.xyz", "c.xyz"}) folder.write(name, "1 2 3\n");
    common.quiet = true;
    common.json_path = folder / "out.jsonl";
    batch.inputs = {folder / "a.xyz", folder / "b.xyz", folder / "c.xyz"};
  }

  /// Fails for b, and is slow for a.
  int run() {
    return runOnFiles(batch, common, {"letter", "size"}, [this](FileJob& job) {
      ++num_analysed;
      const std::string name = job.output("{}");
      if (name == "a") std::this_thread::sleep_for(std::chrono::milliseconds(20));
      if (name == failing) throw InputError(job.path() + ": is wrong");
      job.report({name + "\n", {{"file", job.path()}, {"letter", name}}, {{name, 7}, {name + ",", 0.5}}});
    });
  }

  std::vector<nlohmann::json> lines() const { return jsonLines(contentOf(folder / "out.jsonl")); }

  TemporaryFolder folder;
  BatchOptions batch;
  CommonOptions common;
  std::string failing;
  std::atomic<int> num_analysed{0};
};

TEST_F(BatchTest, WritesALineForEachInputInTheirOrder) {
  batch.csv_path = folder / "out.csv";
  for (const int threads : {1, 3}) {
    common.threads = threads;
    ASSERT_EQ(run(), 0);
    ASSERT_EQ(lines().size(), 3u);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(lines()[i]["letter"], std::string(1, static_cast<char>('a' + i)));
    EXPECT_EQ(contentOf(folder / "out.csv"), "file,letter,size\n" + batch.inputs[0] + ",a,7\n" + batch.inputs[0] +
                                                 ",\"a,\",0.5\n" + batch.inputs[1] + ",b,7\n" + batch.inputs[1] +
                                                 ",\"b,\",0.5\n" + batch.inputs[2] + ",c,7\n" + batch.inputs[2] +
                                                 ",\"c,\",0.5\n");
  }
}

TEST_F(BatchTest, ResumesWhereItWasInterrupted) {
  failing = "b";
  batch.csv_path = folder / "out.csv";
  testing::internal::CaptureStderr();
  EXPECT_EQ(run(), 1);
  testing::internal::GetCapturedStderr();
  // Killed while it wrote the third line.
  const std::string whole = contentOf(folder / "out.jsonl");
  folder.write("out.jsonl", whole.substr(0, whole.size() - 4));
  failing.clear();
  num_analysed = 0;
  batch.resume = true;
  ASSERT_EQ(run(), 0);
  EXPECT_EQ(num_analysed, 2) << "b failed and c was torn";
  ASSERT_EQ(lines().size(), 3u);
  std::set<std::string> letters;
  for (const nlohmann::json& line : lines()) letters.insert(line.at("letter"));
  EXPECT_EQ(letters, (std::set<std::string>{"a", "b", "c"}));
  const std::string csv = contentOf(folder / "out.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  ASSERT_EQ(run(), 0);
  EXPECT_EQ(num_analysed, 2) << "nothing is left to do";
  folder.write("out.jsonl", "{\"shapes\": []}\n");
  EXPECT_THROW(run(), InputError) << "something else is not overwritten";
  EXPECT_EQ(contentOf(folder / "out.jsonl"), "{\"shapes\": []}\n");
}

/// With more inputs than may wait for an early one, nothing hangs and the order is that of the inputs.
TEST_F(BatchTest, TakesManyInputs) {
  std::string list;
  for (int i = 0; i < 2000; ++i) list += (folder / (std::to_string(i) + ".xyz")) + "\n";
  batch.inputs = {"@" + folder.write("list", list)};
  common.threads = 4;
  for (const int kept : {0, 1500}) {
    batch.resume = kept > 0;
    num_analysed = 0;
    if (kept > 0) {
      std::istringstream all(contentOf(folder / "out.jsonl"));
      std::string some, line;
      for (int i = 0; i < kept && std::getline(all, line); ++i) some += line + "\n";
      folder.write("out.jsonl", some);
    }
    ASSERT_EQ(run(), 0);
    EXPECT_EQ(num_analysed, 2000 - kept);
    const auto found = lines();
    ASSERT_EQ(found.size(), 2000u);
    for (int i = 0; i < 2000; ++i) ASSERT_EQ(found[i]["letter"], std::to_string(i));
  }
}

TEST_F(BatchTest, RefusesNamesThatClash) {
  std::optional<std::string> picture = "picture.png";
  batch.outputs = {&picture};
  EXPECT_THROW(run(), UsageError) << "no {}";
  picture = "-";
  EXPECT_THROW(run(), UsageError);
  picture = "{}.png";
  EXPECT_EQ(run(), 0);
  batch.inputs.push_back(folder / "more/a.pcd");
  EXPECT_THROW(run(), InputError) << "two inputs are called a";
  batch.inputs = {folder / "a.xyz"};
  batch.resume = true;
  EXPECT_THROW(run(), UsageError) << "nothing to resume";
}

TEST(InputFiles, AreFilesFoldersPatternsAndLists) {
  const TemporaryFolder folder;
  for (const char* name : {"b.pcd", "a.PLY", "c.txt", "d.glb"}) folder.write(name, "x");
  const auto paths = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> names;
    const InputFiles files = inputFiles(arguments);
    for (std::size_t i = 0; i < files.size(); ++i) names.push_back(files.path(i));
    return names;
  };
  EXPECT_EQ(paths({folder / "."}),
            (std::vector<std::string>{folder / "./a.PLY", folder / "./b.pcd", folder / "./d.glb"}));
  EXPECT_EQ(paths({folder / "*.txt"}), std::vector<std::string>{folder / "c.txt"});
  const InputFiles files = inputFiles({folder / "c.txt", folder / ".", folder / "c.txt"});
  ASSERT_EQ(files.size(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(files[i].folder, i % 4 == 0 ? "" : folder / ".");
  const std::string list = folder.write("list", "# comment\n" + (folder / "c.txt") + "\n\n  missing.pcd \n");
  EXPECT_EQ(paths({"@" + list, "-"}), (std::vector<std::string>{folder / "c.txt", "missing.pcd", "-"}));
  EXPECT_THROW(paths({folder / "*.stl"}), InputError);
  EXPECT_THROW(paths({"@" + (folder / "nowhere")}), InputError);
  EXPECT_TRUE(hasShapeExtension("a.XYZ"));
  EXPECT_FALSE(hasShapeExtension("a.or"));
  EXPECT_FALSE(hasShapeExtension("pcd"));
}

TEST(CSV, QuotesWhatItMust) {
  EXPECT_EQ(csvLine({"a \"b\", c", 1, 0.5, nullptr, "d"}), "\"a \"\"b\"\", c\",1,0.5,,d\n");
  EXPECT_EQ(firstCell("\"a \"\"b\"\", c\",1\n"), "a \"b\", c");
  EXPECT_EQ(firstCell("plain,1\n"), "plain");
}

TEST(StandardInput, KnowsKindsByTheirContent) {
  EXPECT_EQ(extensionOfContent("# .PCD v0.7\nVERSION"), ".pcd");
  EXPECT_EQ(extensionOfContent("VERSION 0.7\n"), ".pcd");
  EXPECT_EQ(extensionOfContent("ply\r\nformat"), ".ply");
  EXPECT_EQ(extensionOfContent("# a mesh\nv 1 2 3\n"), ".obj");
  EXPECT_EQ(extensionOfContent("COFF\n1 0 0\n"), ".off");
  EXPECT_EQ(extensionOfContent("solid cube\n"), ".stl");
  EXPECT_EQ(extensionOfContent(std::string(80, 'x') + std::string("\1\0\0\0", 4) + std::string(50, '\0')), ".stl");
  EXPECT_EQ(extensionOfContent("glTF...."), ".glb");
  EXPECT_EQ(extensionOfContent("\n# x y z\n-1.5 2 3\n"), ".xyz");
  EXPECT_EQ(extensionOfContent("//X Y Z\n1 2 3\n"), ".xyz");
  EXPECT_EQ(extensionOfContent("SOLID cube\n"), ".stl");
  EXPECT_EQ(extensionOfContent("hello"), "");
  EXPECT_EQ(extensionOfContent(""), "");
}

}  // namespace
