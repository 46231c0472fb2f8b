#include "io/cloud_file.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace pcl_symmetry::apps {

namespace {

template <typename Value>
Value nearestOf(double number) {
  if constexpr (std::is_floating_point_v<Value>) {
    return static_cast<Value>(number);
  } else {
    using Limits = std::numeric_limits<Value>;
    if (std::isnan(number)) return 0;
    if (number >= static_cast<double>(Limits::max())) return Limits::max();
    return number <= static_cast<double>(Limits::min()) ? Limits::min() : static_cast<Value>(number);
  }
}

bool isReal(std::uint8_t type) {
  return type == pcl::PCLPointField::FLOAT32 || type == pcl::PCLPointField::FLOAT64;
}

}  // namespace

void addField(Column& column, pcl::PCLPointCloud2& cloud) {
  const bool is_coordinate = column.name == "x" || column.name == "y" || column.name == "z";
  column.stored_type = column.type;
  if (is_coordinate && !isReal(column.type))
    column.stored_type = column.size > 2 ? pcl::PCLPointField::FLOAT64 : pcl::PCLPointField::FLOAT32;
  column.offset = cloud.point_step;
  pcl::PCLPointField field;
  field.name = column.name;
  field.offset = cloud.point_step;
  field.datatype = column.stored_type;
  field.count = static_cast<pcl::uindex_t>(column.count);
  cloud.point_step += static_cast<pcl::uindex_t>(column.count) * pcl::getFieldSize(column.stored_type);
  cloud.fields.push_back(std::move(field));
}

void makeRoom(std::uint64_t width, std::uint64_t height, pcl::PCLPointCloud2& cloud) {
  cloud.width = static_cast<pcl::uindex_t>(width);
  cloud.height = static_cast<pcl::uindex_t>(height);
  cloud.row_step = cloud.point_step * cloud.width;
  cloud.data.resize(width * height * cloud.point_step);
}

std::optional<std::uint8_t> typeNamed(std::string name) {
  static const std::map<std::string, std::uint8_t> types = {
      {"char", pcl::PCLPointField::INT8},         {"int8", pcl::PCLPointField::INT8},
      {"uchar", pcl::PCLPointField::UINT8},       {"uint8", pcl::PCLPointField::UINT8},
      {"short", pcl::PCLPointField::INT16},       {"int16", pcl::PCLPointField::INT16},
      {"ushort", pcl::PCLPointField::UINT16},     {"uint16", pcl::PCLPointField::UINT16},
      {"int", pcl::PCLPointField::INT32},         {"int32", pcl::PCLPointField::INT32},
      {"uint", pcl::PCLPointField::UINT32},       {"uint32", pcl::PCLPointField::UINT32},
      {"long long", pcl::PCLPointField::INT64},   {"int64", pcl::PCLPointField::INT64},
      {"ulong long", pcl::PCLPointField::UINT64}, {"uint64", pcl::PCLPointField::UINT64},
      {"float", pcl::PCLPointField::FLOAT32},     {"float32", pcl::PCLPointField::FLOAT32},
      {"double", pcl::PCLPointField::FLOAT64},    {"float64", pcl::PCLPointField::FLOAT64}};
  boost::algorithm::to_lower(name);
  // Words of C, as in NRRD, and of MetaImage.
  for (const auto& [word, plain] : {std::pair("met_", ""), {"_", " "}, {" t", ""}, {"unsigned ", "u"}, {"signed ", ""}})
    boost::algorithm::replace_all(name, word, plain);
  if (boost::algorithm::ends_with(name, " int")) boost::algorithm::erase_tail(name, 4);
  const auto type = types.find(name);
  return type == types.end() ? std::nullopt : std::optional(type->second);
}

double numberAt(const void* source, std::uint8_t type) {
  return withType(type, [&](auto value) {
    std::memcpy(&value, source, sizeof(value));
    return static_cast<double>(value);
  });
}

bool storeNumber(std::string_view token, std::uint8_t type, void* target) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  return withType(type, [&](auto value) {
    // Read as the type itself: through double, a float would be rounded twice.
    const char* const end = token.data() + token.size();
    const auto [read, error] = std::from_chars(token.data(), end, value);
    if (error != std::errc() || read != end) {
      char* rest = nullptr;
      const std::string text(token);
      value = nearestOf<decltype(value)>(std::strtod(text.c_str(), &rest));
      if (text.empty() || rest != text.c_str() + text.size()) return false;
    }
    std::memcpy(target, &value, sizeof(value));
    return true;
  });
}

void storeValues(const Column& column, const void* source, std::uint8_t* point) {
  if (column.offset < 0) return;
  std::uint8_t* const target = point + column.offset;
  if (column.type == column.stored_type) {
    std::memcpy(target, source, column.count * column.size);
    return;
  }
  withType(column.stored_type, [&](auto value) {
    for (std::uint64_t k = 0; k < column.count; ++k) {
      const auto* const at = static_cast<const std::uint8_t*>(source) + k * column.size;
      value = nearestOf<decltype(value)>(numberAt(at, column.type));
      std::memcpy(target + k * sizeof(value), &value, sizeof(value));
    }
    return 0;
  });
}

bool isDense(const pcl::PCLPointCloud2& cloud) {
  const std::size_t num_points = std::size_t{cloud.width} * cloud.height;
  return std::all_of(cloud.fields.begin(), cloud.fields.end(), [&](const pcl::PCLPointField& field) {
    if (!isReal(field.datatype)) return true;
    const std::size_t size = pcl::getFieldSize(field.datatype);
    for (std::size_t i = 0; i < num_points; ++i)
      for (std::size_t k = 0; k < field.count; ++k)
        if (!std::isfinite(numberAt(&cloud.data[i * cloud.point_step + field.offset + k * size], field.datatype)))
          return false;
    return true;
  });
}

}  // namespace pcl_symmetry::apps
