#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "io/shape_input.h"
#include "tools/lathe_mesh.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry::apps;

/// A tool with a folder "in" of two boxes and a file that is no shape.
class PlanesPipelines : public ToolTest {
protected:
  PlanesPipelines() : ToolTest(toolPath("planes")) {
    boost::filesystem::create_directory(folder_ / "in");
    folder_.write("in/a.off", boxOFF("1.5", "2"));
    folder_.write("in/b.off", "no shape");
    folder_.write("in/c.off", boxOFF("1.5", "3"));
  }

  std::vector<nlohmann::json> lines(const std::string& text) const {
    std::vector<nlohmann::json> result;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) result.push_back(nlohmann::json::parse(line));
    return result;
  }

  const std::string in_ = folder_ / "in";
};

TEST_F(PlanesPipelines, TakeAFolder) {
  EXPECT_EQ(run(in_ + " -quiet -points 2000 -csv " + (folder_ / "t.csv") + " -json " + (folder_ / "t.jsonl") +
                " -support '" + (folder_ / "{}_support.pcd") + "'"),
            1);
  EXPECT_EQ(output_, "");
  EXPECT_EQ(std::count(error_.begin(), error_.end(), '\n'), 1) << error_;
  EXPECT_NE(error_.find("b.off: does not begin with OFF"), std::string::npos) << error_;
  const auto found = lines(contentOf(folder_ / "t.jsonl"));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0]["planes"].size(), 3u);
  EXPECT_TRUE(found[1].contains("error"));
  EXPECT_EQ(found[2]["file"], in_ + "/c.off");
  const std::string csv = contentOf(folder_ / "t.csv");
  EXPECT_EQ(csv.rfind("file,number,kind,a,b,c,d,", 0), 0u);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 7);
  EXPECT_EQ(loadShape(folder_ / "a_support.pcd").points->size(), 2000u);
  EXPECT_EQ(loadShape(folder_ / "c_support.pcd").points->size(), 2000u);
  // The same as one by one.
  ASSERT_EQ(run(in_ + "/c.off -quiet -points 2000 -json " + (folder_ / "c.json")), 0);
  nlohmann::json alone = nlohmann::json::parse(contentOf(folder_ / "c.json")), among = found[2];
  alone.erase("timing_ms");
  among.erase("timing_ms");
  EXPECT_EQ(alone, among);
}

TEST_F(PlanesPipelines, PrintLinesOfJSONWhereNoFileIsNamed) {
  ASSERT_EQ(run(in_ + "/a.off " + in_ + "/c.off -quiet -points 2000"), 0) << error_;
  EXPECT_EQ(lines(output_).size(), 2u);
  EXPECT_EQ(run(in_ + " -png out.png"), 2);
  EXPECT_NE(error_.find("must hold {}"), std::string::npos) << error_;
  EXPECT_EQ(run(in_ + " -resume"), 2);
  EXPECT_NE(error_.find("-resume needs -json FILE"), std::string::npos) << error_;
}

TEST_F(PlanesPipelines, ReadStandardInputAndWriteStandardOutput) {
  ASSERT_EQ(run("- -quiet -points 2000 <" + in_ + "/a.off"), 0) << error_;
  EXPECT_NE(output_.find("symmetry"), std::string::npos);
  ASSERT_EQ(run("- -quiet -points 2000 -json - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(nlohmann::json::parse(output_)["file"], "-");
  ASSERT_EQ(run("- -quiet -points 2000 -support - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(output_.rfind("# .PCD", 0), 0u);
  ASSERT_EQ(run("- -quiet -points 2000 -csv - <" + in_ + "/a.off"), 0) << error_;
  EXPECT_EQ(output_.rfind("file,number", 0), 0u);
  EXPECT_EQ(run("- -quiet -csv - -json - <" + in_ + "/a.off"), 2);
  EXPECT_EQ(run("- -quiet <" + in_ + "/b.off"), 1);
  EXPECT_NE(error_.find("standard input: is of no known kind"), std::string::npos) << error_;
  EXPECT_EQ(run("- -quiet </dev/null"), 1);
  EXPECT_NE(error_.find("standard input: is empty"), std::string::npos) << error_;
  const std::string cut = folder_.write("cut.off", "OFF\n3 1 0\n0 0 0\n0 0 0\n");
  EXPECT_EQ(run("- -quiet <" + cut), 1);
  EXPECT_NE(error_.find("standard input: x of vertex 2 is missing"), std::string::npos) << error_;
}

/// Names in UTF-8, and bytes that are none: file names are bytes.
TEST_F(PlanesPipelines, TakeNamesInAnyLanguage) {
  const std::string folder = folder_ / "W\xc3\xbcrfel \xe7\xab\x8b\xe6\x96\xb9";
  boost::filesystem::create_directory(folder);
  const std::string box = contentOf(in_ + "/a.off");
  for (const std::string name : {"\xd0\xba\xd1\x83\xd0\xb1 1", "no \xff text", "'quotes' & more"}) {
    const std::string path = folder + "/" + name;
    std::ofstream(path + ".off", std::ios::binary) << box;
    std::string quoted;
    for (const char c : path) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    const auto out = [&](const std::string& ending) { return "'" + quoted + ending + "'"; };
    ASSERT_EQ(run(out(".off") + " -quiet -points 2000 -json " + out(".json") + " -csv " + out(".csv") + " -support " +
                  out("_support.ply") + " -html " + out(".html")),
              0)
        << name << ": " << error_;
    EXPECT_EQ(nlohmann::json::parse(contentOf(path + ".json"))["planes"].size(), 3u) << name;
    EXPECT_EQ(loadShape(path + "_support.ply").points->size(), 2000u) << name;
    EXPECT_NE(contentOf(path + ".html"), "") << name;
  }
  ASSERT_EQ(run("'" + folder + "' -quiet -points 2000"), 0) << error_;
  EXPECT_EQ(lines(output_).size(), 6u) << "three boxes, three clouds with support";
}

TEST_F(PlanesPipelines, SayThatStandardOutputIsFull) {
  for (const std::string flags : {"-json -", "-csv -", "-support -", ""}) {
    const int status = std::system((toolPath("planes") + " " + in_ + "/a.off -quiet -points 2000 " + flags +
                                    " >/dev/full 2>" + (folder_ / "stderr"))
                                       .c_str());
    EXPECT_EQ(WEXITSTATUS(status), 1) << flags;
    EXPECT_NE(contentOf(folder_ / "stderr").find("standard output"), std::string::npos) << flags;
  }
}

}  // namespace
