#include <gtest/gtest.h>
#include <pcl/common/io.h>
#include <pcl/io/pcd_io.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>
#include <vector>

#include "io/shape_input.h"
#include "pcl/clouds.h"
#include "shapes/scans.h"
#include "tools/tool_run.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;

class SceneTool : public ToolTest {
protected:
  SceneTool() : ToolTest(toolPath("scene")) {
    pcl::PointCloud<pcl::PointXYZRGB> cloud;
    pcl::copyPointCloud(*test::pictureOf(table_.scan), cloud);
    for (pcl::PointXYZRGB& point : cloud) point.r = 200;
    pcl::io::savePCDFileBinary(scene_, cloud);
  }

  const test::Table table_{{{-0.35, 0.1, 0.0}, {0.25, 0.0, 0.0}}};
  const std::string scene_ = folder_ / "scene.pcd";
};

TEST_F(SceneTool, WritesWhatItFinds) {
  const std::string completed = folder_ / "completed.pcd", png = folder_ / "objects.png";
  const nlohmann::json report =
      reportOf(scene_ + " " + completed + " -max_points 1000 -png " + png + " -html " + (folder_ / "page.html"));
  EXPECT_EQ(output_.substr(0, output_.find('\n')), "1 supporting plane, 2 objects");
  ASSERT_EQ(report["objects"].size(), 2u);
  EXPECT_EQ(report["viewpoint"]["from"], "rays");
  ASSERT_EQ(report["supports"].size(), 1u);
  EXPECT_NEAR(report["supports"][0]["coefficients"][2].get<double>(), 1.0, 0.01);
  EXPECT_TRUE(report["junctions"].empty()) << "the boxes do not touch";
  std::size_t num_added = 0;
  for (const nlohmann::json& object : report["objects"]) {
    EXPECT_EQ(object["frame"]["transform"].size(), 16u);
    EXPECT_GT(object["num_points"], 300);
    if (object.contains("completed")) num_added += object["completed"]["num_added"].get<std::size_t>();
  }
  const Shape written = loadShape(completed);
  EXPECT_EQ(written.points->size(), static_cast<std::size_t>(table_.scan.cloud().cols()) + num_added);
  for (const char* name : {"object", "completed"})
    EXPECT_TRUE(std::any_of(written.cloud.fields.begin(), written.cloud.fields.end(),
                            [&](const pcl::PCLPointField& field) { return field.name == name; }))
        << name;
  EXPECT_EQ(contentOf(png).substr(1, 3), "PNG");
  const std::string page = contentOf(folder_ / "page.html");
  EXPECT_NE(page.find("1 supporting plane, 2 objects"), std::string::npos);
  EXPECT_NE(page.find("</html>"), std::string::npos);
  EXPECT_NE(page.find("\"picture\":{\"pixels\":\"yAAA"), std::string::npos) << "the colors of the camera";
  EXPECT_NE(page.find("2: "), std::string::npos) << "objects one by one";
  EXPECT_NE(page.find("decided at 1.0 % of the diameter"), std::string::npos);
}

/// The tool as a program that runs beside the test.
class Watcher {
public:
  Watcher(const std::string& folder, const std::string& output, const std::string& messages) : process_(fork()) {
    if (process_ == 0) {
      if (!std::freopen(output.c_str(), "w", stdout) || !std::freopen(messages.c_str(), "w", stderr)) _exit(3);
      execl(toolPath("scene").c_str(), "pcl_symmetry_scene", "-watch", folder.c_str(), "-max_points", "300",
            "-no_frames", "-threads", "1", nullptr);
      _exit(3);
    }
  }
  ~Watcher() {
    if (process_ > 0) kill(process_, SIGKILL), waitpid(process_, nullptr, 0);
  }

