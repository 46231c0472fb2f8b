#include <gtest/gtest.h>
#include <pcl/io/pcd_io.h>

#include <cstring>
#include <limits>
#include <random>

#include "command_line/tool_errors.h"
#include "io/shape_readers.h"
#include "shapes/temporary_folder.h"

namespace {

using namespace pcl_symmetry::apps;

pcl::PointCloud<pcl::PointXYZRGBNormal> coloured() {
  pcl::PointCloud<pcl::PointXYZRGBNormal> cloud(4, 3);
  std::mt19937 generator(2);
  std::normal_distribution<float> normal;
  for (auto& point : cloud) {
    point.getVector3fMap() = Eigen::Vector3f(normal(generator), 1e-20f * normal(generator), 1e9f * normal(generator));
    point.getNormalVector3fMap().setConstant(normal(generator));
    point.r = static_cast<std::uint8_t>(generator());
    point.curvature = normal(generator);
  }
  cloud[5].x = std::numeric_limits<float>::quiet_NaN();
  cloud.sensor_origin_ = Eigen::Vector4f(1, 2, 3, 0);
  cloud.sensor_orientation_ = Eigen::Quaternionf(0.5f, 0.5f, -0.5f, 0.5f);
  return cloud;
}

const pcl::PCLPointField* fieldOf(const pcl::PCLPointCloud2& cloud, const std::string& name) {
  for (const pcl::PCLPointField& field : cloud.fields)
    if (field.name == name) return &field;
  return nullptr;
}

/// PCL reads the same values from the file.
void expectAsPCL(const std::string& path) {
  pcl::PCLPointCloud2 expected;
  Eigen::Vector4f origin;
  Eigen::Quaternionf orientation;
  int version = 0;
  ASSERT_EQ(pcl::PCDReader().read(path, expected, origin, orientation, version), 0);
  const CloudFile read = readPCD(path, contentOf(path));
  EXPECT_EQ(read.sensor_origin.head<3>(), origin.head<3>());
  EXPECT_EQ(read.sensor_orientation.coeffs(), orientation.coeffs());
  ASSERT_EQ(read.cloud.width, expected.width);
  ASSERT_EQ(read.cloud.height, expected.height);
  EXPECT_EQ(read.cloud.is_dense, expected.is_dense);
  for (const pcl::PCLPointField& field : expected.fields) {
    if (field.name == "_") continue;
    const pcl::PCLPointField* mine = fieldOf(read.cloud, field.name);
    ASSERT_TRUE(mine) << field.name;
    EXPECT_EQ(mine->datatype, field.datatype);
    EXPECT_EQ(mine->count, field.count);
    const std::size_t size = field.count * static_cast<std::size_t>(pcl::getFieldSize(field.datatype));
    for (std::size_t i = 0; i < std::size_t{expected.width} * expected.height; ++i)
      ASSERT_EQ(std::memcmp(&read.cloud.data[i * read.cloud.point_step + mine->offset],
                            &expected.data[i * expected.point_step + field.offset], size),
                0)
          << path << ": " << field.name << " of point " << i;
  }
}

TEST(ReadPCD, ReadsWhatPCLReads) {
  const TemporaryFolder folder;
  pcl::io::savePCDFileASCII(folder / "ascii.pcd", coloured());
  pcl::io::savePCDFileBinary(folder / "binary.pcd", coloured());
  pcl::io::savePCDFileBinaryCompressed(folder / "compressed.pcd", coloured());
  for (const char* name : {"ascii.pcd", "binary.pcd", "compressed.pcd"}) expectAsPCL(folder / name);
  folder.write("padded.pcd",
               "VERSION 0.7\nFIELDS x _ y z\nSIZE 4 1 4 4\nTYPE F U F F\nCOUNT 1 3 1 1\nWIDTH 1\nHEIGHT "
               "1\nPOINTS 1\nDATA binary\n" +
                   std::string("\0\0\200?...\0\0\0@\0\0@@", 15));
  const CloudFile padded = readPCD("padded.pcd", contentOf(folder / "padded.pcd"));
  EXPECT_EQ(padded.cloud.point_step, 12u);
  float xyz[3];
  std::memcpy(xyz, padded.cloud.data.data(), sizeof(xyz));
  EXPECT_EQ(Eigen::Vector3f(xyz[0], xyz[1], xyz[2]), Eigen::Vector3f(1, 2, 3));
}

TEST(ReadPCD, ReadsIntegersOfEverySizeAndSeveralValues) {
  const TemporaryFolder folder;
  const std::string path = folder.write(
      "a.pcd",
      "VERSION 0.7\nFIELDS x y z i u big pair\nSIZE 4 4 4 1 2 8 4\nTYPE F F F I U U U\nCOUNT 1 1 1 1 1 1 2\nWIDTH 1\n"
      "HEIGHT 1\nPOINTS 1\nDATA ascii\n+1 2.5e0 nan -128 65535 18446744073709551615 7 4294967295\n");
  const pcl::PCLPointCloud2 cloud = readPCD(path, contentOf(path)).cloud;
  EXPECT_FALSE(cloud.is_dense);
  const auto at = [&](const char* name) { return cloud.data.data() + fieldOf(cloud, name)->offset; };
  EXPECT_EQ(*reinterpret_cast<const std::int8_t*>(at("i")), -128);
  std::uint16_t u;
  std::memcpy(&u, at("u"), 2);
  EXPECT_EQ(u, 65535);
  std::uint64_t big;
  std::memcpy(&big, at("big"), 8);
  EXPECT_EQ(big, std::numeric_limits<std::uint64_t>::max());
  std::uint32_t pair[2];
  std::memcpy(pair, at("pair"), 8);
  EXPECT_EQ(pair[0], 7u);
  EXPECT_EQ(pair[1], 4294967295u);
}

/// Fields so many and so large that the size of all points does not fit into 64 bits: 8192 times 2^20 values of eight
/// bytes, times 2^28 points, are 2^64 bytes, which is 0 where it is not looked at.
TEST(ReadPCD, RefusesSizesBeyondAllNumbers) {
  const TemporaryFolder folder;
  for (const bool is_padding : {true, false}) {
    std::string fields = "FIELDS x y z", sizes = "SIZE 4 4 4", types = "TYPE F F F", counts = "COUNT 1 1 1";
    for (int i = 0; i < 8192; ++i) {
      fields += is_padding ? " _" : " f" + std::to_string(i);
      sizes += " 8";
      types += " F";
      counts += " 1048576";
    }
    for (const std::string data : {"ascii", "binary", "binary_compressed"}) {
      const std::string header = "VERSION 0.7\n" + fields + "\n" + sizes + "\n" + types + "\n" + counts;
      // Compressed: the size that is said is the product of the fields x, y and z with the number of points, modulo
      // 2^64.
      const std::string body =
          data == "binary_compressed" ? std::string("\x08\0\0\0\0\0\0\xc0........", 16) : std::string(1000, ' ');
      const std::string path =
          folder.write("a.pcd", header + "\nWIDTH 268435456\nHEIGHT 1\nPOINTS 268435456\nDATA " + data + "\n" + body);
      EXPECT_THROW(readPCD(path, contentOf(path)), InputError) << data;
    }
  }
}

}  // namespace
