/// Numbers as text: for tables that people read and for CSV files.
#pragma once

#include <optional>
#include <sstream>
#include <string>

namespace pcl_symmetry::apps {

/// A number with the given number of decimals, or a dash where there is nothing to count.
std::string fixed(double value, int decimals, double scale = 1.0);

/// Builds one row of comma-separated values; what is not known stays empty.
class Row {
public:
  Row& add(const std::string& text);
  Row& add(const char* text) { return add(std::string(text)); }
  Row& add(double value);
  Row& add(const std::optional<double>& value) { return value ? add(*value) : add(""); }
  std::string end() const { return line_.str() + "\n"; }

private:
  std::ostringstream line_;
  bool first_ = true;
};

}  // namespace pcl_symmetry::apps
