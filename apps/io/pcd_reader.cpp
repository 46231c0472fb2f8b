#include "io/shape_readers.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

using Words = std::vector<std::string>;
using PCDHeader = std::map<std::string, Words>;

/// \return a * b, or the greatest number if the product does not fit.
std::uint64_t boundedProduct(std::uint64_t a, std::uint64_t b) {
  constexpr std::uint64_t kGreatest = std::numeric_limits<std::uint64_t>::max();
  return b != 0 && a > kGreatest / b ? kGreatest : a * b;
}

/// \param lines ends after the header.
PCDHeader readPCDHeader(const std::string& path, LineReader& lines) {
  PCDHeader header;
  std::string_view line;
  while (lines.next(line)) {
    if (!isPrintable(line)) reject(path, "has no PCD header");
    Words words = split(line);
    if (words.empty() || words[0][0] == '#') continue;
    const std::string key = words[0] == "COLUMNS" ? "FIELDS" : words[0];
    words.erase(words.begin());
    static const char* const known[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                        "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    if (std::find(std::begin(known), std::end(known), key) == std::end(known))
      reject(path, header.empty() ? "has no PCD header" : "unknown PCD header entry " + key.substr(0, 40));
    if (words.empty()) reject(path, "PCD header entry " + key + " has no value");
    if (!header.emplace(key, words).second) reject(path, "PCD header entry " + key + " stands twice");
    if (key == "DATA") return header;
  }
  reject(path, header.empty() ? "has no PCD header" : "PCD header ends before DATA");
}

const Words& pcdEntry(const std::string& path, const PCDHeader& header, const std::string& key) {
  const auto entry = header.find(key);
  if (entry == header.end()) reject(path, "PCD header has no " + key);
  return entry->second;
}

struct PCDLayout {
  std::vector<Column> columns;
  std::uint64_t num_points = 0;
  std::uint64_t point_size = 0;   ///< bytes of a point in a binary file
  std::uint64_t packed_size = 0;  ///< bytes of a point without padding
  std::uint64_t num_values = 0;   ///< values of a line of text
};

PCDLayout layoutOf(const std::string& path, const PCDHeader& header, pcl::PCLPointCloud2& cloud) {
  Words fields = pcdEntry(path, header, "FIELDS");
  for (std::string& field : fields)
    if (const std::string name = coordinateNamed(field); std::count(fields.begin(), fields.end(), name) == 0)
      field = name;
  const Words &sizes = pcdEntry(path, header, "SIZE"), &types = pcdEntry(path, header, "TYPE");
  const Words counts = header.count("COUNT") ? header.at("COUNT") : Words(fields.size(), "1");
  for (const auto& [key, words] : {std::pair("SIZE", &sizes), std::pair("TYPE", &types), std::pair("COUNT", &counts)})
    if (words->size() != fields.size())
      reject(path, std::string(key) + " has " + std::to_string(words->size()) + " entries, must be " +
                       std::to_string(fields.size()) + ", one per field");
  PCDLayout layout;
  for (std::size_t i = 0; i < fields.size(); ++i) {
    const std::string &name = fields[i], &type = types[i];
    Column column;
    column.name = name;
    column.size = headerCount(path, "SIZE of " + name, sizes[i], 8);
    column.count = headerCount(path, "COUNT of " + name, counts[i], 1 << 20);
    const bool is_padding = name == "_" || column.count == 0;
    const bool is_real = type == "F" && (column.size == 4 || column.size == 8);
    const bool is_whole = (type == "I" || type == "U") && column.size != 0 && (column.size & (column.size - 1)) == 0;
    if (!is_real && !is_whole && !is_padding)
      reject(path, "TYPE and SIZE of " + name + " = " + type + " " + sizes[i] +
                       ", must be F 4, F 8, or I or U with 1, 2, 4 or 8");
    const bool is_coordinate = name == "x" || name == "y" || name == "z";
    if (is_coordinate && column.count != 1) reject(path, "COUNT of " + name + " = " + counts[i] + ", must be 1");
    if (name != "_" && std::count(fields.begin(), fields.end(), name) > 1)
      reject(path, "field " + name + " stands twice");
    layout.point_size += column.size * column.count;
    layout.num_values += column.count;
    if (layout.point_size > kMaxPoints) reject(path, "SIZE and COUNT of a point are more than 2 GB");
    if (!is_padding) {
      column.type = static_cast<std::uint8_t>(pcl::getFieldType(static_cast<int>(column.size), type[0]));
      addField(column, cloud);
      layout.packed_size += column.size * column.count;
    }
    layout.columns.push_back(std::move(column));
  }
  for (const char* name : {"x", "y", "z"})
    if (std::find(fields.begin(), fields.end(), name) == fields.end())
      reject(path, "has no field " + std::string(name) + ", must have x, y and z");
  return layout;
}

void readViewpoint(const std::string& path, const Words& words, CloudFile& file) {
  double v[7] = {};
  bool is_whole = words.size() == 7;
  for (std::size_t k = 0; is_whole && k < 7; ++k) is_whole = spellsNumber(words[k], &v[k]) && std::isfinite(v[k]);
  if (!is_whole) reject(path, "VIEWPOINT must be seven finite numbers");
  file.sensor_origin = Eigen::Vector4d(v[0], v[1], v[2], 0.0).cast<float>();
  file.sensor_orientation = Eigen::Quaterniond(v[3], v[4], v[5], v[6]).cast<float>();
}

/// Stores the values of a line.
/// \return the number of values of the line.
std::uint64_t readPCDLine(const std::string& path, std::string_view line, const PCDLayout& layout, std::uint64_t row,
                          std::uint8_t* point) {
  TokenReader tokens(line, path);
  std::uint64_t num_values = 0, k = 0;
  auto column = layout.columns.begin();
  double unused = 0.0;
  for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next(), ++num_values) {
    while (column != layout.columns.end() && k == column->count) {
      ++column;
      k = 0;
    }
    const bool is_stored = column != layout.columns.end() && column->offset >= 0;
    const bool is_number = is_stored ? storeNumber(token, column->stored_type,
                                                   point + column->offset + k * pcl::getFieldSize(column->stored_type))
                                     : spellsNumber(token, &unused);
    if (!is_number) reject(path, "point " + std::to_string(row) + " holds a value that is not a number");
    ++k;
  }
  return num_values;
}

