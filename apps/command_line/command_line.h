/// The command line that all tools share: single- and double-dash flags, checked values, usage with an example.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "command_line/common_options.h"
#include "command_line/flag_values.h"

namespace pcl_symmetry::apps {

/// Declares the flags of a tool, each bound to a variable that holds its default, and reads them from argv.
/// The bound variables must outlive parse().
class CommandLine {
public:
  /// \param tool name of the program
  /// \param summary one sentence
  /// \param example a complete command
  CommandLine(std::string tool, std::string summary, std::string example);
  ~CommandLine();
  CommandLine(CommandLine&& other) noexcept;
  CommandLine& operator=(CommandLine&& other) noexcept;

  /// Arguments without a flag, in the order of declaration; required ones come first.
  CommandLine& positional(const std::string& name, std::string& value, const std::string& help);
  CommandLine& positional(const std::string& name, std::optional<std::string>& value, const std::string& help);
  /// One or more, to the end of the command line; declared last.
  CommandLine& positionals(const std::string& name, std::vector<std::string>& values, const std::string& help);

  CommandLine& flag(const std::string& name, bool& value, const std::string& help);
  CommandLine& text(const std::string& name, const std::string& placeholder, std::optional<std::string>& value,
                    const std::string& help);
  /// The name of a picture to write; must end in .png, or be "-" for standard output.
  CommandLine& picture(const std::string& name, std::optional<std::string>& value, const std::string& help);
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
  /// A vector that must not be zero.
  CommandLine& direction(const std::string& name, std::optional<Eigen::Vector3d>& value, const std::string& help);
  /// A plane a x + b y + c z + d = 0.
  CommandLine& plane(const std::string& name, std::optional<Eigen::Vector4d>& value, const std::string& help);
  CommandLine& common(CommonOptions& options, unsigned flags);

  /// Reads the arguments into the bound variables.
  /// \return false if -h or -version was given: the text is then on standard output and the tool is done
  /// \throws UsageError naming flag, value and rule
  bool parse(int argc, const char* const* argv);

  /// \return true if the flag stood on the parsed command line
  bool given(const std::string& name) const;

  /// \return synopsis, flags with their defaults, and the example
  std::string usage() const;

private:
  using Assign = std::function<void(const std::string&)>;
  struct Positional {
    std::string name;
    std::string help;
    bool required;
    Assign assign;
    bool repeated = false;
  };
  struct Parser;  ///< Boost.Program_options, which the tools need not see

  CommandLine& add(const std::string& name, const std::string& placeholder, const std::string& help, Assign assign);
  std::string closestFlag(const std::string& unknown) const;
  void readTokens(int argc, const char* const* argv);
  void assignPositionals() const;
  void assignFlags() const;

  std::string tool_, summary_, example_;
  std::vector<Positional> positionals_;
  std::vector<std::string> flag_names_;
  std::unique_ptr<Parser> parser_;
};

/// Prints the name of a tool and the version of the library, e.g. "pcl_symmetry_planes 0.1.0".
void printVersion(const std::string& tool);

}  // namespace pcl_symmetry::apps
