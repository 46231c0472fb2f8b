#include "tools/database_listing.h"

#include <boost/algorithm/string/join.hpp>
#include <ctime>

namespace pcl_symmetry::apps {

namespace {

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? "\"\"" : std::string(1, c);
  return result + "\"";
}

}  // namespace

std::vector<ModelInfo> infosOf(const SymmetryDatabase& database, const std::vector<std::string>& names) {
  std::vector<ModelInfo> infos;
  for (const std::string& name : names) infos.push_back(database.info(name));
  return infos;
}

std::string timeText(std::int64_t time) {
  const auto seconds = static_cast<std::time_t>(time);
  std::tm parts{};
  ::gmtime_r(&seconds, &parts);
  char text[32];
  std::strftime(text, sizeof(text), "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

nlohmann::json modelsJson(const std::vector<ModelInfo>& models) {
  nlohmann::json json = nlohmann::json::array();
  for (const ModelInfo& model : models)
    json.push_back({{"name", model.name},
                    {"points", model.num_points},
                    {"time", timeText(model.time)},
                    {"source", model.source.path},
                    {"checksum", model.source.checksum},
                    {"tags", model.source.tags}});
  return json;
}

std::string modelsCSV(const std::vector<ModelInfo>& models) {
  std::string text = "name,points,time,source,checksum,tags\n";
  for (const ModelInfo& model : models)
    text += quoted(model.name) + "," + std::to_string(model.num_points) + "," + timeText(model.time) + "," +
            quoted(model.source.path) + "," + quoted(model.source.checksum) + "," +
            quoted(boost::algorithm::join(model.source.tags, " ")) + "\n";
  return text;
}

std::string modelText(const ModelInfo& model) {
  return model.name + "\n  points    " + std::to_string(model.num_points) + "\n  stored    " + timeText(model.time) +
         "\n  source    " + model.source.path + "\n  checksum  " + model.source.checksum + "\n  tags      " +
         boost::algorithm::join(model.source.tags, " ") + "\n";
}

}  // namespace pcl_symmetry::apps
