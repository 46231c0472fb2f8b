#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>

#include "common/files/cloud_file_checks.h"
#include "common/files/header_lines.h"

namespace pcl_symmetry::apps {

namespace {

struct PCDHeader {
  std::map<std::string, Words> entries;
  std::size_t body = 0;

  const Words* find(const std::string& key) const {
    const auto entry = entries.find(key);
    return entry == entries.end() ? nullptr : &entry->second;
  }
};

PCDHeader readPCDHeader(const std::string& path, std::string_view text) {
  PCDHeader header;
  LineReader lines(text);
  std::string_view line;
  while (lines.next(line)) {
    if (!isPrintable(line)) reject(path, "has no PCD header");
    Words words = split(line);
    if (words.empty() || words[0][0] == '#') continue;
    std::string key = words[0];
    words.erase(words.begin());
    if (key == "COLUMNS") key = "FIELDS";
    static const char* const known[] = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                        "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    if (std::find(std::begin(known), std::end(known), key) == std::end(known)) {
      reject(path, header.entries.empty() ? "has no PCD header" : "unknown PCD header entry " + key.substr(0, 40));
    }
    if (!header.entries.emplace(key, words).second) reject(path, "PCD header entry " + key + " stands twice");
    if (words.empty()) reject(path, "PCD header entry " + key + " has no value");
    if (key == "DATA") {
      header.body = lines.position();
      return header;
    }
  }
  reject(path, header.entries.empty() ? "has no PCD header" : "PCD header ends before DATA");
}

struct PCDLayout {
  std::uint64_t num_points = 0;
  std::uint64_t point_size = 0;
  std::uint64_t packed_size = 0;  ///< without padding fields
  std::uint64_t num_values = 0;
};

PCDLayout checkPCDFields(const std::string& path, const PCDHeader& header) {
  const Words* fields = header.find("FIELDS");
  const Words* sizes = header.find("SIZE");
  const Words* types = header.find("TYPE");
  const Words* counts = header.find("COUNT");
  if (!fields) reject(path, "PCD header has no FIELDS");
  if (!sizes) reject(path, "PCD header has no SIZE");
  if (!types) reject(path, "PCD header has no TYPE");
  const auto check_length = [&](const char* key, const Words& words) {
    if (words.size() != fields->size()) {
      reject(path, std::string(key) + " has " + std::to_string(words.size()) + " entries, must be " +
                       std::to_string(fields->size()) + ", one per field");
    }
  };
  check_length("SIZE", *sizes);
  check_length("TYPE", *types);
  if (counts) check_length("COUNT", *counts);

  PCDLayout layout;
  for (std::size_t i = 0; i < fields->size(); ++i) {
    const std::string& name = (*fields)[i];
    const std::string& type = (*types)[i];
    const std::uint64_t size = headerCount(path, "SIZE of " + name, (*sizes)[i], 8);
    const bool known = (type == "F" && (size == 4 || size == 8)) ||
                       ((type == "I" || type == "U") && (size == 1 || size == 2 || size == 4 || size == 8));
    if (!known && name != "_") {
      reject(path, "TYPE and SIZE of " + name + " = " + type + " " + (*sizes)[i] +
                       ", must be F 4, F 8, or I or U with 1, 2, 4 or 8");
    }
    const std::uint64_t count = counts ? headerCount(path, "COUNT of " + name, (*counts)[i], 1 << 20) : 1;
    if (count == 0) reject(path, "COUNT of " + name + " = 0, must be > 0");
    const bool coordinate = name == "x" || name == "y" || name == "z";
    if (coordinate && type != "F") reject(path, "TYPE of " + name + " = " + type + ", must be F");
    if (coordinate && count != 1) reject(path, "COUNT of " + name + " = " + std::to_string(count) + ", must be 1");
    if (std::count(fields->begin(), fields->end(), name) > 1 && name != "_")
      reject(path, "field " + name + " stands twice");
    layout.point_size += size * count;
    layout.packed_size += name == "_" ? 0 : size * count;
    layout.num_values += count;
  }
  for (const char* name : {"x", "y", "z"}) {
    if (std::find(fields->begin(), fields->end(), name) == fields->end()) {
      reject(path, "has no field " + std::string(name) + ", must have x, y and z");
    }
  }
  return layout;
}

void checkPCDCounts(const std::string& path, const PCDHeader& header, PCDLayout& layout) {
  for (const char* key : {"WIDTH", "HEIGHT", "POINTS"}) {
    if (!header.find(key)) reject(path, "PCD header has no " + std::string(key));
  }
  const std::uint64_t width = headerCount(path, "WIDTH", header.find("WIDTH")->front(), kMaxPoints);
  const std::uint64_t height = headerCount(path, "HEIGHT", header.find("HEIGHT")->front(), kMaxPoints);
  layout.num_points = headerCount(path, "POINTS", header.find("POINTS")->front(), kMaxPoints);
  if (width * height != layout.num_points) {
    reject(path, "POINTS = " + std::to_string(layout.num_points) +
                     ", must be WIDTH * HEIGHT = " + std::to_string(width * height));
  }
  if (layout.num_points == 0) reject(path, "POINTS = 0, must be > 0");
  if (const Words* viewpoint = header.find("VIEWPOINT")) {
    double value = 0;
    if (viewpoint->size() != 7 || !std::all_of(viewpoint->begin(), viewpoint->end(), [&](const std::string& word) {
          return spellsNumber(word, &value) && std::isfinite(value);
        })) {
      reject(path, "VIEWPOINT must be seven finite numbers");
    }
  }
}

void checkPCDText(const std::string& path, std::string_view body, const PCDLayout& layout) {
  LineReader lines(body);
  std::string_view line;
  std::uint64_t row = 0;
  while (row < layout.num_points && lines.next(line)) {
    TokenReader tokens(line, path);
    std::uint64_t values = 0;
    for (std::string_view token = tokens.next(); !token.empty(); token = tokens.next(), ++values) {
      if (!spellsNumber(token)) {
        reject(path, "point " + std::to_string(row) + " holds a value that is not a number");
      }
    }
    if (values == 0) continue;
    if (values != layout.num_values) {
      reject(path, "point " + std::to_string(row) + " has " + std::to_string(values) + " values, must be " +
                       std::to_string(layout.num_values));
    }
    ++row;
  }
  if (row < layout.num_points) {
    reject(path, "holds " + std::to_string(row) + " points, POINTS = " + std::to_string(layout.num_points));
  }
}

void checkPCDCompressed(const std::string& path, std::string_view body, const PCDLayout& layout) {
  if (body.size() < 8) reject(path, "ends before the sizes of the compressed points");
  std::uint32_t compressed = 0, uncompressed = 0;
  std::memcpy(&compressed, body.data(), 4);
  std::memcpy(&uncompressed, body.data() + 4, 4);
  if (compressed == 0 || compressed > body.size() - 8) {
    reject(path, "compressed size = " + std::to_string(compressed) +
                     ", must be > 0 and <= " + std::to_string(body.size() - 8) + ", the bytes that follow");
  }
  if (uncompressed != layout.packed_size * layout.num_points) {
    reject(path, "uncompressed size = " + std::to_string(uncompressed) + ", must be " +
                     std::to_string(layout.packed_size * layout.num_points) + ", the size of all points");
  }
}

}  // namespace

void checkPCD(const std::string& path) {
  const std::string text = readWholeFile(path);
  const PCDHeader header = readPCDHeader(path, text);
  PCDLayout layout = checkPCDFields(path, header);
  checkPCDCounts(path, header, layout);
  const std::string& data = header.find("DATA")->front();
  const std::string_view body = std::string_view(text).substr(header.body);
  const auto need = [&](std::uint64_t bytes) {
    if (body.size() < bytes) {
      reject(path, "holds " + std::to_string(body.size()) + " bytes of points, must be >= " + std::to_string(bytes) +
                       " for POINTS = " + std::to_string(layout.num_points));
    }
  };
  if (data == "ascii") {
    need(2 * layout.num_values * layout.num_points - 1);
    checkPCDText(path, body, layout);
  } else if (data == "binary") {
    need(layout.point_size * layout.num_points);
  } else if (data == "binary_compressed") {
    checkPCDCompressed(path, body, layout);
  } else {
    reject(path, "DATA = " + data.substr(0, 40) + ", must be ascii, binary or binary_compressed");
  }
}

}  // namespace pcl_symmetry::apps
