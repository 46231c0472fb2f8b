#include "io/pcd_reader.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <map>

#include "io/header_lines.h"

namespace pcl_symmetry::apps {

namespace {

struct PCDHeader {
  std::map<std::string, Words> entries;
  std::size_t body = 0;

  const Words* find(const std::string& key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? nullptr : &entry->second;
  }
};

/// \return a * b, or the greatest number where the product does not fit.
std::uint64_t boundedProduct(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kGreatest = std::numeric_limits<std::uint64_t>::max();  // derived: of the type
  return b != 0 && a > kGreatest / b ? kGreatest : a * b;
}

PCDHeader readPCDHeader(const std::string& path, std::string_view text) {
  PCDHeader header;
  LineReader lines(text);
  std::string_view line;
  while (lines.next(line)) {
    if (!isPrintable(line)) reject(path, "has no PCD header");
    Words words = split(line);
    if (words.empty() || words[0][0] == '#') continue;
    std::string key = words[0];
    words.erase(words.begin());
    if (key == "COLUMNS") key = "FIELDS";
    static const char* const known[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                        "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    if (std::find(std::begin(known), std::end(known), key) == std::end(known)) {
      reject(path, header.entries.empty() ? "has no PCD header" : "unknown PCD header entry " + key.substr(0, 40));
    }
    if (!header.entries.emplace(key, words).second) reject(path, "PCD header entry " + key + " stands twice");
    if (words.empty()) reject(path, "PCD header entry " + key + " has no value");
    if (key == "DATA") {
      header.body = lines.position();
      return header;
    }
  }
  reject(path, header.entries.empty() ? "has no PCD header" : "PCD header ends before DATA");
}

/// A field of the cloud, and where its bytes stand in a point of a binary file, which may hold padding.
struct PCDField {
  pcl::PCLPointField field;
  std::uint64_t file_offset = 0;
  std::uint64_t size = 0;  ///< bytes of all its values
  bool padding = false;
};

struct PCDLayout {
  std::vector<PCDField> fields;
  std::uint64_t num_points = 0;
  std::uint64_t point_size = 0;
  std::uint64_t packed_size = 0;  ///< without padding fields
  std::uint64_t num_values = 0;
};

/// \param layout of the fields before.
PCDField fieldOf(const std::string& name, char type, std::uint64_t size, std::uint64_t count, const PCDLayout& layout) {
  PCDField result;
  result.field.name = name;
  result.field.offset = static_cast<pcl::uindex_t>(layout.packed_size);
  result.field.datatype = static_cast<std::uint8_t>(pcl::getFieldType(static_cast<int>(size), type));
  result.field.count = static_cast<pcl::uindex_t>(count);
  result.file_offset = layout.point_size;
  result.size = size * count;
  result.padding = name == "_";
  return result;
}

PCDLayout checkPCDFields(const std::string& path, const PCDHeader& header) {
  const Words* fields = header.find("FIELDS");
  const Words* sizes = header.find("SIZE");
  const Words* types = header.find("TYPE");
  const Words* counts = header.find("COUNT");
  if (!fields) reject(path, "PCD header has no FIELDS");
  if (!sizes) reject(path, "PCD header has no SIZE");
  if (!types) reject(path, "PCD header has no TYPE");
  const auto check_length = [&](const char* key, const Words& words) {
    if (words.size() != fields->size()) {
      reject(path, std::string(key) + " has " + std::to_string(words.size()) + " entries, must be " +
                       std::to_string(fields->size()) + ", one per field");
    }
  };
  check_length("SIZE", *sizes);
  check_length("TYPE", *types);
  if (counts) check_length("COUNT", *counts);

  PCDLayout layout;
  for (std::size_t i = 0; i < fields->size(); ++i) {
    const std::string& name = (*fields)[i];
    const std::string& type = (*types)[i];
    const std::uint64_t size = headerCount(path, "SIZE of " + name, (*sizes)[i], 8);
    const bool known = (type == "F" && (size == 4 || size == 8)) ||
                       ((type == "I" || type == "U") && (size == 1 || size == 2 || size == 4 || size == 8));
    if (!known && name != "_") {
      reject(path, "TYPE and SIZE of " + name + " = " + type + " " + (*sizes)[i] +
                       ", must be F 4, F 8, or I or U with 1, 2, 4 or 8");
    }
    const std::uint64_t count = counts ? headerCount(path, "COUNT of " + name, (*counts)[i], 1 << 20) : 1;
    if (count == 0) reject(path, "COUNT of " + name + " = 0, must be > 0");
    const bool coordinate = name == "x" || name == "y" || name == "z";
    if (coordinate && type != "F") reject(path, "TYPE of " + name + " = " + type + ", must be F");
    if (coordinate && count != 1) reject(path, "COUNT of " + name + " = " + std::to_string(count) + ", must be 1");
    if (std::count(fields->begin(), fields->end(), name) > 1 && name != "_")
      reject(path, "field " + name + " stands twice");
    layout.fields.push_back(fieldOf(name, type[0], size, count, layout));
    layout.point_size += size * count;
    layout.packed_size += name == "_" ? 0 : size * count;
    layout.num_values += count;
  }
  for (const char* name : {"x", "y", "z"}) {
    if (std::find(fields->begin(), fields->end(), name) == fields->end()) {
      reject(path, "has no field " + std::string(name) + ", must have x, y and z");
    }
  }
  return layout;
}

void checkPCDCounts(const std::string& path, const PCDHeader& header, PCDLayout& layout) {
  for (const char* key : {"WIDTH", "HEIGHT", "POINTS"}) {
    if (!header.find(key)) reject(path, "PCD header has no " + std::string(key));
  }
  const std::uint64_t width = headerCount(path, "WIDTH", header.find("WIDTH")->front(), kMaxPoints);
  const std::uint64_t height = headerCount(path, "HEIGHT", header.find("HEIGHT")->front(), kMaxPoints);
  layout.num_points = headerCount(path, "POINTS", header.find("POINTS")->front(), kMaxPoints);
  if (width * height != layout.num_points) {
    reject(path, "POINTS = " + std::to_string(layout.num_points) +
                     ", must be WIDTH * HEIGHT = " + std::to_string(width * height));
  }
  if (layout.num_points == 0) reject(path, "POINTS = 0, must be > 0");
  if (const Words* viewpoint = header.find("VIEWPOINT")) {
    double value = 0;
    if (viewpoint->size() != 7 || !std::all_of(viewpoint->begin(), viewpoint->end(), [&](const std::string& word) {
          return spellsNumber(word, &value) && std::isfinite(value);
        })) {
      reject(path, "VIEWPOINT must be seven finite numbers");
    }
  }
}

template <typename Value>
void store(Value value, std::uint8_t* target) {
  std::memcpy(target, &value, sizeof(value));
}

/// A whole number as it is, any other rounded towards zero and kept within the range of the type.
template <typename Integer>
void storeInteger(std::string_view token, std::uint8_t* target) {
  Integer value = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), value);
  if (error == std::errc() && end == token.data() + token.size()) return store(value, target);
  double real = 0.0;
  spellsNumber(token, &real);
  const double low = static_cast<double>(std::numeric_limits<Integer>::min());
  const double high = static_cast<double>(std::numeric_limits<Integer>::max());
  if (real >= high)
    value = std::numeric_limits<Integer>::max();
  else if (real > low)  // not for NaN
    value = static_cast<Integer>(real);
  else
    value = std::isnan(real) ? Integer{0} : std::numeric_limits<Integer>::min();
  store(value, target);
}

