/// Files that are written hold all fields, and survive kills and full disks.
#include <gtest/gtest.h>
#include <pcl/conversions.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <random>
#include <set>
#include <thread>

#include "io/mesh_output.h"
#include "io/shape_input.h"
#include "io/shape_output.h"
#include "shapes/complaint.h"
#include "shapes/temporary_folder.h"

namespace {

using namespace pcl_symmetry::apps;

using pcl_symmetry::test::complaintOf;

/// All points of a cloud have the number of the cloud as coordinates.
pcl::PCLPointCloud2 cloudOf(int number, std::uint32_t size) {
  const auto value = static_cast<float>(number);
  const pcl::PointCloud<pcl::PointXYZ> cloud(size, 1, pcl::PointXYZ(value, value, value));
  pcl::PCLPointCloud2 fields;
  pcl::toPCLPointCloud2(cloud, fields);
  return fields;
}

using Writer = std::function<void(const std::string& path, int number)>;

/// What the tools write their files with, by the extension.
std::map<std::string, Writer> writers(std::uint32_t size) {
  const auto cloud = [size](PCDEncoding encoding) -> Writer {
    return [=](const std::string& path, int number) {
      saveCloud(path, cloudOf(number, size), Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), encoding);
    };
  };
  return {{"ascii.pcd", cloud(PCDEncoding::Ascii)},
          {"binary.pcd", cloud(PCDEncoding::Binary)},
          {"compressed.pcd", cloud(PCDEncoding::BinaryCompressed)},
          {"cloud.ply", cloud(PCDEncoding::Binary)},
          {"labels.seg",
           [size](const std::string& path, int number) { writeFaceLabels(path, std::vector<int>(size, number)); }}};
}

/// \return the number that everything in the file has; -1 where it is not the whole file.
int numberIn(const std::string& path, std::size_t size) {
  if (path.substr(path.size() - 4) == ".seg") {
    std::ifstream file(path);
    const std::vector<int> labels{std::istream_iterator<int>(file), {}};
    return labels.size() == size &&
                   std::count(labels.begin(), labels.end(), labels[0]) == static_cast<std::ptrdiff_t>(size)
               ? labels[0]
               : -1;
  }
  const auto points = loadShape(path).points;
  for (const pcl::PointXYZ& point : *points)
    if (point.x != (*points)[0].x || point.z != point.x) return -1;
  return points->size() == size ? static_cast<int>((*points)[0].x) : -1;
}

/// Writes the files again and again, until it is killed, and a byte into a pipe after each.
[[noreturn]] void writeForever(const TemporaryFolder& folder, std::uint32_t size, int pipe) {
  const auto all = writers(size);
  for (int number = 1;; ++number)
    for (const auto& [name, write] : all) {
      write(folder / name, number);
      if (::write(pipe, "", 1) != 1) _exit(1);
    }
}

TEST(SafeFiles, KilledWritersLeaveWholeFiles) {
  const TemporaryFolder folder;
  constexpr std::uint32_t kSize = 3000;
  const auto all = writers(kSize);
  for (const auto& [name, write] : all) write(folder / name, 0);  // loads the module before the forks
  std::mt19937 generator(1);
  int num_within_rounds = 0;
  for (int kill = 0; kill < 200; ++kill) {
    std::array<int, 2> pipe{};
    ASSERT_EQ(::pipe(pipe.data()), 0);
    const pid_t child = fork();
    if (child == 0) writeForever(folder, kSize, pipe[1]);
    close(pipe[1]);
    // Some files on, however busy the machine is, and somewhere in the next one.
    char byte = 0;
    for (auto num_files = generator() % 10; num_files > 0; --num_files) ASSERT_EQ(read(pipe[0], &byte, 1), 1);
    std::this_thread::sleep_for(std::chrono::microseconds(generator() % 1000));
    ::kill(child, SIGKILL);
    ASSERT_EQ(waitpid(child, nullptr, 0), child);
    close(pipe[0]);
    std::set<int> numbers;
    for (const auto& [name, write] : all) {
      const int number = numberIn(folder / name, kSize);
      ASSERT_GE(number, 0) << name << " after kill " << kill;
      numbers.insert(number);
      write(folder / name, 0);
    }
    num_within_rounds += numbers.size() > 1;
  }
  EXPECT_GT(num_within_rounds, 50) << "the kills came while files were written";
}

/// The size of files is limited: the kernel then answers a write as on a full disk, with another error number.
TEST(SafeFiles, FullDisksLeaveTheOldFile) {
  const TemporaryFolder folder;
  constexpr std::uint32_t kSize = 3000;
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  const auto old_handler = std::signal(SIGXFSZ, SIG_IGN);
  for (const auto& [name, write] : writers(kSize)) {
    write(folder / name, 1);
    const std::uint64_t size = std::filesystem::file_size(folder / name);
    for (const std::uint64_t limit : {std::uint64_t{1}, std::uint64_t{100}, size / 2, size - 1}) {
      const rlimit full{limit, before.rlim_max};
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
      const std::string message = complaintOf<InputError>([&write = write, path = folder / name] { write(path, 7); });
      ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
      EXPECT_NE(message.find(name), std::string::npos)
          << name << ", " << limit << " bytes of " << size << ": " << message;
      EXPECT_EQ(numberIn(folder / name, kSize), 1) << name << ", " << limit << " bytes of " << size;
    }
  }
  std::signal(SIGXFSZ, old_handler);
  EXPECT_EQ(folder.names().size(), 5u) << "nothing half-written stays";
}

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
    cloud[i].x = 1e9f / 7.0f * static_cast<float>(i);
    cloud[i].y = 1e-20f / 3.0f;
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
