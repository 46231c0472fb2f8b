#include "io/file_text.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <boost/locale/encoding_utf.hpp>
#include <cctype>
#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>

namespace pcl_symmetry::apps {

namespace fs = boost::filesystem;

void checkReadableFile(const std::string& path) {
  boost::system::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (!fs::exists(status)) throw InputError(path + ": no such file");
  if (fs::is_directory(status)) throw InputError(path + ": is a folder, must be a file");
  errno = 0;
  // Opening a pipe would take its content away from the next reader.
  if (fs::is_regular_file(status) && !std::ifstream(path, std::ios::binary))
    throw InputError(path + ": cannot be opened, " + std::strerror(errno));
}

namespace {

/// \param name name of the file in messages.
std::string readAll(std::FILE* file, const std::string& name) {
  std::string text;
  constexpr std::size_t kPiece = 1 << 16;
  std::size_t size = 0;
  do {
    text.resize(size + kPiece);
    size += std::fread(&text[size], 1, kPiece, file);
  } while (size == text.size());
  text.resize(size);
  if (std::ferror(file)) throw InputError(name + ": cannot be read, " + std::strerror(errno));
  if (text.empty()) throw InputError(name + ": is empty (0 bytes)");
  return text;
}

}  // namespace

std::string readWholeFile(const std::string& path) {
  checkReadableFile(path);
  std::FILE* const file = std::fopen(path.c_str(), "rb");
  if (!file) throw InputError(path + ": cannot be opened, " + std::strerror(errno));
  std::string text = readAll(file, path);
  std::fclose(file);
  return text;
}

std::string readStandardInput() {
  static bool read_before = false;
  if (read_before) throw InputError("standard input: can be read only once");
  read_before = true;
  return readAll(stdin, "standard input");
}

std::string withoutMark(std::string text) {
  const std::string mark = text.substr(0, 2);
  if (text.compare(0, 3, "\xef\xbb\xbf") == 0) text.erase(0, 3);
  if (mark != "\xff\xfe" && mark != "\xfe\xff") return text;
  std::u16string units;
  const std::size_t low = mark[0] == '\xff' ? 0 : 1;
  for (std::size_t i = 2; i + 1 < text.size(); i += 2)
    units += static_cast<char16_t>(static_cast<unsigned char>(text[i + low]) |
                                   static_cast<unsigned char>(text[i + 1 - low]) << 8);
  return boost::locale::conv::utf_to_utf<char>(units);
}

std::string readTextFile(const std::string& path) {
  return withoutMark(readWholeFile(path));
}

void reject(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what);
}

std::uint64_t headerCount(const std::string& path, const std::string& key, const std::string& value,
                          std::uint64_t largest) {
  std::uint64_t count = 0;
  if (!spellsCount(value, &count)) reject(path, key + " = " + value + ", must be a whole number >= 0");
  if (count > largest) reject(path, key + " = " + value + ", must be <= " + std::to_string(largest));
  return count;
}

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> words;
  const std::string trimmed = boost::algorithm::trim_copy(std::string(line));
  if (!trimmed.empty()) boost::algorithm::split(words, trimmed, boost::is_space(), boost::token_compress_on);
  return words;
}

bool isPrintable(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](unsigned char c) { return c == '\t' || c >= 32; });
}

bool LineReader::next(std::string_view& line) {
  if (position_ >= text_.size()) return false;
  const std::size_t end = std::min(text_.find('\n', position_), text_.size());
  line = text_.substr(position_, end - position_);
  if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
  position_ = std::min(end + 1, text_.size());
  return true;
}

bool spellsNumber(std::string_view token, double* value) {
  if (!token.empty() && token.front() == '+') token.remove_prefix(1);
  double parsed = 0;
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), parsed);
  if (error == std::errc::result_out_of_range)
    parsed = std::strtod(std::string(token).c_str(), nullptr);
  else if (error != std::errc())
    return false;
  if (end != token.data() + token.size()) return false;
  if (value) *value = parsed;
  return true;
}

bool spellsCount(std::string_view token, std::uint64_t* value) {
  const auto [end, error] = std::from_chars(token.data(), token.data() + token.size(), *value);
  return !token.empty() && error == std::errc() && end == token.data() + token.size();
}

void TokenReader::skipSpace(bool across_lines) {
  while (position_ < text_.size()) {
    const char c = text_[position_];
    if (c == '#')
      position_ = std::min(text_.find('\n', position_), text_.size());
    else if (std::isspace(static_cast<unsigned char>(c)) && (across_lines || c != '\n'))
      ++position_;
    else
      break;
  }
}

std::string_view TokenReader::nextOnLine() {
  skipSpace(false);
  const std::size_t begin = position_;
  while (position_ < text_.size() && text_[position_] != '#' &&
         !std::isspace(static_cast<unsigned char>(text_[position_])))
    ++position_;
  return text_.substr(begin, position_ - begin);
}

std::string_view TokenReader::next() {
  skipSpace(true);
  return nextOnLine();
}

void TokenReader::skipLine() {
  position_ = std::min(text_.find('\n', position_), text_.size());
}

bool TokenReader::atEnd() {
  skipSpace(true);
  return position_ == text_.size();
}

void TokenReader::fail(const char* what, std::uint64_t index, std::string_view token, const std::string& rule) const {
  const std::string name = path_ + ": " + what + " " + std::to_string(index);
  if (token.empty()) throw InputError(name + " is missing, the file ends before it");
  std::string shown(token.substr(0, 40));
  std::replace_if(
      shown.begin(), shown.end(), [](unsigned char c) { return !std::isprint(c); }, '?');
  throw InputError(name + " = " + shown + ", " + rule);
}

double TokenReader::number(const char* what, std::uint64_t index) {
  const std::string_view token = next();
  double value = 0;
  if (!spellsNumber(token, &value)) fail(what, index, token, "must be a number");
  return value;
}

double TokenReader::numberOnLine(const char* what, std::uint64_t index) {
  const std::string_view token = nextOnLine();
  double value = 0;
  if (token.empty()) throw InputError(path_ + ": " + what + " " + std::to_string(index) + " is missing on its line");
  if (!spellsNumber(token, &value)) fail(what, index, token, "must be a number");
  return value;
}

std::uint64_t TokenReader::count(const char* what, std::uint64_t index, std::uint64_t largest) {
  const std::string_view token = next();
  std::uint64_t value = 0;
  if (!spellsCount(token, &value)) fail(what, index, token, "must be a whole number >= 0");
  if (value > largest) fail(what, index, token, "must be <= " + std::to_string(largest));
  return value;
}

}  // namespace pcl_symmetry::apps
