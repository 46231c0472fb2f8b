/// Byte-exact reading of the textual parts of shape files.
#pragma once

#include <cstdint>
#include <cstdio>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "command_line/tool_errors.h"

namespace pcl_symmetry::apps {

/// \throws InputError unless `path` is a file that can be opened.
void checkReadableFile(const std::string& path);

/// \return the whole file; of a pipe all that comes.
/// \throws InputError if it cannot be read or is empty.
std::string readWholeFile(const std::string& path);

/// \return what is left of an open file.
/// \param name in errors.
std::string readAll(std::FILE* file, const std::string& name);

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

  /// \throws InputError "path: what index = token, rule"; what is missing where the token is empty.
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
