#include "io/standard_streams.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cctype>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <initializer_list>

#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

/// Binary STL: 80 bytes, the number of triangles, 50 bytes each.
bool isBinarySTL(const std::string& content) {
  if (content.size() < 84) return false;
  std::uint32_t num_triangles = 0;
  std::memcpy(&num_triangles, content.data() + 80, sizeof(num_triangles));
  return num_triangles > 0 && content.size() >= 84 + 50 * std::uint64_t{num_triangles};
}

bool isOFF(const std::string& word) {
  const std::size_t tail = word.find("OFF");
  return tail != std::string::npos && tail <= 4 && word.find_first_not_of("STCN") >= tail;
}

bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string extensionOfContent(const std::string& content) {
  if (boost::algorithm::starts_with(content, "glTF")) return ".glb";
  if (boost::algorithm::starts_with(content, "# .PCD")) return ".pcd";
  const std::string begin = content.substr(0, 1 << 16);
  TokenReader tokens(begin, "standard input");
  const std::string word(tokens.next());
  if (word == "ply") return ".ply";
  if (isOneOf(word, {"VERSION", "FIELDS", "COLUMNS"})) return ".pcd";
  if (boost::algorithm::iequals(word, "solid") || isBinarySTL(content)) return ".stl";
  if (isOneOf(word, {"v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"})) return ".obj";
  if (isOFF(word)) return ".off";
  const bool has_number = begin.find_first_of("0123456789") != std::string::npos;
  const bool is_text =
      std::all_of(begin.begin(), begin.end(), [](unsigned char c) { return c >= ' ' || std::isspace(c); });
  return has_number && is_text ? ".xyz" : "";
}

std::string readStandardInput() {
  static bool read_before = false;
  if (read_before) throw InputError("standard input: can be read only once");
  read_before = true;
  return readAll(stdin, "standard input");
}

void writeStandardOutput(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw InputError(std::string("standard output: cannot be written, ") + std::strerror(errno));
}

}  // namespace pcl_symmetry::apps
