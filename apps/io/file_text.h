/// Byte-exact reading of files, and the textual parts of shape files: lines, words, numbers.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// \return whether the name means standard input, or standard output.
inline bool isStandardStream(const std::string& path) {
  return path == "-";
}

/// \throws InputError unless `path` is a file that can be opened.
void checkReadableFile(const std::string& path);

/// \return the whole file; for a pipe, everything that it delivers.
/// \throws InputError if it cannot be read or is empty.
std::string readWholeFile(const std::string& path);

/// \return the whole text of a file, see withoutMark().
std::string readTextFile(const std::string& path);

/// \return all of standard input.
/// \throws InputError if it is empty, cannot be read or was read before.
std::string readStandardInput();

/// \return text as UTF-8, without the byte order mark, which distinguishes UTF-8 and UTF-16.
std::string withoutMark(std::string text);

/// Greatest number of points of a file: PCL's indices are 32-bit integers.
constexpr std::uint64_t kMaxPoints = std::numeric_limits<std::int32_t>::max();

/// \throws InputError `path: what`.
[[noreturn]] void reject(const std::string& path, const std::string& what);

/// \return the whole number that is the value of a header entry.
/// \throws InputError naming the key and the rule.
std::uint64_t headerCount(const std::string& path, const std::string& key, const std::string& value,
                          std::uint64_t largest);

/// \return the words of a line, between blanks.
std::vector<std::string> split(std::string_view line);

/// \return whether a line holds no control characters but tabs.
bool isPrintable(std::string_view line);

/// Reads line by line and knows where the next line begins.
class LineReader {
public:
  explicit LineReader(std::string_view text) : text_(text) {}

  /// \return false at the end of the text.
  bool next(std::string_view& line);
  std::size_t position() const { return position_; }

private:
  std::string_view text_;
  std::size_t position_ = 0;
};

/// Walks through text token by token; a '#' opens a comment that ends with its line.
class TokenReader {
public:
  TokenReader(std::string_view text, std::string path) : text_(text), path_(std::move(path)) {}

  /// \return the next token; empty at the end of the text.
  std::string_view next();

  /// \return the next token if there is one on the current line; empty otherwise.
  std::string_view nextOnLine();

  /// \param what names the value in the error, e.g. "x of vertex 12".
  /// \throws InputError if the text ends or the token is no number ("nan" and "inf" are).
  double number(const char* what, std::uint64_t index);
  /// The same for a value that has to stand on the current line.
  double numberOnLine(const char* what, std::uint64_t index);
  std::uint64_t count(const char* what, std::uint64_t index, std::uint64_t largest);

  void skipLine();
  bool atEnd();

  /// \throws InputError "path: what index = token, rule"; \p what is missing if the token is empty.
  [[noreturn]] void fail(const char* what, std::uint64_t index, std::string_view token, const std::string& rule) const;

private:
  void skipSpace(bool across_lines);

  std::string_view text_;
  std::size_t position_ = 0;
  std::string path_;
};

/// \return true if the whole token spells a floating-point number, nan and inf included.
bool spellsNumber(std::string_view token, double* value = nullptr);

/// \return the whole number that the token spells.
/// \return false if it does not, or if it does not fit.
bool spellsCount(std::string_view token, std::uint64_t* value);

}  // namespace pcl_symmetry::apps