void storeFloat(std::string_view token, std::uint8_t* target) {
  float value = 0.0f;
  const std::string_view digits = !token.empty() && token[0] == '+' ? token.substr(1) : token;
  // Read as float, not through double, which would round twice.
  if (std::from_chars(digits.data(), digits.data() + digits.size(), value).ec == std::errc::result_out_of_range)
    value = std::strtof(std::string(digits).c_str(), nullptr);
  store(value, target);
}

/// \param token a number.
void storeNumber(std::string_view token, std::uint8_t datatype, std::uint8_t* target) {
  using Field = pcl::PCLPointField;
  double real = 0.0;
  switch (datatype) {
    case Field::FLOAT32:
      return storeFloat(token, target);
    case Field::FLOAT64:
      spellsNumber(token, &real);
      return store(real, target);
    case Field::INT8:
      return storeInteger<std::int8_t>(token, target);
    case Field::UINT8:
      return storeInteger<std::uint8_t>(token, target);
    case Field::INT16:
      return storeInteger<std::int16_t>(token, target);
    case Field::UINT16:
      return storeInteger<std::uint16_t>(token, target);
    case Field::INT32:
      return storeInteger<std::int32_t>(token, target);
    case Field::UINT32:
      return storeInteger<std::uint32_t>(token, target);
    case Field::INT64:
      return storeInteger<std::int64_t>(token, target);
    default:
      return storeInteger<std::uint64_t>(token, target);
  }
}

