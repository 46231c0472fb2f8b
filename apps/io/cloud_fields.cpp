#include "io/cloud_fields.h"

#include <pcl/common/io.h>
#include <pcl/type_traits.h>

#include <cstring>

#include "command_line/tool_errors.h"
#include "io/cloud_file.h"

namespace pcl_symmetry::apps {

namespace {

std::size_t sizeOf(const pcl::PCLPointCloud2& cloud) {
  return static_cast<std::size_t>(cloud.width) * cloud.height;
}

/// The cloud with one more field of four bytes for each name.
template <typename Value>
pcl::PCLPointCloud2 joined(const pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                           const std::vector<std::vector<Value>>& values) {
  if (names.empty()) return cloud;
  pcl::PCLPointCloud2 extra;
  extra.is_dense = cloud.is_dense;
  extra.is_bigendian = cloud.is_bigendian;
  for (const std::string& name : names) {
    if (pcl::getFieldIndex(cloud, name) >= 0) throw InputError(name + ": the cloud has a field of that name");
    Column column{name, pcl::traits::asEnum<Value>::value, 1, sizeof(Value), 0, -1};
    addField(column, extra);
  }
  makeRoom(cloud.width, cloud.height, extra);
  for (std::size_t k = 0; k < names.size(); ++k)
    for (std::size_t i = 0; i < sizeOf(extra); ++i)
      std::memcpy(&extra.data[i * extra.point_step + k * sizeof(Value)], &values[k][i], sizeof(Value));
  pcl::PCLPointCloud2 output;
  if (!pcl::concatenateFields(cloud, extra, output)) throw InputError(names[0] + ": field could not be added");
  return output;
}

}  // namespace

VectorField::VectorField(const pcl::PCLPointCloud2& cloud, const std::array<const char*, 3>& names)
    : point_step_(cloud.point_step) {
  for (std::size_t k = 0; k < 3; ++k) {
    const int index = pcl::getFieldIndex(cloud, names[k]);
    if (index < 0) return;
    offsets_[k] = cloud.fields[index].offset;
    is_double_[k] = cloud.fields[index].datatype == pcl::PCLPointField::FLOAT64;
    if (!is_double_[k] && cloud.fields[index].datatype != pcl::PCLPointField::FLOAT32) return;
  }
  is_there_ = true;
}

Eigen::Vector3d VectorField::get(const pcl::PCLPointCloud2& cloud, std::size_t i) const {
  Eigen::Vector3d value;
  for (int k = 0; k < 3; ++k)
    value[k] = numberAt(&cloud.data[i * point_step_ + offsets_[k]],
                        is_double_[k] ? pcl::PCLPointField::FLOAT64 : pcl::PCLPointField::FLOAT32);
  return value;
}

void VectorField::set(pcl::PCLPointCloud2& cloud, std::size_t i, const Eigen::Vector3d& value) const {
  for (int k = 0; k < 3; ++k) {
    const auto narrow = static_cast<float>(value[k]);
    std::uint8_t* const target = &cloud.data[i * point_step_ + offsets_[k]];
    if (is_double_[k])
      std::memcpy(target, &value[k], sizeof(double));
    else
      std::memcpy(target, &narrow, sizeof(float));
  }
}

pcl::Indices finiteIndices(const pcl::PCLPointCloud2& cloud) {
  const VectorField position(cloud);
  pcl::Indices finite;
  for (std::size_t i = 0; i < sizeOf(cloud); ++i)
    if (!position.isThere() || position.get(cloud, i).allFinite()) finite.push_back(static_cast<pcl::index_t>(i));
  return finite;
}

void movePoints(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map, std::size_t first) {
  const auto apply = [&](const std::array<const char*, 3>& names, const auto& move) {
    const VectorField field(cloud, names);
    for (std::size_t i = first; field.isThere() && i < sizeOf(cloud); ++i)
      field.set(cloud, i, move(field.get(cloud, i)));
  };
  const auto whole = [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(map * x); };
  apply({"x", "y", "z"}, whole);
  apply({"vp_x", "vp_y", "vp_z"}, whole);
  apply({"normal_x", "normal_y", "normal_z"},
        [&](const Eigen::Vector3d& n) { return Eigen::Vector3d(map.linear() * n); });
}

pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                               const std::vector<std::vector<float>>& values) {
  return joined(cloud, names, values);
}

pcl::PCLPointCloud2 withLabels(const pcl::PCLPointCloud2& cloud, const std::vector<int>& labels) {
  return joined<std::uint32_t>(cloud, {"label"}, {{labels.begin(), labels.end()}});
}

pcl::Indices labeledPoints(const pcl::PCLPointCloud2& cloud, int label) {
  const int field = pcl::getFieldIndex(cloud, "label");
  if (field < 0) throw std::invalid_argument("has no field label");
  pcl::Indices labeled;
  for (std::size_t i = 0; i < sizeOf(cloud); ++i)
    if (numberAt(&cloud.data[i * cloud.point_step + cloud.fields[field].offset], cloud.fields[field].datatype) == label)
      labeled.push_back(static_cast<pcl::index_t>(i));
  if (labeled.empty()) throw std::invalid_argument("has no point with the label " + std::to_string(label));
  return labeled;
}

pcl::PCLPointCloud2 appendCopies(const pcl::PCLPointCloud2& cloud, const pcl::Indices& points,
                                 const std::string& field_name) {
  pcl::Indices taken = finiteIndices(cloud);
  std::vector<std::int32_t> marks(taken.size(), -1), index_of(sizeOf(cloud), -1);
  for (std::size_t k = 0; k < taken.size(); ++k) index_of[taken[k]] = static_cast<std::int32_t>(k);
  for (const pcl::index_t i : points) {
    taken.push_back(i);
    marks.push_back(index_of[i]);
  }
  pcl::PCLPointCloud2 longer;
  pcl::copyPointCloud(cloud, taken, longer);
  return joined<std::int32_t>(longer, {field_name}, {marks});
}

}  // namespace pcl_symmetry::apps
