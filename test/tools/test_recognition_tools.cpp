#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "pcl_symmetry/point_types.h"
#include "recognition/model_store.h"
#include "shapes/temporary_folder.h"
#include "tools/models.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using nlohmann::json;

class DescribeTool : public ToolTest {
protected:
  DescribeTool() : ToolTest(toolPath("describe")) {
    folder_.write("vase.off", vaseOFF());
    folder_.write("box.off", boxOFF());
  }
};

TEST_F(DescribeTool, WritesSignaturesThatPCLReads) {
  const std::string out = folder_ / "out";
  ASSERT_EQ(run(out + " " + (folder_ / "vase.off") + " " + (folder_ / "box.off") + " -points 2000"), 0) << error_;
  pcl::PointCloud<ShapeSignature20736> signatures;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/vase.pcd", signatures), 0);
  ASSERT_EQ(signatures.size(), 2u);
  EXPECT_NEAR(sqDistance(signatures[0].signature, ShapeSignature20736().signature, kSignatureSize), 1.0, 1e-4);
  const std::string once = contentOf(out + "/box.pcd");
  ASSERT_EQ(run(out + " " + (folder_ / "box.off") + " -points 2000 -threads 1"), 0);
  EXPECT_EQ(contentOf(out + "/box.pcd"), once);
}

TEST_F(DescribeTool, WritesThePapersDescriptors) {
  const std::string out = folder_ / "out", box = folder_ / "box.off";
  ASSERT_EQ(run(out + " " + box + " -type prst -input_axes -points 2000"), 0) << error_;
  pcl::PointCloud<PRSTSignature32768> prst;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", prst), 0);
  ASSERT_EQ(prst.size(), 1u);
  EXPECT_LT(*std::min_element(prst[0].prst, prst[0].prst + kPRSTSize), 0.7f);
  ASSERT_EQ(run(out + " " + box + " -type prst -equation_1 -points 2000"), 0) << error_;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", prst), 0);
  EXPECT_GT(*std::min_element(prst[0].prst, prst[0].prst + kPRSTSize), 0.7f) << "1 / sqrt(2)";
  ASSERT_EQ(run(out + " " + box + " -type gedt -points 2000"), 0) << error_;
  pcl::PointCloud<GEDTSignature32768> gedt;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", gedt), 0);
  ASSERT_EQ(run(out + " " + box + " -type prsd -points 2000"), 0) << error_;
  pcl::PointCloud<PRSDSignature1024> prsd;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", prsd), 0);
}

TEST_F(DescribeTool, WritesATableAndGoesOnWhereItStopped) {
  const std::string out = folder_ / "out", csv = folder_ / "t.csv",
                    both = (folder_ / "vase.off") + " " + (folder_ / "box.off");
  const std::string flags = " -points 2000 -quiet -type prsd -csv " + csv;
  ASSERT_EQ(run(out + " " + (folder_ / "box.off") + flags), 0) << error_;
  std::string table = contentOf(csv);
  EXPECT_EQ(table.rfind("file,number,prsd_1,prsd_2,", 0), 0u);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 2);
  EXPECT_EQ(std::count(table.begin(), table.end(), ','), 2 * 1025);
  pcl::PointCloud<PRSDSignature1024> prsd;
  ASSERT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", prsd), 0);
  const std::string row = table.substr(table.find('\n') + 1);
  EXPECT_EQ(std::stof(row.substr(row.find(",1,") + 3)), prsd[0].prsd[0]) << "nine digits tell all floats apart";
  // A descriptor of the type that stands there is kept, whatever it is; one of another type is not.
  prsd[0].prsd[0] = 42.0f;
  pcl::io::savePCDFileBinary(out + "/box.pcd", prsd);
  ASSERT_EQ(run(out + " " + both + flags + " -resume"), 0) << error_;
  table = contentOf(csv);
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 3);
  EXPECT_NE(table.find("box.off,1,42,"), std::string::npos);
  ASSERT_EQ(run(out + " " + both + " -points 2000 -quiet -type gedt -resume"), 0) << error_;
  pcl::PointCloud<GEDTSignature32768> gedt;
  EXPECT_EQ(pcl::io::loadPCDFile(out + "/box.pcd", gedt), 0);
}

