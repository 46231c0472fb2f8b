#include "io/cloud_fields.h"

#include <pcl/common/io.h>

#include <cstring>
#include <optional>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

namespace {

/// Three fields of floating point that hold a vector.
class VectorField {
public:
  static std::optional<VectorField> find(const pcl::PCLPointCloud2& cloud, const char* x, const char* y,
                                         const char* z) {
    VectorField vector;
    const char* names[3] = {x, y, z};
    for (int k = 0; k < 3; ++k) {
      const int index = pcl::getFieldIndex(cloud, names[k]);
      if (index < 0) return std::nullopt;
      vector.fields_[k] = cloud.fields[index];
      if (vector.fields_[k].datatype != pcl::PCLPointField::FLOAT32 &&
          vector.fields_[k].datatype != pcl::PCLPointField::FLOAT64)
        return std::nullopt;
    }
    return vector;
  }

  Eigen::Vector3d get(const std::uint8_t* point) const {
    Eigen::Vector3d value;
    for (int k = 0; k < 3; ++k) {
      if (fields_[k].datatype == pcl::PCLPointField::FLOAT64) {
        std::memcpy(&value[k], point + fields_[k].offset, sizeof(double));
      } else {
        float narrow;
        std::memcpy(&narrow, point + fields_[k].offset, sizeof(float));
        value[k] = narrow;
      }
    }
    return value;
  }

  void set(std::uint8_t* point, const Eigen::Vector3d& value) const {
    for (int k = 0; k < 3; ++k) {
      if (fields_[k].datatype == pcl::PCLPointField::FLOAT64) {
        std::memcpy(point + fields_[k].offset, &value[k], sizeof(double));
      } else {
        const auto narrow = static_cast<float>(value[k]);
        std::memcpy(point + fields_[k].offset, &narrow, sizeof(float));
      }
    }
  }

private:
  pcl::PCLPointField fields_[3];
};

std::size_t sizeOf(const pcl::PCLPointCloud2& cloud) {
  return static_cast<std::size_t>(cloud.width) * cloud.height;
}

}  // namespace

void movePoints(pcl::PCLPointCloud2& cloud, const Eigen::Affine3d& map, std::size_t first) {
  const auto apply = [&](const std::optional<VectorField>& field, const auto& move) {
    if (!field) return;
    for (std::size_t i = first; i < sizeOf(cloud); ++i) {
      std::uint8_t* point = cloud.data.data() + i * cloud.point_step;
      field->set(point, move(field->get(point)));
    }
  };
  const auto whole = [&](const Eigen::Vector3d& x) { return Eigen::Vector3d(map * x); };
  apply(VectorField::find(cloud, "x", "y", "z"), whole);
  apply(VectorField::find(cloud, "vp_x", "vp_y", "vp_z"), whole);
  apply(VectorField::find(cloud, "normal_x", "normal_y", "normal_z"),
        [&](const Eigen::Vector3d& n) { return Eigen::Vector3d(map.linear() * n); });
}

pcl::PCLPointCloud2 withFields(const pcl::PCLPointCloud2& cloud, const std::vector<std::string>& names,
                               const std::vector<std::vector<float>>& values) {
  if (names.empty()) return cloud;
  pcl::PCLPointCloud2 extra;
  extra.width = cloud.width;
  extra.height = cloud.height;
  extra.is_dense = cloud.is_dense;
  extra.is_bigendian = cloud.is_bigendian;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (pcl::getFieldIndex(cloud, names[k]) >= 0) throw InputError(names[k] + ": the cloud has a field of that name");
    pcl::PCLPointField field;
    field.name = names[k];
    field.offset = static_cast<std::uint32_t>(k * sizeof(float));
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    extra.fields.push_back(field);
  }
  extra.point_step = static_cast<std::uint32_t>(names.size() * sizeof(float));
  extra.row_step = extra.point_step * extra.width;
  extra.data.resize(sizeOf(extra) * extra.point_step);
  for (std::size_t k = 0; k < names.size(); ++k)
    for (std::size_t i = 0; i < sizeOf(extra); ++i)
      std::memcpy(extra.data.data() + i * extra.point_step + k * sizeof(float), &values[k][i], sizeof(float));
  pcl::PCLPointCloud2 output;
  if (!pcl::concatenateFields(cloud, extra, output)) throw InputError(names[0] + ": field could not be added");
  return output;
}

pcl::PCLPointCloud2 appendCopies(const pcl::PCLPointCloud2& cloud, const pcl::Indices& points,
                                 const std::string& field_name) {
  pcl::PCLPointCloud2 longer = cloud;
  longer.width = static_cast<std::uint32_t>(sizeOf(cloud) + points.size());
  longer.height = 1;
  longer.row_step = longer.point_step * longer.width;
  longer.data.resize(sizeOf(cloud) * cloud.point_step);
  longer.data.reserve(sizeOf(longer) * longer.point_step);
  for (const pcl::index_t i : points) {
    const auto point = cloud.data.begin() + static_cast<std::ptrdiff_t>(i) * cloud.point_step;
    longer.data.insert(longer.data.end(), point, point + cloud.point_step);
  }

  pcl::PCLPointCloud2 marks;
  pcl::PCLPointField field;
  field.name = field_name;
  field.datatype = pcl::PCLPointField::INT32;
  field.count = 1;
  marks.fields = {field};
  marks.width = longer.width;
  marks.height = 1;
  marks.is_dense = longer.is_dense;
  marks.is_bigendian = longer.is_bigendian;
  marks.point_step = sizeof(std::int32_t);
  marks.row_step = marks.point_step * marks.width;
  marks.data.resize(marks.row_step);
  for (std::size_t i = 0; i < sizeOf(longer); ++i) {
    const std::int32_t mark = i < sizeOf(cloud) ? -1 : static_cast<std::int32_t>(points[i - sizeOf(cloud)]);
    std::memcpy(marks.data.data() + i * sizeof(mark), &mark, sizeof(mark));
  }
  pcl::PCLPointCloud2 marked;
  if (!pcl::concatenateFields(longer, marks, marked)) throw InputError(field_name + ": field could not be added");
  return marked;
}

}  // namespace pcl_symmetry::apps
