#include "io/shape_readers.h"

#include <pcl/common/io.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <set>

#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

struct PLYProperty {
  std::string name;
  std::uint8_t type = 0;                    ///< type of the value, or of the entries of a list
  std::optional<std::uint8_t> length_type;  ///< type of the length of a list
};

struct PLYElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PLYProperty> properties;

  const PLYProperty* find(const std::string& property) const {
    const auto found = std::find_if(properties.begin(), properties.end(),
                                    [&](const PLYProperty& candidate) { return candidate.name == property; });
    return found == properties.end() ? nullptr : &*found;
  }
};

struct PLYHeader {
  std::string format;
  std::vector<PLYElement> elements;
  std::size_t body = 0;
};

std::uint64_t sizeOfType(std::uint8_t type) {
  return static_cast<std::uint64_t>(pcl::getFieldSize(type));
}

std::uint8_t plyType(const std::string& path, const std::string& word) {
  const std::optional<std::uint8_t> type = typeNamed(word);
  if (!type) reject(path, "unknown PLY type " + word.substr(0, 40));
  return *type;
}

void addPLYProperty(const std::string& path, const std::vector<std::string>& words, PLYElement& element) {
  const bool is_list = words.size() == 5 && words[1] == "list";
  if (words.size() != 3 && !is_list) reject(path, "malformed PLY property");
  PLYProperty property{words.back(), plyType(path, words[words.size() - 2]), std::nullopt};
  if (is_list) property.length_type = plyType(path, words[2]);
  if (element.find(property.name)) reject(path, "property " + property.name + " of " + element.name + " stands twice");
  element.properties.push_back(std::move(property));
}

PLYHeader readPLYHeader(const std::string& path, std::string_view text) {
  PLYHeader header;
  LineReader lines(text);
  std::string_view line;
  if (!lines.next(line) || line != "ply") reject(path, "does not begin with ply");
  std::set<std::string> names;
  while (lines.next(line)) {
    if (!isPrintable(line)) reject(path, "PLY header ends before end_header");
    const std::vector<std::string> words = split(line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "format" && words.size() == 3) {
      header.format = words[1];
      if (words[2] != "1.0") reject(path, "PLY version = " + words[2] + ", must be 1.0");
    } else if (words[0] == "element" && words.size() == 3) {
      if (!names.insert(words[1]).second) reject(path, "element " + words[1] + " stands twice");
      header.elements.push_back({words[1], headerCount(path, "element " + words[1], words[2], kMaxPoints), {}});
    } else if (words[0] == "property" && !header.elements.empty()) {
      addPLYProperty(path, words, header.elements.back());
    } else if (words[0] == "end_header") {
      header.body = lines.position();
      return header;
    } else {
      reject(path, "malformed PLY header line '" + std::string(line.substr(0, 40)) + "'");
    }
  }
  reject(path, "PLY header ends before end_header");
}

/// The values of a file in order, as text or as bytes of either order.
class PLYBody {
public:
  PLYBody(const std::string& path, std::string_view body, const std::string& format)
      : path_(path),
        body_(body),
        tokens_(body, path),
        is_text_(format == "ascii"),
        is_big_(format == "binary_big_endian") {
    if (!is_text_ && !is_big_ && format != "binary_little_endian")
      reject(path, "PLY format = " + format + ", must be ascii, binary_little_endian or binary_big_endian");
  }

  /// \return the least number of bytes of a value.
  std::uint64_t leastSize(std::uint8_t type) const { return is_text_ ? 2 : sizeOfType(type); }
  std::uint64_t size() const { return body_.size(); }
  /// \return whether more than a few bytes, such as the end of a line, follow.
  bool hasMore() { return is_text_ ? !tokens_.atEnd() : body_.size() - position_ > 4; }

  /// \return the bytes of the next value.
  const std::uint8_t* next(const PLYElement& element, std::uint64_t index, const PLYProperty& property,
                           std::uint8_t type) {
    if (is_text_) {
      const std::string_view token = tokens_.next();
      if (!storeNumber(token, type, value_.data()))
        tokens_.fail((property.name + " of " + element.name).c_str(), index, token, "must be a number");
      return value_.data();
    }
    const std::uint64_t size = sizeOfType(type);
    if (size > body_.size() - position_)
      reject(path_, property.name + " of " + element.name + " " + std::to_string(index) +
                        " is missing, the file ends before it");
    std::memcpy(value_.data(), &body_[position_], size);
    if (is_big_) std::reverse(value_.begin(), value_.begin() + size);
    position_ += size;
    return value_.data();
  }

  double number(const PLYElement& element, std::uint64_t index, const PLYProperty& property) {
    return number(element, index, property, property.type);
  }

