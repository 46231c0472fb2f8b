#include "command_line/csv.h"

#include <boost/algorithm/string.hpp>

namespace pcl_symmetry::apps {

namespace {

std::string cellOf(const nlohmann::json& value) {
  if (value.is_null()) return "";
  if (!value.is_string()) return value.dump();
  const std::string text = value.get<std::string>();
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  return "\"" + boost::algorithm::replace_all_copy(text, "\"", "\"\"") + "\"";
}

}  // namespace

std::string csvLine(const std::vector<nlohmann::json>& cells) {
  std::string line;
  for (const nlohmann::json& cell : cells) line += (line.empty() ? "" : ",") + cellOf(cell);
  return line + "\n";
}

std::string firstCell(const std::string& line) {
  if (line.empty() || line.front() != '"') return line.substr(0, line.find(','));
  std::string cell;
  for (std::size_t i = 1; i < line.size(); ++i) {
    if (line[i] == '"' && (i + 1 == line.size() || line[++i] != '"')) break;
    cell += line[i];
  }
  return cell;
}

}  // namespace pcl_symmetry::apps
