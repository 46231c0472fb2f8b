#include "io/face_labels.h"

#include <limits>

#include "io/file_text.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

std::vector<int> readFaceLabels(const std::string& path) {
  const std::string text = readWholeFile(path);
  TokenReader reader(text, path);
  std::vector<int> labels;
  while (!reader.atEnd())
    labels.push_back(static_cast<int>(reader.count("segment of face", labels.size(), std::numeric_limits<int>::max())));
  return labels;
}

void writeFaceLabels(const std::string& path, const std::vector<int>& labels) {
  std::string text;
  for (const int label : labels) text += std::to_string(label) + "\n";
  writeText(path, text);
}

}  // namespace pcl_symmetry::apps
