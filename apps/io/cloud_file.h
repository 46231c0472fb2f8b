/// A cloud as PCD and PLY files hold it, and the numbers that fill it.
#pragma once

#include <pcl/PCLPointCloud2.h>
#include <pcl/Vertices.h>

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace pcl_symmetry::apps {

struct CloudFile {
  pcl::PCLPointCloud2 cloud;            ///< fields without padding, one after the other
  std::vector<pcl::Vertices> polygons;  ///< polygons of three corners and more, indices checked
  std::vector<std::string> left_out;    ///< further content of the file, which is not read
  Eigen::Vector4f sensor_origin = Eigen::Vector4f::Zero();
  Eigen::Quaternionf sensor_orientation = Eigen::Quaternionf::Identity();
};

/// Values of each point in a file, and the field of the cloud that receives them. Types are those of
/// pcl::PCLPointField.
struct Column {
  std::string name;
  std::uint8_t type = 0;    ///< type in the file
  std::uint64_t count = 1;  ///< number of values per point
  std::uint64_t size = 0;   ///< bytes of a value in the file
  std::uint8_t stored_type = 0;
  std::ptrdiff_t offset = -1;  ///< offset in a point of the cloud; negative: the values are left out
};

/// Calls the function with a zero of the type.
template <typename Function>
auto withType(std::uint8_t type, const Function& function) {
  switch (type) {
    case pcl::PCLPointField::INT8:
      return function(std::int8_t{});
    case pcl::PCLPointField::UINT8:
      return function(std::uint8_t{});
    case pcl::PCLPointField::INT16:
      return function(std::int16_t{});
    case pcl::PCLPointField::UINT16:
      return function(std::uint16_t{});
    case pcl::PCLPointField::INT32:
      return function(std::int32_t{});
    case pcl::PCLPointField::UINT32:
      return function(std::uint32_t{});
    case pcl::PCLPointField::INT64:
      return function(std::int64_t{});
    case pcl::PCLPointField::UINT64:
      return function(std::uint64_t{});
    case pcl::PCLPointField::FLOAT32:
      return function(float{});
    default:
      return function(double{});
  }
}

/// \return the type of pcl::PCLPointField that a word of PLY, NRRD or MetaImage names, such as uchar, "unsigned char"
/// or MET_UCHAR.
std::optional<std::uint8_t> typeNamed(std::string name);

/// \return x, y or z if the name is that in capitals; otherwise the name.
inline std::string coordinateNamed(const std::string& name) {
  return name == "X" ? "x" : name == "Y" ? "y" : name == "Z" ? "z" : name;
}

/// Adds a field of the column's name, type and count to the cloud; x, y and z of whole numbers become float or double.
void addField(Column& column, pcl::PCLPointCloud2& cloud);

/// Gives the cloud memory for the points and sets its sizes; all values are zero.
void makeRoom(std::uint64_t width, std::uint64_t height, pcl::PCLPointCloud2& cloud);

/// \return a value of the type at any address, as double.
double numberAt(const void* source, std::uint8_t type);

/// Stores the number that the token holds; whole numbers are rounded toward zero and kept within the range of the type.
/// \return whether the token is a number.
bool storeNumber(std::string_view token, std::uint8_t type, void* target);

/// Copies the values of the column from a point of a file to a point of the cloud.
void storeValues(const Column& column, const void* source, std::uint8_t* point);

/// \return whether all values of all float and double fields are finite.
bool isDense(const pcl::PCLPointCloud2& cloud);

}  // namespace pcl_symmetry::apps
