#include "io/shape_readers.h"

#include <algorithm>
#include <boost/algorithm/string.hpp>

#include "io/answers.h"
#include "io/file_text.h"

namespace pcl_symmetry::apps {

namespace {

using Columns = std::array<std::size_t, 3>;

using Cells = std::vector<std::string_view>;

/// Splits a line into cells, without quotes.
void splitRow(std::string_view line, Cells& cells) {
  const auto has = [&](char c) { return line.find(c) != std::string_view::npos; };
  const char separator = has(';') ? ';' : has(',') ? ',' : ' ';
  const auto ends = [&](char c) { return separator == ' ' ? c == ' ' || c == '\t' : c == separator; };
  cells.clear();
  for (std::size_t begin = 0; begin <= line.size();) {
    std::size_t end = begin;
    while (end < line.size() && !ends(line[end])) ++end;
    std::string_view cell = line.substr(begin, end - begin);
    cell.remove_prefix(std::min(cell.find_first_not_of(" \t\"'"), cell.size()));
    cell = cell.substr(0, cell.find_last_not_of(" \t\"'") + 1);
    if (separator != ' ' || !cell.empty()) cells.push_back(cell);
    begin = end + 1;
  }
  while (!cells.empty() && cells.back().empty()) cells.pop_back();
}

/// A comma in a cell is a decimal sign.
bool isNumber(std::string_view cell, double* value) {
  if (cell.find(',') == std::string_view::npos) return spellsNumber(cell, value);
  std::string text(cell);
  std::replace(text.begin(), text.end(), ',', '.');
  return spellsNumber(text, value);
}

/// \return the positions of the columns x, y and z, if all three are named; ParaView names them Points:0 to Points:2.
std::optional<Columns> namedColumns(const Cells& names) {
  Columns columns{};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto found = std::find_if(names.begin(), names.end(), [&](std::string_view name) {
      return boost::algorithm::iequals(name, std::string(1, "xyz"[k])) ||
             boost::algorithm::iequals(name, "points:" + std::to_string(k));
    });
    if (found == names.end()) return std::nullopt;
    columns[k] = static_cast<std::size_t>(found - names.begin());
  }
  return columns;
}

/// \return the first three columns that hold numbers.
std::optional<Columns> numericColumns(const Cells& cells) {
  Columns columns{};
  std::size_t num_found = 0;
  for (std::size_t i = 0; i < cells.size() && num_found < 3; ++i)
    if (isNumber(cells[i], nullptr)) columns[num_found++] = i;
  return num_found == 3 ? std::optional<Columns>(columns) : std::nullopt;
}

}  // namespace

ExactShape readColumns(const std::string& path, std::string_view text) {
  if (text.substr(0, 3) == "\xef\xbb\xbf") text.remove_prefix(3);  // the byte order mark of UTF-8
  ExactShape shape;
  std::optional<Columns> columns, named;
  std::optional<std::uint64_t> num_points;
  std::size_t num_columns = 0, num_names = 0;
  const auto fail = [&](std::size_t number, const std::string& what) {
    std::string shown = what;
    std::replace_if(
        shown.begin(), shown.end(), [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    reject(path, "line " + std::to_string(number) + " " + shown);
  };
  Cells cells;
  LineReader lines(text);
  std::string_view line;
  for (std::size_t number = 1; lines.next(line); ++number) {
    const std::size_t comment = std::min(line.find('#'), line.find("//"));
    if (!columns && !named) {  // names may be in a comment
      splitRow(line.substr(std::min(line.find_first_not_of("#/ \t"), line.size())), cells);
      named = namedColumns(cells);
      if (comment <= line.find_first_not_of(" \t")) num_names = cells.size();
      if (named) continue;
    }
    splitRow(line.substr(0, comment), cells);
    if (cells.empty()) continue;
    std::uint64_t count = 0;
    if (!columns && !num_points && cells.size() == 1 && spellsCount(cells[0], &count)) {
      num_points = count;
      continue;
    }
    // A comment may hold the words x, y and z for other reasons.
    if (!columns) columns = named && (num_names == 0 || cells.size() == num_names) ? named : numericColumns(cells);
    if (!columns) {  // words are a header
      if (std::any_of(cells.begin(), cells.end(), [](std::string_view cell) { return isNumber(cell, nullptr); }))
        fail(number, "= " + std::string(line.substr(0, 40)) + ", must hold three numbers");
      continue;
    }
    num_columns = std::max(num_columns, cells.size());
    Eigen::Vector3d point;
    for (int k = 0; k < 3; ++k) {
      const std::size_t i = (*columns)[static_cast<std::size_t>(k)];
      if (i >= cells.size())
        fail(number, "has " + std::to_string(cells.size()) + " columns, must have at least " + std::to_string(i + 1));
      if (!isNumber(cells[i], &point[k]))
        fail(number,
             "has " + std::string(1, "xyz"[k]) + " = " + std::string(cells[i].substr(0, 40)) + ", must be a number");
    }
    shape.vertices.push_back(point);
  }
  if (shape.vertices.empty()) reject(path, "has no points");
  if (num_points && *num_points != shape.vertices.size())
    reject(path, "holds " + std::to_string(shape.vertices.size()) + " points, its first line says " +
                     std::to_string(*num_points));
  if (num_columns > 3) shape.left_out.push_back(counted(num_columns - 3, "column") + " besides x, y and z");
  return shape;
}

}  // namespace pcl_symmetry::apps
