#include <boost/algorithm/string.hpp>

#include "io/file_text.h"
#include "io/shape_readers.h"

namespace pcl_symmetry::apps {

namespace {

constexpr std::size_t kHeader = 84, kTriangle = 50;  // bytes; the last four of the header are the count

std::uint64_t countOf(std::string_view content) {
  std::uint32_t count = 0;
  std::memcpy(&count, &content[kHeader - sizeof(count)], sizeof(count));
  return count;
}

ExactShape readTriangles(const std::string& path, std::string_view content) {
  ExactShape shape;
  const std::uint64_t count = countOf(content), rest = content.size() - kHeader, whole = rest / kTriangle;
  // Programs that do not know the number yet write 0 or what is in memory; a file that is cut off has a part of the
  // number.
  constexpr std::uint64_t kMostCutOff = 1000;
  const bool is_a_count = count > 0 && count / kMostCutOff <= whole;
  if (count > whole && (is_a_count || rest % kTriangle != 0))
    reject(path, "cannot be read as STL, it is cut off: it holds " + std::to_string(whole) + " of " +
                     std::to_string(count) + " triangles");
  if (count < whole && rest % kTriangle != 0)
    reject(path, "cannot be read as STL, its count is " + std::to_string(count) + " triangles, but " +
                     std::to_string(rest) + " bytes follow");
  if (count != whole)
    shape.left_out.push_back("its count, " + std::to_string(count) + " for " + std::to_string(whole) + " triangles,");
  VertexWelder welder(shape);
  for (std::uint64_t i = 0; i < whole; ++i) {
    float numbers[12];  // the normal and three corners
    std::memcpy(numbers, &content[kHeader + i * kTriangle], sizeof(numbers));
    shape.polygons.emplace_back();
    for (int k = 3; k < 12; k += 3)
      shape.polygons.back().vertices.push_back(welder.add(Eigen::Map<Eigen::Vector3f>(numbers + k).cast<double>()));
  }
  return shape;
}

ExactShape readText(const std::string& path, std::string_view text) {
  ExactShape shape;
  VertexWelder welder(shape);
  TokenReader reader(text, path);
  bool has_end = false;
  std::uint64_t num_vertices = 0;
  pcl::Vertices polygon;
  for (std::string word(reader.next()); !word.empty(); word = reader.next()) {
    boost::algorithm::to_lower(word);
    if (word == "vertex") {
      const std::uint64_t i = num_vertices++;
      const double x = reader.number("x of vertex", i), y = reader.number("y of vertex", i);
      polygon.vertices.push_back(welder.add({x, y, reader.number("z of vertex", i)}));
    } else if (word == "endloop") {
      if (polygon.vertices.size() >= 3) shape.polygons.push_back(std::move(polygon));
      polygon = {};
    } else {
      has_end |= word == "endsolid";
      reader.skipLine();
    }
  }
  if (!has_end) reject(path, "cannot be read as STL, it is cut off: it ends before endsolid");
  return shape;
}

}  // namespace

bool isBinarySTL(std::string_view content) {
  return content.size() > kHeader && content.size() - kHeader == kTriangle * countOf(content);
}

ExactShape readSTL(const std::string& path, std::string_view content) {
  const std::string_view begin = content.substr(0, kHeader + kTriangle);
  const bool is_text = begin.find('\0') == std::string_view::npos && boost::algorithm::icontains(begin, "solid");
  if (!is_text && content.size() < kHeader) reject(path, "cannot be read as STL, is neither its text nor its bytes");
  ExactShape shape = is_text && !isBinarySTL(content) ? readText(path, content) : readTriangles(path, content);
  if (shape.polygons.empty()) reject(path, "has no triangles");
  return shape;
}

}  // namespace pcl_symmetry::apps
