/// What the checks of PCD and PLY headers have in common.
#pragma once

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "io/file_text.h"

namespace pcl_symmetry::apps {

/// Points of a file at most. PCL's indices are 32-bit integers.
constexpr std::uint64_t kMaxPoints = std::numeric_limits<std::int32_t>::max();

using Words = std::vector<std::string>;

/// Reads line by line and knows where the next line begins.
class LineReader {
public:
  explicit LineReader(std::string_view text) : text_(text) {}

  bool next(std::string_view& line) {
    if (position_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find('\n', position_), text_.size());
    line = text_.substr(position_, end - position_);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    position_ = std::min(end + 1, text_.size());
    return true;
  }
  std::size_t position() const { return position_; }

private:
  std::string_view text_;
  std::size_t position_ = 0;
};

inline Words split(std::string_view line) {
  Words words;
  const std::string trimmed = boost::algorithm::trim_copy(std::string(line));
  if (!trimmed.empty()) boost::algorithm::split(words, trimmed, boost::is_space(), boost::token_compress_on);
  return words;
}

inline bool isPrintable(std::string_view line) {
  return std::all_of(line.begin(), line.end(), [](unsigned char c) { return c == '\t' || c >= 32; });
}

[[noreturn]] inline void reject(const std::string& path, const std::string& what) {
  throw InputError(path + ": " + what);
}

inline std::uint64_t headerCount(const std::string& path, const std::string& key, const std::string& value,
                                 std::uint64_t largest) {
  std::uint64_t count = 0;
  if (!spellsCount(value, &count)) reject(path, key + " = " + value + ", must be a whole number >= 0");
  if (count > largest) reject(path, key + " = " + value + ", must be <= " + std::to_string(largest));
  return count;
}

}  // namespace pcl_symmetry::apps