TEST_F(DescribeTool, SaysWhatIsWrongAndDoesTheRest) {
  const std::string out = folder_ / "out";
  folder_.write("broken.off", "OFF\n3 1 0\n0 0 0\n");
  EXPECT_EQ(run(out + " " + (folder_ / "broken.off") + " " + (folder_ / "box.off") + " -points 2000 -quiet"), 1);
  EXPECT_NE(error_.find("broken.off"), std::string::npos) << "-quiet hides no failure: " << error_;
  EXPECT_TRUE(std::filesystem::exists(out + "/box.pcd"));
  EXPECT_TRUE(fails(out + " " + folder_.write("few.xyz", "0 0 0\n1 0 0\n0 1 0\n0 0 1\n"), 1,
                    "few.xyz: input cloud: 4 distinct points, at least 20 are needed"));
  std::filesystem::create_directories(folder_ / "other");
  folder_.write("other/box.off", boxOFF());
  EXPECT_TRUE(fails(out + " " + (folder_ / "box.off") + " " + (folder_ / "other/box.off"), 1, "names must differ"));
  EXPECT_EQ(run(out + " " + (folder_ / "box.off") + " -type nonsense"), 2);
}

class DatabaseTools : public ToolTest {
protected:
  DatabaseTools() : ToolTest("cd " TOOLS_FOLDER " &&") {
    folder_.write("vase.off", vaseOFF());
    folder_.write("box.off", boxOFF());
    folder_.write("tetrahedron.off", tetrahedronOFF());
  }

  int database(const std::string& arguments) { return run("./pcl_symmetry_database " + arguments); }
  int match(const std::string& arguments) { return run("./pcl_symmetry_match " + arguments); }

  const std::string models_ = folder_ / "models.db";
};

TEST_F(DatabaseTools, BuildAskAndChange) {
  const std::string vase = folder_ / "vase.off", box = folder_ / "box.off", other = folder_ / "tetrahedron.off";
  ASSERT_EQ(database("build " + models_ + " " + vase + " " + box), 0) << error_;
  ASSERT_EQ(database("add " + models_ + " " + (folder_ / "nothing.off") + " " + other), 1) << "one file is missing";
  EXPECT_NE(error_.find("nothing.off"), std::string::npos) << error_;
  EXPECT_EQ(error_.find("1 models"), std::string::npos) << error_;
  ASSERT_EQ(database("list " + models_), 0);
  EXPECT_EQ(output_, "box\ntetrahedron\nvase\n");
  json answer = reportOf("./pcl_symmetry_match " + models_ + " " + vase + " -max 2");
  ASSERT_EQ(answer["matches"].size(), 2u);
  EXPECT_EQ(answer["matches"][0]["name"], "vase");
  answer = reportOf("./pcl_symmetry_match " + models_ + " " + box + " -recognize");
  EXPECT_TRUE(answer["known"]);
  EXPECT_EQ(answer["models"][0]["name"], "box");
  EXPECT_EQ(answer["models"][0]["transform"].size(), 16u);
  EXPECT_EQ(error_.find("1 models"), std::string::npos) << error_;
  ASSERT_EQ(database("remove " + models_ + " box vase"), 0) << error_;
  ASSERT_EQ(database("rebuild " + models_), 0) << error_;
  ASSERT_EQ(match(models_ + " " + box + " -recognize -min_merit 1"), 0) << error_;
  EXPECT_EQ(output_, "unknown object\n");
}