void readPCDText(const std::string& path, std::string_view body, const PCDLayout& layout, pcl::PCLPointCloud2& cloud) {
  LineReader lines(body);
  std::string_view line;
  std::uint64_t row = 0;
  while (row < layout.num_points && lines.next(line)) {
    const std::uint64_t num_values = readPCDLine(path, line, layout, row, &cloud.data[row * cloud.point_step]);
    if (num_values == 0) continue;
    if (num_values != layout.num_values)
      reject(path, "point " + std::to_string(row) + " has " + std::to_string(num_values) + " values, must be " +
                       std::to_string(layout.num_values));
    ++row;
  }
  while (lines.next(line))
    if (!split(line).empty()) reject(path, "holds more points than POINTS = " + std::to_string(layout.num_points));
  if (row < layout.num_points)
    reject(path, "holds " + std::to_string(row) + " points, POINTS = " + std::to_string(layout.num_points));
}

/// Decompresses LZF: runs of literal bytes, and references to earlier bytes, which may overlap with the bytes that they
/// write. PCL's own function is in its library of files.
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
    // A reference: three bits of length, where 7 means that another byte follows, and 13 bits of distance.
    std::size_t size = 2 + (control >> 5);
    if (size == 9 && from < source.size()) size += next();
    if (from == source.size()) return false;
    const std::size_t distance = ((control & 31u) << 8) + next() + 1;
    if (distance > to || size > target.size() - to) return false;
    for (; size > 0; --size, ++to) target[to] = target[to - distance];
  }
  return to == target.size();
}