  /// Calls use(number) for each entry of a list.
  template <typename Function>
  void list(const PLYElement& element, std::uint64_t index, const PLYProperty& property, const Function& use) {
    const double length = number(element, index, property, *property.length_type);
    if (!(length >= 0.0) || length != std::floor(length))
      reject(path_, "length of list " + property.name + " of " + element.name + " " + std::to_string(index) +
                        " must be a whole number >= 0");
    for (double k = 0; k < length; ++k) use(number(element, index, property));
  }

private:
  double number(const PLYElement& element, std::uint64_t index, const PLYProperty& property, std::uint8_t type) {
    if (is_text_) type = pcl::PCLPointField::FLOAT64;  // values that do not fit the type are noticed
    return numberAt(next(element, index, property, type), type);
  }

  const std::string& path_;
  std::string_view body_;
  TokenReader tokens_;
  bool is_text_, is_big_;
  std::size_t position_ = 0;
  std::array<std::uint8_t, 8> value_{};
};

class PLYReader {
public:
  PLYReader(const std::string& path, std::string_view text)
      : path_(path), header_(readPLYHeader(path, text)), body_(path, text.substr(header_.body), header_.format) {}

  CloudFile read() {
    makePoints();
    for (const PLYElement& element : header_.elements)
      if (element.name == "vertex")
        readVertices(element);
      else if (element.name == "camera" && element.count == 1)
        readCamera(element);
      else
        readLists(element);
    if (body_.hasMore()) reject(path_, "holds more than its header says");
    file_.cloud.is_dense = isDense(file_.cloud);
    return std::move(file_);
  }

private:
  /// Colors are bytes of one field, as in PCL.
  void addColor(const PLYElement& vertex, const std::string& prefix) {
    const char* const names[] = {"blue", "green", "red", "alpha"};
    const auto isByte = [&](const std::string& name) {
      const PLYProperty* const property = vertex.find(name);
      return property && property->type == pcl::PCLPointField::UINT8 && !property->length_type;
    };
    if (!isByte(prefix + "red") || !isByte(prefix + "green") || !isByte(prefix + "blue")) return;
    const bool has_alpha = isByte(names[3]);
    const std::uint8_t type = has_alpha ? pcl::PCLPointField::UINT32 : pcl::PCLPointField::FLOAT32;
    Column color{has_alpha ? "rgba" : "rgb", type, 1, 4, 0, -1};
    addField(color, file_.cloud);
    for (int k = 0; k < (has_alpha ? 4 : 3); ++k) colors_[(k < 3 ? prefix : "") + names[k]] = color.offset + k;
  }

  void makePoints() {
    const auto vertex = std::find_if(header_.elements.begin(), header_.elements.end(),
                                     [](const PLYElement& element) { return element.name == "vertex"; });
    if (vertex == header_.elements.end()) reject(path_, "has no element vertex");
    if (vertex->count == 0) reject(path_, "element vertex = 0, must be > 0");
    num_vertices_ = vertex->count;
    for (PLYProperty& property : vertex->properties)
      if (const std::string name = coordinateNamed(property.name); !vertex->find(name)) property.name = name;
    for (const char* name : {"x", "y", "z"})
      if (!vertex->find(name) || vertex->find(name)->length_type)
        reject(path_, "has no vertex property " + std::string(name) + ", must have x, y and z");
    std::uint64_t min_size = 0;
    for (const PLYProperty& property : vertex->properties) {
      min_size += body_.leastSize(property.length_type.value_or(property.type));
      Column column{property.name, property.type, 1, sizeOfType(property.type), property.type, -1};
      if (property.length_type)
        file_.left_out.push_back("list " + property.name + " of the vertices");
      else if (property.name == "red" || property.name == "diffuse_red")
        addColor(*vertex, property.name == "red" ? "" : "diffuse_");
      if (const auto color = colors_.find(property.name); color != colors_.end()) {
        column.offset = color->second;
      } else if (!property.length_type) {
        const bool is_normal = property.name.size() == 2 && property.name[0] == 'n' && property.name[1] >= 'x';
        if (is_normal && property.name[1] <= 'z') column.name = std::string("normal_") + property.name[1];
        if (property.name == "intensity" && property.type == pcl::PCLPointField::UINT8) {
          Column real{column.name, pcl::PCLPointField::FLOAT32, 1, 4, 0, -1};
          addField(real, file_.cloud);
          column.offset = real.offset;
          column.stored_type = pcl::PCLPointField::FLOAT32;
        } else {
          addField(column, file_.cloud);
        }
      }
      columns_.push_back(std::move(column));
    }
    if (num_vertices_ > (body_.size() + 1) / min_size)
      reject(path_, "element vertex = " + std::to_string(num_vertices_) + ", but only " + std::to_string(body_.size()) +
                        " bytes follow the header");
    makeRoom(num_vertices_, 1, file_.cloud);
  }