/// Reads the values of one line.
/// \return how many stand there, no more than one beyond those of a point are looked at.
std::uint64_t readRow(const std::string& path, std::string_view line, const PCDLayout& layout, std::uint64_t row,
                      std::uint8_t* point) {
  TokenReader tokens(line, path);
  std::uint64_t values = 0;
  std::size_t f = 0;
  std::uint64_t k = 0;  // of the values of field f
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next(), ++values) {
    if (!spellsNumber(token)) reject(path, "point " + std::to_string(row) + " holds a value that is not a number");
    if (values >= layout.num_values) continue;
    const PCDField& field = layout.fields[f];
    const std::uint64_t size = field.size / field.field.count;
    if (!field.padding) storeNumber(token, field.field.datatype, point + field.field.offset + k * size);
    if (++k == field.field.count) {
      ++f;
      k = 0;
    }
  }
  return values;
}

void readPCDText(const std::string& path, std::string_view body, const PCDLayout& layout, std::uint8_t* points) {
  LineReader lines(body);
  std::string_view line;
  std::uint64_t row = 0;
  while (row < layout.num_points && lines.next(line)) {
    const std::uint64_t values = readRow(path, line, layout, row, points + row * layout.packed_size);
    if (values == 0) continue;
    if (values != layout.num_values) {
      reject(path, "point " + std::to_string(row) + " has " + std::to_string(values) + " values, must be " +
                       std::to_string(layout.num_values));
    }
    ++row;
  }
  if (row < layout.num_points) {
    reject(path, "holds " + std::to_string(row) + " points, POINTS = " + std::to_string(layout.num_points));
  }
}

struct CompressedSizes {
  std::uint32_t compressed, uncompressed;  ///< bytes
};

/// The sizes of the compressed points, checked against each other.
CompressedSizes checkPCDSizes(const std::string& path, std::string_view body, const PCDLayout& layout) {
  if (body.size() < 8) reject(path, "ends before the sizes of the compressed points");
  std::uint32_t compressed = 0, uncompressed = 0;
  std::memcpy(&compressed, body.data(), 4);
  std::memcpy(&uncompressed, body.data() + 4, 4);
  if (compressed == 0 || compressed > body.size() - 8) {
    reject(path, "compressed size = " + std::to_string(compressed) +
                     ", must be > 0 and <= " + std::to_string(body.size() - 8) + ", the bytes that follow");
  }
  const std::uint64_t size = boundedProduct(layout.packed_size, layout.num_points);
  if (uncompressed != size) {
    reject(path, "uncompressed size = " + std::to_string(uncompressed) + ", must be " + std::to_string(size) +
                     ", the size of all points");
  }
  // derived: a back reference of three bytes stands for at most 264.
  constexpr std::uint64_t kMaxRatio = 88;
  if (uncompressed > kMaxRatio * compressed) reject(path, "the compressed points are damaged, too few bytes for them");
  return {compressed, uncompressed};
}

/// The LZF compression of PCD files: runs of bytes as they are, and references to bytes before, which may reach into
/// what they write. PCL's own decompression is in its library of files, which takes longer to load than planes take to
/// find; liblzf would be one more package for these lines.
/// \return whether all of \p target was written, and no byte beyond.
bool decompressLZF(std::string_view source, std::vector<std::uint8_t>& target) {
  std::size_t from = 0, to = 0;
  const auto next = [&] { return static_cast<std::uint8_t>(source[from++]); };
  while (from < source.size()) {
    const std::size_t control = next();
    if (control < 32) {  // a run of control + 1 bytes
      const std::size_t size = control + 1;
      if (size > source.size() - from || size > target.size() - to) return false;
      std::memcpy(&target[to], &source[from], size);
      from += size;
      to += size;
      continue;
    }
    // A reference: three bits of length, 7 standing for 7 and the next byte, and 13 bits of distance.
    std::size_t size = 2 + (control >> 5);
    if (size == 9 && from < source.size()) size += next();
    if (from == source.size()) return false;
    const std::size_t distance = ((control & 31u) << 8) + next() + 1;
    if (distance > to || size > target.size() - to) return false;
    for (; size > 0; --size, ++to) target[to] = target[to - distance];
  }
  return to == target.size();
}

void readPCDCompressed(const std::string& path, std::string_view body, const PCDLayout& layout, std::uint8_t* points) {
  const auto [compressed, uncompressed] = checkPCDSizes(path, body, layout);
  std::vector<std::uint8_t> columns(uncompressed);
  if (!decompressLZF(body.substr(8, compressed), columns)) reject(path, "the compressed points are damaged");
  const std::uint8_t* column = columns.data();
  for (const PCDField& field : layout.fields) {
    if (field.padding) continue;
    for (std::uint64_t i = 0; i < layout.num_points; ++i, column += field.size)
      std::memcpy(points + i * layout.packed_size + field.field.offset, column, field.size);
  }
}

