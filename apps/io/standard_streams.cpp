#include "io/standard_streams.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <initializer_list>

#include "io/file_text.h"
#include "io/shape_file_kinds.h"

namespace pcl_symmetry::apps {

namespace {

constexpr std::size_t kPiece = 1 << 16;  // bytes read at once. chosen: half and twice take the same time

std::string readStandardInput() {
  static bool read_before = false;
  if (read_before) throw InputError("standard input: can be read only once");
  read_before = true;
  std::string content;
  std::size_t got = 0;
  do {
    content.resize(content.size() + kPiece);
    got = std::fread(content.data() + content.size() - kPiece, 1, kPiece, stdin);
    content.resize(content.size() - kPiece + got);
  } while (got > 0);
  if (std::ferror(stdin)) throw InputError(std::string("standard input: cannot be read, ") + std::strerror(errno));
  if (content.empty()) throw InputError("standard input: is empty (0 bytes)");
  return content;
}

/// Binary STL: 80 bytes, the number of triangles, 50 bytes each.
bool isBinarySTL(const std::string& content) {
  if (content.size() < 84) return false;
  std::uint32_t num_triangles = 0;
  std::memcpy(&num_triangles, content.data() + 80, sizeof(num_triangles));
  return content.size() == 84 + 50 * std::uint64_t{num_triangles};
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
  if (isBinarySTL(content)) return ".stl";
  const std::string begin = content.substr(0, kPiece);
  if (boost::algorithm::starts_with(begin, "# .PCD")) return ".pcd";
  TokenReader tokens(begin, "standard input");
  const std::string word(tokens.next());
  if (word == "ply") return ".ply";
  if (isOneOf(word, {"VERSION", "FIELDS", "COLUMNS"})) return ".pcd";
  if (word == "solid") return ".stl";
  if (isOneOf(word, {"v", "vn", "vt", "o", "g", "s", "mtllib", "usemtl"})) return ".obj";
  if (isOFF(word)) return ".off";
  return spellsNumber(word) ? ".xyz" : "";
}

StandardInput::StandardInput() {
  const std::string content = readStandardInput();
  const std::string extension = extensionOfContent(content);
  if (extension.empty()) throw InputError(std::string("standard input: is of no known kind, must be ") + kShapeFiles);
  const std::string name = makeUniqueFile(temporaryModel(extension));
  if (name.empty()) throw InputError(std::string("standard input: cannot be kept, ") + std::strerror(errno));
  file_ = std::make_unique<TemporaryFile>(name);
  std::ofstream file(name, std::ios::binary);
  file << content;
  file.close();
  if (!file) throw InputError(std::string("standard input: cannot be kept, ") + std::strerror(errno));
}

std::string StandardInput::named(const std::string& text) const {
  return boost::algorithm::replace_all_copy(text, path(), "standard input");
}

void writeStandardOutput(const std::string& text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size() || std::fflush(stdout) != 0)
    throw InputError(std::string("standard output: cannot be written, ") + std::strerror(errno));
}

void copyToStandardOutput(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::string piece(kPiece, '\0');
  while (file.read(piece.data(), static_cast<std::streamsize>(kPiece)) || file.gcount() > 0)
    writeStandardOutput(piece.substr(0, static_cast<std::size_t>(file.gcount())));
}

}  // namespace pcl_symmetry::apps