TEST_F(DatabaseTools, GoOnTakeFoldersAndTellWhatTheyHold) {
  std::filesystem::create_directories(folder_ / "shapes/more");
  folder_.write("shapes/a.off", boxOFF());
  folder_.write("shapes/more/b.off", tetrahedronOFF());
  folder_.write("shapes/notes.txt", "mine");
  folder_.write("list.txt", "# files\n" + (folder_ / "vase.off") + "\n" + (folder_ / "sha*") + "\n");
  const std::string build = "build " + models_ + " -points 2000 -names path -unit m -tag thing ";
  ASSERT_EQ(database(build + (folder_ / "shapes")), 0) << error_;
  folder_.write("shapes/a.off", boxOFF() + "\n");
  const json built =
      reportOf("./pcl_symmetry_database " + build + (folder_ / "shapes") + " '" + (folder_ / "va*.off") + "'");
  EXPECT_EQ(built["added"], 2) << "the file that changed and the new one";
  EXPECT_EQ(built["kept"], 1);
  const json listed = reportOf("./pcl_symmetry_database list " + models_ + " -csv " + (folder_ / "list.csv"));
  EXPECT_EQ(output_, "a\nmore_b\nvase\n");
  EXPECT_EQ(contentOf(folder_ / "list.csv").rfind("name,points,time,source,checksum,tags\na,2000,", 0), 0u);
  EXPECT_EQ(listed["models"][1]["tags"][0], "thing");
  ASSERT_EQ(database("info " + models_), 0) << error_;
  EXPECT_EQ(output_.rfind("models  3\nunit    m\n", 0), 0u) << output_;
  ASSERT_EQ(database("info " + models_ + " vase"), 0) << error_;
  EXPECT_NE(output_.find("vase.off"), std::string::npos) << output_;
  ASSERT_EQ(database("export " + models_ + " " + (folder_ / "clouds")), 0) << error_;
  pcl::PointCloud<pcl::PointXYZ> cloud;
  ASSERT_EQ(pcl::io::loadPCDFile(folder_ / "clouds/more_b.pcd", cloud), 0);
  EXPECT_EQ(cloud.size(), 2000u);
  EXPECT_EQ(database("export " + models_ + " " + (folder_ / "clouds") + " a"), 1) << "files that are there stay";
  ASSERT_EQ(database("merge " + (folder_ / "other.db") + " " + models_), 0) << error_;
  ASSERT_EQ(database("check " + (folder_ / "other.db")), 0) << error_ << output_;
  std::string damaged = contentOf(folder_ / "other.db");
  std::fill(damaged.begin() + static_cast<std::ptrdiff_t>(damaged.size() / 2), damaged.end(), 'x');
  EXPECT_EQ(database("check " + folder_.write("damaged.db", damaged) + " -quiet"), 1);
  EXPECT_EQ(output_, "");
  EXPECT_NE(error_.find("damaged.db: "), std::string::npos) << error_;
  EXPECT_EQ(error_.find("check names"), std::string::npos) << error_;
  ASSERT_EQ(database("build " + (folder_ / "third.db") + " @" + (folder_ / "list.txt") + " -points 2000"), 0) << error_;
  ASSERT_EQ(database("list " + (folder_ / "third.db")), 0) << error_;
  EXPECT_EQ(output_, "a\nb\nvase\n");
}

/// What a database holds of each model, but the time.
std::map<std::string, std::vector<std::string>> contentsOf(const std::string& file) {
  detail::ModelStore store(file, 10.0, "");
  std::map<std::string, std::vector<std::string>> contents;
  for (const detail::StoredModel& model : store.models()) {
    const ModelInfo info = store.find(model.name).value().second;
    std::vector<std::string>& parts = contents[model.name];
    parts = {info.source.path, info.source.checksum, std::to_string(info.num_points)};
    for (const auto part : {detail::ModelPart::Cloud, detail::ModelPart::Signatures, detail::ModelPart::Views})
      parts.push_back(store.part(part, model));
  }
  contents["projection"] = {std::to_string(store.projectionId())};
  return contents;
}

TEST_F(DatabaseTools, MergesParts) {
  const std::string vase = folder_ / "vase.off", box = folder_ / "box.off", other = folder_ / "tetrahedron.off";
  const std::string one = folder_ / "one.db", merged = folder_ / "merged.db", flags = " -points 2000 -quiet";
  const std::string first = folder_ / "first.db", second = folder_ / "second.db";
  ASSERT_EQ(database("build " + one + " " + vase + " " + box + " " + other + flags), 0) << error_;
  ASSERT_EQ(database("build " + first + " " + vase + " " + other + flags + " -part"), 0) << error_;
  ASSERT_EQ(database("build " + second + " " + box + flags + " -part"), 0) << error_;
  EXPECT_EQ(contentsOf(first)["projection"].front(), "0") << "parts are not fitted";
  EXPECT_EQ(reportOf("./pcl_symmetry_database merge " + merged + " " + first + " " + second)["added"], 3);
  EXPECT_EQ(contentsOf(merged), contentsOf(one));
  const auto answer = [&](const std::string& file) {
    return reportOf("./pcl_symmetry_match " + file + " " + box + " -points 2000")["matches"];
  };
  EXPECT_EQ(answer(merged), answer(one));
  // What cannot be merged changes nothing.
  const std::string inches = folder_ / "inches.db", before = contentOf(merged);
  ASSERT_EQ(database("build " + inches + " " + box + flags + " -unit inch -part"), 0) << error_;
  EXPECT_EQ(database("merge " + merged + " " + inches), 1);
  EXPECT_NE(error_.find(inches + ": unit = 'inch', must be '' as in " + merged), std::string::npos) << error_;
  EXPECT_EQ(contentOf(merged), before);
  EXPECT_EQ(database("merge " + (folder_ / "new.db") + " " + first + " " + inches), 1);
  EXPECT_FALSE(std::filesystem::exists(folder_ / "new.db"));
}

}  // namespace
