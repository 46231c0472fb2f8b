#include "io/shape_readers.h"

#include <charconv>

#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

/// \param word corner of a face: the number of a vertex, from 1, or from -1 backwards, perhaps followed by
/// /texture/normal.
/// \return the index; the greatest number if it is invalid.
std::size_t vertexIndex(std::string_view word, std::size_t num_vertices) {
  std::int64_t number = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
  const bool is_number = error == std::errc() && (end == word.data() + word.size() || *end == '/');
  const auto size = static_cast<std::int64_t>(num_vertices);
  if (!is_number || number == 0 || number < -size) return std::numeric_limits<std::size_t>::max();
  return static_cast<std::size_t>(number > 0 ? number - 1 : size + number);
}

}  // namespace

ExactShape readOBJ(const std::string& path, std::string_view text) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<std::vector<std::size_t>> faces;
  TokenReader reader(text, path);
  bool knows_a_word = false;
  while (!reader.atEnd()) {
    const std::string_view word = reader.next();
    if (word == "v") {
      const std::uint64_t i = vertices.size();
      const double x = reader.numberOnLine("x of vertex", i), y = reader.numberOnLine("y of vertex", i);
      vertices.emplace_back(x, y, reader.numberOnLine("z of vertex", i));
    } else if (word == "f") {
      faces.emplace_back();
      for (std::string_view corner = reader.nextOnLine(); !corner.empty(); corner = reader.nextOnLine()) {
        if (corner == "\\") {  // the line continues
          reader.skipLine();
          corner = reader.next();
        }
        faces.back().push_back(vertexIndex(corner, vertices.size()));
        if (faces.back().back() == std::numeric_limits<std::size_t>::max())
          reader.fail("a corner of face", faces.size() - 1, corner, "must be the number of a vertex");
      }
    }
    knows_a_word |= word == "v" || word == "f";
    reader.skipLine();
  }
  if (!knows_a_word) throw InputError(path + ": cannot be read as OBJ, has neither vertices nor faces");
  ExactShape shape;
  if (faces.empty()) {
    shape.vertices = std::move(vertices);
    return shape;
  }
  VertexWelder welder(shape);
  for (std::size_t i = 0; i < faces.size(); ++i) {
    if (faces[i].size() < 3) continue;
    shape.polygons.emplace_back();
    for (const std::size_t corner : faces[i]) {
      if (corner >= vertices.size())
        reader.fail("a corner of face", i, std::to_string(corner + 1), "must be <= " + std::to_string(vertices.size()));
      shape.polygons.back().vertices.push_back(welder.add(vertices[corner]));
    }
  }
  if (shape.polygons.empty()) throw InputError(path + ": has no faces of three or more corners");
  return shape;
}

}  // namespace pcl_symmetry::apps