  void readVertices(const PLYElement& vertex) {
    for (std::uint64_t i = 0; i < vertex.count; ++i) {
      std::uint8_t* const point = &file_.cloud.data[i * file_.cloud.point_step];
      for (std::size_t k = 0; k < columns_.size(); ++k) {
        const PLYProperty& property = vertex.properties[k];
        if (property.length_type)
          body_.list(vertex, i, property, [](double) {});
        else
          storeValues(columns_[k], body_.next(vertex, i, property, property.type), point);
      }
    }
  }

  /// The rows of the rotation are the x, y and z axis.
  void readCamera(const PLYElement& camera) {
    std::map<std::string, double> values;
    for (const PLYProperty& property : camera.properties)
      if (property.length_type)
        body_.list(camera, 0, property, [](double) {});
      else
        values[property.name] = body_.number(camera, 0, property);
    Eigen::Vector3d origin;
    Eigen::Matrix3d rotation;
    for (int k = 0; k < 3; ++k) {
      const std::string axis(1, "xyz"[k]);
      origin[k] = values["view_p" + axis];
      for (int j = 0; j < 3; ++j) rotation(k, j) = values[axis + "_axis" + "xyz"[j]];
    }
    const double width = values["viewportx"], height = values["viewporty"];
    const bool is_grid = width == std::floor(width) && height == std::floor(height);
    if (is_grid && width >= 1.0 && width * height == static_cast<double>(num_vertices_))
      makeRoom(static_cast<std::uint64_t>(width), static_cast<std::uint64_t>(height), file_.cloud);
    if (!origin.allFinite() || !rotation.isUnitary(1e-3) || rotation.determinant() < 0) return;
    file_.sensor_origin.head<3>() = origin.cast<float>();
    file_.sensor_orientation = Eigen::Quaterniond(rotation).normalized().cast<float>();
  }

  /// Reads faces and strips of triangles; other elements are skipped.
  void readLists(const PLYElement& element) {
    const bool is_strip = element.name == "tristrips";
    const PLYProperty* corners = element.name == "face" || is_strip ? element.find("vertex_indices") : nullptr;
    if (!corners && element.name == "face") corners = element.find("vertex_index");
    if (corners && !corners->length_type) corners = nullptr;
    if (element.properties.empty()) return;
    // A range_grid of Stanford's scans tells which pixels have points.
    if (!corners && element.count > 0 && element.name != "range_grid")
      file_.left_out.push_back(std::to_string(element.count) + " of element " + element.name);
    std::vector<pcl::index_t> indices;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      for (const PLYProperty& property : element.properties) {
        if (!property.length_type) {
          body_.next(element, i, property, property.type);
        } else if (&property != corners) {
          body_.list(element, i, property, [](double) {});
        } else {
          indices.clear();
          body_.list(element, i, property, [&](double index) {
            const bool ends_strip = is_strip && index == -1.0;
            const bool is_index =
                index >= 0.0 && index < static_cast<double>(num_vertices_) && index == std::floor(index);
            if (!ends_strip && !is_index) rejectCorner(element, i, index);
            indices.push_back(static_cast<pcl::index_t>(index));
          });
          addPolygons(indices, is_strip);
        }
      }
    }
  }

  [[noreturn]] void rejectCorner(const PLYElement& element, std::uint64_t i, double index) const {
    char number[32];
    std::snprintf(number, sizeof(number), "%.10g", index);
    reject(path_, "a corner of " + element.name + " " + std::to_string(i) + " = " + number + ", must be >= 0 and < " +
                      std::to_string(num_vertices_) + ", the number of vertices");
  }

  void addPolygons(const std::vector<pcl::index_t>& indices, bool is_strip) {
    const auto add = [&](std::vector<pcl::index_t> corners) {
      if (corners.size() < 3) return;
      file_.polygons.emplace_back();
      file_.polygons.back().vertices = std::move(corners);
    };
    if (!is_strip) return add(indices);
    std::size_t begin = 0;  // begin of the strip; -1 ends a strip
    for (std::size_t k = 0; k < indices.size(); ++k) {
      if (indices[k] < 0) begin = k + 1;
      if (k < begin + 2) continue;
      const bool is_odd = (k - begin) % 2 == 1;
      const pcl::index_t a = indices[k - 2], b = indices[k - 1], c = indices[k];
      if (a != b && b != c && c != a) add({is_odd ? b : a, is_odd ? a : b, c});
    }
  }

  const std::string& path_;
  PLYHeader header_;
  PLYBody body_;
  CloudFile file_;
  std::uint64_t num_vertices_ = 0;
  std::vector<Column> columns_;                   // columns of the vertices
  std::map<std::string, std::ptrdiff_t> colors_;  // offsets of the bytes of the colors
};

}  // namespace

CloudFile readPLY(const std::string& path, std::string_view text) {
  return PLYReader(path, text).read();
}

}  // namespace pcl_symmetry::apps
