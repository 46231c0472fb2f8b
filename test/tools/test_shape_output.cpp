#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include "io/shape_input.h"
#include "io/shape_output.h"
#include "tools/temporary_folder.h"

namespace {

using namespace pcl_symmetry::apps;

TEST(MakeFolder, MakesWhatIsMissingAndRefusesAFile) {
  const TemporaryFolder folder;
  makeFolder(folder / "a/b/");
  makeFolder(folder / "a/.");
  makeFolder(".");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a"});
  folder.write("file", "");
  EXPECT_THROW(makeFolder(folder / "file"), InputError);
  EXPECT_THROW(makeFolder(folder / "file/below"), InputError);
}

TEST(WriteAtomically, KeepsTheOldFileWhenTheWriterFails) {
  const TemporaryFolder folder;
  folder.write("a.txt", "old");
  EXPECT_THROW(writeAtomically(folder / "a.txt",
                               [](const std::string& temporary) {
                                 std::ofstream(temporary) << "half";
                                 throw std::runtime_error("stop");
                               }),
               std::runtime_error);
  EXPECT_THROW(writeAtomically(folder / "a.txt", [](const std::string&) {}), InputError);
  EXPECT_EQ(contentOf(folder / "a.txt"), "old");
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(WriteAtomically, NamesTheFileThatCannotBeWritten) {
  const TemporaryFolder folder;
  for (const std::string& path : {folder / "missing/a.txt", folder / ".", std::string()}) {
    EXPECT_THROW(writeText(path, "x"), InputError) << path;
  }
  EXPECT_THROW(writeText("/dev/full", "x"), InputError);
  EXPECT_THROW(writeText("/proc/a.txt", "x"), InputError);
}

TEST(WriteAtomically, RemovesTheTemporaryFileWhenInterrupted) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const TemporaryFolder folder;
    const pid_t child = fork();
    if (child == 0) {
      writeAtomically(folder / "a.txt", [&](const std::string& temporary) {
        std::ofstream(temporary) << "half";
        raise(signal);
      });
      _exit(0);
    }
    int status = 0;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == signal);
    EXPECT_TRUE(folder.names().empty());
  }
}

TEST(SaveCloud, KeepsFieldsOrganizationAndPose) {
  const TemporaryFolder folder;
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud(4, 3);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud[i].x = 0.1f * static_cast<float>(i);
    cloud[i].y = 1.0f / 3.0f;
    cloud[i].curvature = static_cast<float>(i);
    cloud[i].g = static_cast<std::uint8_t>(i);
  }
  cloud[5].z = std::numeric_limits<float>::quiet_NaN();
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(cloud, fields);
  const Eigen::Vector4f origin(1, -2, 0.5f, 0);
  const Eigen::Quaternionf orientation(0.5f, 0.5f, -0.5f, 0.5f);
  const auto check = [&](const std::string& path, bool organized) {
    const Shape loaded = loadShape(path);
    ASSERT_EQ(loaded.points->size(), cloud.size()) << path;
    EXPECT_EQ(loaded.cloud.width, organized ? 4u : loaded.cloud.width);
    EXPECT_TRUE(loaded.sensor_origin.head<3>().isApprox(origin.head<3>())) << path << loaded.sensor_origin.transpose();
    EXPECT_GT(std::abs(loaded.sensor_orientation.dot(orientation)), 1 - 1e-5) << path;
    EXPECT_TRUE(loaded.points->sensor_origin_.head<3>().isApprox(origin.head<3>()));
    pcl::PointCloud<pcl::PointXYZRGBNormal> back;
    pcl::fromPCLPointCloud2(loaded.cloud, back);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      EXPECT_EQ(back[i].x, cloud[i].x);
      EXPECT_EQ(back[i].y, cloud[i].y);
      EXPECT_EQ(back[i].curvature, cloud[i].curvature);
      EXPECT_EQ(back[i].g, cloud[i].g) << path;
    }
    EXPECT_TRUE(std::isnan(back[5].z));
    EXPECT_FALSE(loaded.points->is_dense);
  };
  for (const PCDEncoding encoding : {PCDEncoding::Ascii, PCDEncoding::Binary, PCDEncoding::BinaryCompressed}) {
    saveCloud(folder / "cloud.pcd", fields, origin, orientation, encoding);
    check(folder / "cloud.pcd", true);
  }
  saveCloud(folder / "cloud.ply", fields, origin, orientation);
  check(folder / "cloud.ply", false);
  EXPECT_EQ(folder.names().size(), 2u);
}

TEST(SaveCloud, RefusesWhatItCannotWrite) {
  const TemporaryFolder folder;
  pcl::PCLPointCloud2 empty;
  const Eigen::Vector4f origin = Eigen::Vector4f::Zero();
  EXPECT_THROW(saveCloud(folder / "a.pcd", empty, origin, Eigen::Quaternionf::Identity()), InputError);
  EXPECT_THROW(saveCloud(folder / "a.xyz", empty, origin, Eigen::Quaternionf::Identity()), InputError);
  EXPECT_THROW(checkCloudExtension("a.xyz"), UsageError);
  EXPECT_NO_THROW(checkCloudExtension("a.PCD"));
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