  /// \return the exit code; -1 where the signal ended the program.
  int stop(int signal) {
    kill(process_, signal);
    int status = 0;
    waitpid(process_, &status, 0);
    process_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

private:
  pid_t process_;
};

/// \return whether the text comes to stand in the file within a minute.
template <typename Holds>
bool comesToHold(const std::string& file, const Holds& holds) {
  for (int i = 0; i < 1200; ++i) {
    if (std::filesystem::exists(file) && holds(contentOf(file))) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
  return false;
}

TEST_F(SceneTool, TellsWhatTouches) {
  // A second box on the first one, turned by none but off its middle.
  const test::Table stack({{0.0, 0.0, 0.0}, {-0.1, 0.33, 0.24}});
  const std::string file = folder_ / "stack.pcd";
  pcl::io::savePCDFileBinary(file, *test::pictureOf(stack.scan));
  const nlohmann::json report = reportOf(file + " -ground 0,0,1,0 -no_frames -max_points 1000");
  EXPECT_EQ(report["supports"][0]["coefficients"], (std::vector<double>{0.0, 0.0, 1.0, 0.0}));
  for (const nlohmann::json& junction : report["junctions"]) {
    EXPECT_EQ(junction["joined"].get<bool>(), junction["objects"][0] == junction["objects"][1]);
    EXPECT_NE(output_.find(" explains "), std::string::npos);
  }
  const nlohmann::json together = reportOf(file + " -no_separation -no_frames -max_points 1000");
  EXPECT_EQ(together["objects"].size(), 1u);
  EXPECT_TRUE(together["junctions"].empty());
}

TEST_F(SceneTool, WatchesAFolder) {
  const std::string watched = folder_ / "frames", output = folder_ / "lines", messages = folder_ / "messages";
  std::filesystem::create_directory(watched);
  std::filesystem::copy_file(scene_, watched + "/before.pcd");
  Watcher watcher(watched, output, messages);
  ASSERT_TRUE(comesToHold(messages, [](const std::string& text) { return text.find("Watching") != text.npos; }));
  const auto lines = [&](std::ptrdiff_t count) {
    return comesToHold(output,
                       [&](const std::string& text) { return std::count(text.begin(), text.end(), '\n') >= count; });
  };
  const std::string content = contentOf(scene_);
  {
    // A file is not read before it is closed.
    std::ofstream slow(watched + "/slow.pcd", std::ios::binary);
    slow << content.substr(0, content.size() / 2) << std::flush;
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(contentOf(output), "");
    slow << content.substr(content.size() / 2);
  }
  ASSERT_TRUE(lines(1));
  std::ofstream(watched + "/bad.pcd") << "no cloud";
  std::ofstream(watched + "/notes.txt") << "no cloud";
  std::ofstream(watched + "/.hidden.pcd") << "no cloud";
  ASSERT_TRUE(lines(2));
  std::filesystem::copy_file(scene_, watched + "/part");
  std::filesystem::rename(watched + "/part", watched + "/slow.pcd");  // in place of the first one
  ASSERT_TRUE(lines(3));
  EXPECT_EQ(watcher.stop(SIGTERM), 0);
  const std::vector<nlohmann::json> found = jsonLines(contentOf(output));
  ASSERT_EQ(found.size(), 3u);
  EXPECT_EQ(found[0]["file"], watched + "/slow.pcd");
  EXPECT_EQ(found[0]["objects"].size(), 2u);
  EXPECT_EQ(found[1]["file"], watched + "/bad.pcd");
  EXPECT_NE(found[1]["error"].get<std::string>().find("bad.pcd"), std::string::npos);
  EXPECT_EQ(found[2]["file"], watched + "/slow.pcd");
  EXPECT_EQ(found[2]["objects"], found[0]["objects"]);
}

TEST_F(SceneTool, EndsItsWatchOnASignalAndWithItsFolder) {
  for (const int signal : {SIGINT, SIGHUP}) {
    const std::string messages = (folder_ / "messages") + std::to_string(signal);
    Watcher watcher(folder_ / "", folder_ / "lines", messages);
    ASSERT_TRUE(comesToHold(messages, [](const std::string& text) { return text.find("Watching") != text.npos; }));
    EXPECT_EQ(watcher.stop(signal), 0);
  }
  EXPECT_TRUE(fails("-watch " + (folder_ / "none"), 1, "none: cannot be watched"));
  EXPECT_EQ(run(scene_ + " -watch " + (folder_ / "")), 2);
  EXPECT_TRUE(fails("", 2, "missing argument 'input'"));
}

TEST_F(SceneTool, RefusesWhatIsNoScene) {
  const std::string mesh = folder_.write("t.off", "OFF\n3 1 3\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  EXPECT_TRUE(fails(mesh, 1, mesh + ": is a mesh, must be a cloud as a sensor sees it"));
  EXPECT_TRUE(fails(scene_ + " -database " + (folder_ / "none.db"), 1, "none.db"));
  EXPECT_EQ(run(scene_ + " -min_points 3"), 2);
  EXPECT_TRUE(fails(scene_ + " -ground 0,0,1", 2, "-ground = 0,0,1, must be four numbers A,B,C,D"));
  EXPECT_EQ(run(scene_ + " out.txt"), 2);
}

}  // namespace