void readPCDBinary(std::string_view body, const PCDLayout& layout, std::uint8_t* points) {
  for (std::uint64_t i = 0; i < layout.num_points; ++i)
    for (const PCDField& field : layout.fields)
      if (!field.padding)
        std::memcpy(points + i * layout.packed_size + field.field.offset,
                    body.data() + i * layout.point_size + field.file_offset, field.size);
}

template <typename Real>
bool allFinite(const pcl::PCLPointCloud2& cloud, const pcl::PCLPointField& field) {
  const std::size_t num_points = std::size_t{cloud.width} * cloud.height;
  for (std::size_t i = 0; i < num_points; ++i) {
    for (std::size_t k = 0; k < field.count; ++k) {
      Real value;
      std::memcpy(&value, &cloud.data[i * cloud.point_step + field.offset + k * sizeof(Real)], sizeof(Real));
      if (!std::isfinite(value)) return false;
    }
  }
  return true;
}

bool isDense(const pcl::PCLPointCloud2& cloud) {
  return std::all_of(cloud.fields.begin(), cloud.fields.end(), [&](const pcl::PCLPointField& field) {
    if (field.datatype == pcl::PCLPointField::FLOAT32) return allFinite<float>(cloud, field);
    if (field.datatype == pcl::PCLPointField::FLOAT64) return allFinite<double>(cloud, field);
    return true;
  });
}

/// An empty cloud of the layout; the pose of the sensor where the header has one.
PCDCloud emptyCloud(const PCDHeader& header, const PCDLayout& layout) {
  PCDCloud result;
  std::uint64_t width = 0, height = 0;
  spellsCount(header.find("WIDTH")->front(), &width);
  spellsCount(header.find("HEIGHT")->front(), &height);
  pcl::PCLPointCloud2& cloud = result.cloud;
  cloud.width = static_cast<pcl::uindex_t>(width);
  cloud.height = static_cast<pcl::uindex_t>(height);
  cloud.point_step = static_cast<pcl::uindex_t>(layout.packed_size);
  cloud.row_step = cloud.point_step * cloud.width;
  for (const PCDField& field : layout.fields)
    if (!field.padding) cloud.fields.push_back(field.field);
  cloud.data.resize(layout.packed_size * layout.num_points);
  if (const Words* viewpoint = header.find("VIEWPOINT")) {
    double v[7] = {};
    for (int k = 0; k < 7; ++k) spellsNumber((*viewpoint)[k], &v[k]);
    result.sensor_origin = Eigen::Vector4d(v[0], v[1], v[2], 0.0).cast<float>();
    result.sensor_orientation = Eigen::Quaterniond(v[3], v[4], v[5], v[6]).cast<float>();
  }
  return result;
}

}  // namespace

PCDCloud readPCD(const std::string& path) {
  const std::string text = readWholeFile(path);
  const PCDHeader header = readPCDHeader(path, text);
  PCDLayout layout = checkPCDFields(path, header);
  checkPCDCounts(path, header, layout);
  const std::string& data = header.find("DATA")->front();
  const std::string_view body = std::string_view(text).substr(header.body);
  const auto need = [&](std::uint64_t bytes) {
    if (body.size() < bytes) {
      reject(path, "holds " + std::to_string(body.size()) + " bytes of points, must be >= " + std::to_string(bytes) +
                       " for POINTS = " + std::to_string(layout.num_points));
    }
  };
  if (data == "ascii") need(boundedProduct(2 * layout.num_values, layout.num_points) - 1);
  if (data == "binary") need(boundedProduct(layout.point_size, layout.num_points));
  if (data == "binary_compressed") checkPCDSizes(path, body, layout);
  PCDCloud result = emptyCloud(header, layout);
  if (data == "ascii") {
    readPCDText(path, body, layout, result.cloud.data.data());
  } else if (data == "binary") {
    readPCDBinary(body, layout, result.cloud.data.data());
  } else if (data == "binary_compressed") {
    readPCDCompressed(path, body, layout, result.cloud.data.data());
  } else {
    reject(path, "DATA = " + data.substr(0, 40) + ", must be ascii, binary or binary_compressed");
  }
  result.cloud.is_dense = isDense(result.cloud);
  return result;
}

}  // namespace pcl_symmetry::apps
