#include "io/shape_readers.h"

#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

/// Reads the keyword, which may be joined with the first count or be missing, and the first count.
std::uint64_t readKeywordAndVertexCount(TokenReader& reader, const std::string& path) {
  const std::string keyword(reader.next());
  std::uint64_t num_vertices = 0;
  if (spellsCount(keyword, &num_vertices)) return num_vertices;
  const std::size_t tail = keyword.rfind("OFF");
  const bool is_keyword = tail != std::string::npos && tail <= 4 && keyword.find_first_not_of("STCN") >= tail;
  if (is_keyword && spellsCount(std::string_view(keyword).substr(tail + 3), &num_vertices)) return num_vertices;
  if (!is_keyword || keyword.size() > tail + 3) throw InputError(path + ": does not begin with OFF");
  const std::string_view following = reader.next();
  if (following == "BINARY") throw InputError(path + ": OFF BINARY is not supported, must be text");
  if (!spellsCount(following, &num_vertices))
    throw InputError(path + ": number of vertices is missing or not a whole number >= 0");
  return num_vertices;
}

}  // namespace

ExactShape readOFF(const std::string& path, std::string_view text) {
  TokenReader reader(text, path);
  const std::uint64_t num_vertices = readKeywordAndVertexCount(reader, path);
  const std::uint64_t num_faces =
      reader.count("number of faces, header value", 2, std::numeric_limits<std::uint64_t>::max());
  reader.skipLine();
  if (num_vertices == 0) throw InputError(path + ": number of vertices = 0, must be > 0");
  if (num_vertices > text.size() / 6) {
    throw InputError(path + ": number of vertices = " + std::to_string(num_vertices) +
                     ", the file is too short for them");
  }
  if (num_faces > text.size() / 2)
    throw InputError(path + ": number of faces = " + std::to_string(num_faces) + ", the file is too short for them");

  ExactShape shape;
  shape.vertices.reserve(num_vertices);
  for (std::uint64_t i = 0; i < num_vertices; ++i) {
    const double x = reader.number("x of vertex", i), y = reader.number("y of vertex", i);
    shape.vertices.emplace_back(x, y, reader.number("z of vertex", i));
    reader.skipLine();
  }

  for (std::uint64_t i = 0; i < num_faces; ++i) {
    const std::uint64_t num_corners = reader.count("number of corners of face", i, text.size());
    pcl::Vertices polygon;
    for (std::uint64_t k = 0; k < num_corners; ++k)
      polygon.vertices.push_back(static_cast<pcl::index_t>(reader.count("a corner of face", i, num_vertices - 1)));
    reader.skipLine();
    if (num_corners >= 3) shape.polygons.push_back(std::move(polygon));
  }
  std::uint64_t num_corners = 0;  // number of corners of the next face; edges may follow
  if (spellsCount(reader.next(), &num_corners) && num_corners >= 3)
    throw InputError(path + ": holds more faces than its header says, " + std::to_string(num_faces));
  return shape;
}

}  // namespace pcl_symmetry::apps
