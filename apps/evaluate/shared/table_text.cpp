#include "evaluate/shared/table_text.h"

#include <cmath>
#include <cstdio>

namespace pcl_symmetry::apps {

std::string fixed(double value, int decimals, double scale) {
  if (!std::isfinite(value)) return "-";
  char text[32];
  std::snprintf(text, sizeof(text), "%.*f", decimals, scale * value);
  return text;
}

Row& Row::add(const std::string& text) {
  if (!first_) line_ << ',';
  first_ = false;
  if (text.find_first_of(",\"\n") == std::string::npos) {
    line_ << text;
    return *this;
  }
  line_ << '"';
  for (const char c : text) line_ << (c == '"' ? "\"\"" : std::string(1, c));
  line_ << '"';
  return *this;
}

Row& Row::add(double value) {
  std::ostringstream text;
  if (std::isfinite(value)) text << value;
  return add(text.str());
}

}  // namespace pcl_symmetry::apps