/// \return the points, all values of a field together.
std::vector<std::uint8_t> decompressed(const std::string& path, std::string_view body, const PCDLayout& layout) {
  if (body.size() < 8) reject(path, "ends before the sizes of the compressed points");
  std::uint32_t sizes[2];  // compressed and uncompressed size
  std::memcpy(sizes, body.data(), 8);
  if (sizes[0] == 0 || sizes[0] > body.size() - 8)
    reject(path, "compressed size = " + std::to_string(sizes[0]) +
                     ", must be > 0 and <= " + std::to_string(body.size() - 8) + ", the bytes that follow");
  const std::uint64_t size = boundedProduct(layout.packed_size, layout.num_points);
  if (sizes[1] != size)
    reject(path, "uncompressed size = " + std::to_string(sizes[1]) + ", must be " + std::to_string(size) +
                     ", the size of all points");
  constexpr std::uint64_t kMaxRatio = 88;  // a reference of three bytes expands to at most 264
  if (sizes[1] > kMaxRatio * sizes[0]) reject(path, "the compressed points are damaged, too few bytes for them");
  std::vector<std::uint8_t> bytes(size);
  if (!decompressLZF(body.substr(8, sizes[0]), bytes)) reject(path, "the compressed points are damaged");
  return bytes;
}

}  // namespace

CloudFile readPCD(const std::string& path, std::string_view text) {
  LineReader lines(text);
  const PCDHeader header = readPCDHeader(path, lines);
  const std::string_view body = text.substr(lines.position());
  CloudFile file;
  PCDLayout layout = layoutOf(path, header, file.cloud);
  const auto count = [&](const char* key) {
    return headerCount(path, key, pcdEntry(path, header, key).front(), kMaxPoints);
  };
  const std::uint64_t width = count("WIDTH"), height = count("HEIGHT");
  layout.num_points = count("POINTS");
  if (width * height != layout.num_points)
    reject(path, "POINTS = " + std::to_string(layout.num_points) +
                     ", must be WIDTH * HEIGHT = " + std::to_string(width * height));
  if (layout.num_points == 0) reject(path, "POINTS = 0, must be > 0");
  if (header.count("VIEWPOINT")) readViewpoint(path, header.at("VIEWPOINT"), file);

  const std::string& data = header.at("DATA").front();
  const auto need = [&](std::uint64_t bytes) {
    if (body.size() < bytes)
      reject(path, "holds " + std::to_string(body.size()) + " bytes of points, must be >= " + std::to_string(bytes) +
                       " for POINTS = " + std::to_string(layout.num_points));
  };
  std::vector<std::uint8_t> bytes;  // decompressed points
  if (data == "ascii") {
    need(boundedProduct(2 * layout.num_values, layout.num_points) - 1);
  } else if (data == "binary") {
    const std::uint64_t size = boundedProduct(layout.point_size, layout.num_points);
    need(size);
    if (body.size() - size >= layout.point_size)
      reject(path, "holds more points than POINTS = " + std::to_string(layout.num_points));
  } else if (data == "binary_compressed") {
    bytes = decompressed(path, body, layout);
  } else {
    reject(path, "DATA = " + data.substr(0, 40) + ", must be ascii, binary or binary_compressed");
  }
  makeRoom(width, height, file.cloud);
  if (data == "ascii") readPCDText(path, body, layout, file.cloud);
  const char* source = data == "binary" ? body.data() : reinterpret_cast<const char*>(bytes.data());
  for (const Column& column : layout.columns) {
    if (data == "ascii" || (data == "binary_compressed" && column.offset < 0)) continue;
    const std::uint64_t size = column.size * column.count, step = data == "binary" ? layout.point_size : size;
    for (std::uint64_t i = 0; i < layout.num_points; ++i)
      storeValues(column, source + i * step, &file.cloud.data[i * file.cloud.point_step]);
    source += data == "binary" ? size : size * layout.num_points;
  }
  file.cloud.is_dense = isDense(file.cloud);
  return file;
}

}  // namespace pcl_symmetry::apps
