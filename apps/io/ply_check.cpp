#include "io/ply_check.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <map>
#include <optional>
#include <set>

#include "io/header_lines.h"

namespace pcl_symmetry::apps {

namespace {

struct PLYProperty {
  std::string name;
  std::size_t size = 0;             ///< bytes of the value, or of one entry of a list
  bool integer = false;             ///< of the value, or of one entry of a list
  std::size_t list_count_size = 0;  ///< bytes of a list's length; 0 = no list
};

struct PLYElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PLYProperty> properties;
};

struct PLYHeader {
  std::string format;
  std::vector<PLYElement> elements;
  std::size_t body = 0;
  std::optional<std::int64_t> num_columns, num_rows;  ///< of a range image
};

struct PLYScalar {
  std::size_t size;
  bool integer;
};

PLYScalar scalarType(const std::string& path, const std::string& type) {
  static const std::map<std::string, PLYScalar> types = {
      {"char", {1, true}},   {"int8", {1, true}},     {"uchar", {1, true}},   {"uint8", {1, true}},
      {"short", {2, true}},  {"int16", {2, true}},    {"ushort", {2, true}},  {"uint16", {2, true}},
      {"int", {4, true}},    {"int32", {4, true}},    {"uint", {4, true}},    {"uint32", {4, true}},
      {"float", {4, false}}, {"float32", {4, false}}, {"double", {8, false}}, {"float64", {8, false}}};
  const auto entry = types.find(type);
  if (entry == types.end()) reject(path, "unknown PLY type " + type.substr(0, 40));
  return entry->second;
}

PLYProperty parseProperty(const std::string& path, const Words& words) {
  if (words.size() == 5 && words[1] == "list") {
    const PLYScalar count = scalarType(path, words[2]), value = scalarType(path, words[3]);
    if (!count.integer) reject(path, "length of list " + words[4] + " has type " + words[2] + ", must be an integer");
    return {words[4], value.size, value.integer, count.size};
  }
  if (words.size() != 3) reject(path, "malformed PLY property");
  const PLYScalar value = scalarType(path, words[1]);
  return {words[2], value.size, value.integer, 0};
}

/// The numbers are read as PCL reads them, which takes the last of several, and 0 where there is none.
void readPLYInfo(const Words& words, PLYHeader& header) {
  if (words.size() < 2) return;
  const int number = words.size() > 2 ? std::atoi(words[2].c_str()) : 0;
  if (words[1] == "num_cols") header.num_columns = number;
  if (words[1] == "num_rows") header.num_rows = number;
}

PLYHeader readPLYHeader(const std::string& path, std::string_view text) {
  PLYHeader header;
  LineReader lines(text);
  std::string_view line;
  if (!lines.next(line) || line != "ply") reject(path, "does not begin with ply");
  while (lines.next(line)) {
    if (!isPrintable(line)) reject(path, "PLY header ends before end_header");
    const Words words = split(line);
    // PCL ends the program where such a line begins with a blank.
    if (!words.empty() && words[0] == "obj_info" && line.front() != 'o')
      reject(path, "PLY header line obj_info begins with a blank");
    if (!words.empty() && words[0] == "obj_info") readPLYInfo(words, header);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() == 3) {
      header.format = words[1];
      if (words[2] != "1.0") reject(path, "PLY version = " + words[2] + ", must be 1.0");
    } else if (words[0] == "element" && words.size() == 3) {
      header.elements.push_back({words[1], headerCount(path, "element " + words[1], words[2], kMaxPoints), {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(parseProperty(path, words));
    } else if (words[0] == "end_header") {
      header.body = lines.position();
      return header;
    } else {
      reject(path, "malformed PLY header line '" + std::string(line.substr(0, 40)) + "'");
    }
  }
  reject(path, "PLY header ends before end_header");
}

/// PCL takes the second of two equal names for the first one.
void checkPLYNames(const std::string& path, const PLYHeader& header) {
  std::set<std::string> elements;
  for (const PLYElement& element : header.elements) {
    if (!elements.insert(element.name).second) reject(path, "element " + element.name + " stands twice");
    std::set<std::string> properties;
    for (const PLYProperty& property : element.properties)
      if (!properties.insert(property.name).second)
        reject(path, "property " + property.name + " of " + element.name + " stands twice");
  }
}

/// PCL makes as many points as obj_info says, and ends the program where that is fewer than the vertices.
void checkPLYGrid(const std::string& path, const PLYHeader& header, std::uint64_t num_vertices) {
  if (!header.num_columns && !header.num_rows) return;
  const std::int64_t num_columns = header.num_columns.value_or(static_cast<std::int64_t>(num_vertices)),
                     num_rows = header.num_rows.value_or(1);
  const std::int64_t num_cells = num_columns * num_rows;
  const auto has_all_cells = [&](const PLYElement& element) {
    return (element.name == "vertex" || element.name == "range_grid") &&
           element.count == static_cast<std::uint64_t>(num_cells) && element.count >= num_vertices;
  };
  if (num_columns > 0 && std::any_of(header.elements.begin(), header.elements.end(), has_all_cells)) return;
  reject(path, "obj_info num_cols x num_rows = " + std::to_string(num_columns) + " x " + std::to_string(num_rows) +
                   ", must be the number of vertices or of range_grid");
}

void checkPLYHeader(const std::string& path, const PLYHeader& header, std::uint64_t available) {
  checkPLYNames(path, header);
  if (header.format != "ascii" && header.format != "binary_little_endian" && header.format != "binary_big_endian") {
    reject(path, "PLY format = " + header.format + ", must be ascii, binary_little_endian or binary_big_endian");
  }
  const auto vertex = std::find_if(header.elements.begin(), header.elements.end(),
                                   [](const PLYElement& element) { return element.name == "vertex"; });
  if (vertex == header.elements.end()) reject(path, "has no element vertex");
  if (vertex->count == 0) reject(path, "element vertex = 0, must be > 0");
  checkPLYGrid(path, header, vertex->count);
  for (const char* name : {"x", "y", "z"}) {
    const auto property = std::find_if(vertex->properties.begin(), vertex->properties.end(),
                                       [&](const PLYProperty& candidate) { return candidate.name == name; });
    if (property == vertex->properties.end()) {
      reject(path, "has no vertex property " + std::string(name) + ", must have x, y and z");
    }
    if (property->integer || property->list_count_size) {
      reject(path, "vertex property " + std::string(name) + " must be float or double");
    }
  }
  for (const PLYProperty& property : vertex->properties)
    if (property.list_count_size) reject(path, "vertex property " + property.name + " is a list, must be a number");
  std::uint64_t least = 0;
  for (const PLYElement& element : header.elements) {
    if (element.properties.empty() && element.count > 0) reject(path, "element " + element.name + " has no property");
    std::uint64_t size = 0;
    for (const PLYProperty& property : element.properties) {
      if (header.format == "ascii") {
        size += 2;
      } else {
        size += property.list_count_size ? property.list_count_size : property.size;
      }
    }
    least += size * element.count;
    if (least > available + 1) {
      reject(path, "element " + element.name + " = " + std::to_string(element.count) + ", but only " +
                       std::to_string(available) + " bytes follow the header");
    }
  }
}

/// Steps through the values of a PLY body, as text or as bytes of either order.
class PLYBody {
public:
  PLYBody(const std::string& path, std::string_view body, const std::string& format)
      : path_(path), body_(body), tokens_(body, path), text_(format == "ascii"), big_(format == "binary_big_endian") {}

  void skip(const PLYElement& element, std::uint64_t index, std::size_t size, std::uint64_t count) {
    if (text_) {
      for (std::uint64_t i = 0; i < count; ++i) tokens_.number(label(element), index);
      return;
    }
    if (count > (body_.size() - position_) / size) {
      reject(path_, element.name + " " + std::to_string(index) + " is missing, the file ends before it");
    }
    position_ += count * size;
  }

  std::uint64_t length(const PLYElement& element, std::uint64_t index, std::size_t size) {
    if (text_) return tokens_.count(label(element), index, body_.size());
    const std::size_t begin = position_;
    skip(element, index, size, 1);
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < size; ++i) {
      const std::size_t at = begin + (big_ ? i : size - 1 - i);
      value = value << 8 | static_cast<unsigned char>(body_[at]);
    }
    return value;
  }

  /// \return the value of a float or double property; binary integers are passed over and read as zero.
  double scalar(const PLYElement& element, std::uint64_t index, const PLYProperty& property) {
    if (text_) return tokens_.number(label(element), index);
    const std::size_t begin = position_;
    skip(element, index, property.size, 1);
    if (property.integer) return 0;
    std::array<char, 8> bytes{};
    std::copy_n(body_.data() + begin, property.size, bytes.begin());
    if (big_) std::reverse(bytes.begin(), bytes.begin() + property.size);
    float single = 0;
    double value = 0;
    std::memcpy(&single, bytes.data(), 4);
    std::memcpy(&value, bytes.data(), 8);
    return property.size == 4 ? single : value;
  }

  bool isText() const { return text_; }

private:
  const char* label(const PLYElement& element) {
    label_ = "a value of " + element.name;
    return label_.c_str();
  }

  const std::string& path_;
  std::string_view body_;
  TokenReader tokens_;
  bool text_, big_;
  std::size_t position_ = 0;
  std::string label_;
};

/// Reads the camera element as PCL writes it: the rows of the rotation are called x, y and z axis.
void readCamera(PLYBody& body, const PLYElement& element, PLYSummary& summary) {
  std::map<std::string, double> values;
  for (const PLYProperty& property : element.properties) values[property.name] = body.scalar(element, 0, property);
  Eigen::Vector3d origin;
  Eigen::Matrix3d rotation;
  for (int k = 0; k < 3; ++k) {
    const std::string axis(1, "xyz"[k]);
    origin[k] = values["view_p" + axis];
    for (int j = 0; j < 3; ++j) rotation(k, j) = values[axis + "_axis" + "xyz"[j]];
  }
  if (!origin.allFinite() || !rotation.isUnitary(1e-3) || rotation.determinant() < 0) return;
  summary.sensor_origin.head<3>() = origin.cast<float>();
  summary.sensor_orientation = Eigen::Quaterniond(rotation).normalized().cast<float>();
}

/// Follows the body to its end.
PLYSummary readPLYBody(const std::string& path, const std::string& text, const PLYHeader& header) {
  PLYBody body(path, std::string_view(text).substr(header.body), header.format);
  PLYSummary summary;
  for (const PLYElement& element : header.elements) {
    const bool scalars_only = std::none_of(element.properties.begin(), element.properties.end(),
                                           [](const PLYProperty& property) { return property.list_count_size > 0; });
    summary.has_faces |= element.name == "face" && element.count > 0 && !scalars_only;
    if (element.name == "camera" && element.count == 1 && scalars_only) {
      readCamera(body, element, summary);
      continue;
    }
    if (scalars_only && !body.isText()) {
      std::size_t size = 0;
      for (const PLYProperty& property : element.properties) size += property.size;
      if (size > 0) body.skip(element, 0, size, element.count);
      continue;
    }
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PLYProperty& property : element.properties) {
        const std::uint64_t count = property.list_count_size ? body.length(element, i, property.list_count_size) : 1;
        body.skip(element, i, property.size, count);
      }
    }
  }
  return summary;
}

}  // namespace

PLYSummary checkPLY(const std::string& path) {
  const std::string text = readWholeFile(path);
  const PLYHeader header = readPLYHeader(path, text);
  checkPLYHeader(path, header, text.size() - header.body);
  return readPLYBody(path, text, header);
}

bool isWholePLY(const std::string& path) {
  try {
    const std::string text = readWholeFile(path);
    readPLYBody(path, text, readPLYHeader(path, text));
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace pcl_symmetry::apps
