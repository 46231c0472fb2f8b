/// The command line that all tools share: single- and double-dash flags, checked values, usage with an example.
#pragma once

#include <Eigen/Core>
#include <boost/program_options.hpp>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "pcl_symmetry/viewpoint.h"
#include "tool_errors.h"

namespace pcl_symmetry::apps {

/// An interval of allowed values; the ends belong to it unless marked open.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
  bool min_open = false;
  bool max_open = false;

  static Range atLeast(double min) { return {min, std::numeric_limits<double>::infinity(), false, false}; }
  static Range above(double min) { return {min, std::numeric_limits<double>::infinity(), true, false}; }
  static Range closed(double min, double max) { return {min, max, false, false}; }
  static Range open(double min, double max) { return {min, max, true, true}; }

  bool contains(double value) const;

  /// \return the rule in words, e.g. "must be >= 0".
  std::string rule() const;
};

/// The values of the flags that have the same meaning in every tool.
struct CommonOptions {
  std::optional<std::string> json_path;
  std::uint64_t seed = 0;
  int threads = 0;  ///< 0 = all
  int grid = 64;    ///< cells along an edge
  Viewpoint viewpoint;
  bool quiet = false;
};

/// Which of the common flags a tool offers.
enum CommonFlag : unsigned {
  kJson = 1u << 0,
  kSeed = 1u << 1,
  kThreads = 1u << 2,
  kGrid = 1u << 3,
  kViewpoint = 1u << 4,
  kQuiet = 1u << 5,
  kAllCommonFlags = (1u << 6) - 1
};

/// Declares the flags of a tool, each bound to a variable that holds its default, and reads them from argv.
/// The bound variables must outlive parse().
class CommandLine {
public:
  /// \param tool name of the program; \param summary one sentence; \param example a complete command.
  CommandLine(std::string tool, std::string summary, std::string example);

  /// Arguments without a flag, in the order of declaration; required ones come first.
  CommandLine& positional(const std::string& name, std::string& value, const std::string& help);
  CommandLine& positional(const std::string& name, std::optional<std::string>& value, const std::string& help);
  /// One or more, to the end of the command line; declared last.
  CommandLine& positionals(const std::string& name, std::vector<std::string>& values, const std::string& help);

  CommandLine& flag(const std::string& name, bool& value, const std::string& help);
  CommandLine& text(const std::string& name, const std::string& placeholder, std::optional<std::string>& value,
                    const std::string& help);
  CommandLine& choice(const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                      const std::string& help);
  CommandLine& number(const std::string& name, double& value, const Range& range, const std::string& help);
  CommandLine& number(const std::string& name, std::optional<double>& value, const Range& range,
                      const std::string& help);
  CommandLine& number(const std::string& name, int& value, const Range& range, const std::string& help);
  CommandLine& number(const std::string& name, std::optional<int>& value, const Range& range, const std::string& help);
  CommandLine& number(const std::string& name, std::uint64_t& value, const std::string& help);
  /// A list "A,B,C" of one number or more, which replaces the default as a whole.
  CommandLine& numbers(const std::string& name, std::vector<double>& values, const Range& range,
                       const std::string& help);
  CommandLine& vector(const std::string& name, std::optional<Eigen::Vector3d>& value, const std::string& help);
  CommandLine& common(CommonOptions& options, unsigned flags = kAllCommonFlags);

  /// Reads the arguments into the bound variables.
  /// \return false if -h or --help was given (the usage is then on standard output and the tool is done).
  /// \throws UsageError naming flag, value and rule.
  bool parse(int argc, const char* const* argv);

  /// \return true if the flag stood on the parsed command line.
  bool given(const std::string& name) const;

  /// \return synopsis, flags with their defaults, and the example.
  std::string usage() const;

private:
  struct Positional {
    std::string name;
    std::string help;
    bool required;
    std::function<void(const std::string&)> assign;
    bool repeated = false;
  };

  CommandLine& add(const std::string& name, const std::string& placeholder, const std::string& help,
                   std::function<void(const std::string&)> assign);
  std::string closestFlag(const std::string& unknown) const;

  std::string tool_, summary_, example_;
  std::vector<Positional> positionals_;
  boost::program_options::options_description flags_{"Flags", 120, 60};
  std::vector<std::string> flag_names_;
  std::vector<std::pair<std::string, std::function<void(const std::string&)>>> assignments_;
  std::vector<std::pair<std::string, bool*>> switches_;
  boost::program_options::variables_map values_;
};

/// \return the number that the whole text spells. \throws UsageError starting with `name = text`.
double parseNumber(const std::string& name, const std::string& text, const Range& range = {});
std::int64_t parseInteger(const std::string& name, const std::string& text, const Range& range = {});

/// \return the numbers spelled "A,B,C", at least one. \throws UsageError starting with `name = text`.
std::vector<double> parseNumbers(const std::string& name, const std::string& text, const Range& range = {});

/// \return the vector spelled "X,Y,Z", all finite. \throws UsageError starting with `name = text`.
Eigen::Vector3d parseVector(const std::string& name, const std::string& text);

/// \return the choice spelled "auto", "none" or "X,Y,Z". \throws UsageError otherwise.
Viewpoint parseViewpoint(const std::string& name, const std::string& text);

/// Runs the body of a tool and turns what it throws into one line on standard error and an exit code: 0 done (or what
/// the body returns), 1 could not be done, 2 wrong usage.
int runTool(int argc, char** argv, const std::function<int(int argc, char** argv)>& body);

}  // namespace pcl_symmetry::apps
