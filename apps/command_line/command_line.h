/// The command line that all tools share: single- and double-dash flags, checked values, usage with an example; and the
/// flags that mean the same in every tool.
#pragma once

#include <Eigen/Core>
#include <boost/program_options.hpp>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "command_line/flag_values.h"
#include "pcl_symmetry/core/symmetry_map.h"
#include "pcl_symmetry/viewpoint.h"

namespace pcl_symmetry::apps {

/// The values of the flags that have the same meaning in every tool.
struct CommonOptions {
  std::optional<std::string> json_path;
  std::uint64_t seed = 1;
  int threads = 0;              ///< 0 = all
  int grid = 64;                ///< cells along an edge of the distance field
  std::optional<double> sigma;  ///< width of the Gaussian, input units; none: two cells
  int mesh_points = 10'000;     ///< number of points spread over a mesh
  Viewpoint viewpoint;
  bool takes_volumes = false;     ///< whether the tool analyzes volumes
  std::vector<double> levels;     ///< range of intensities of volumes, two values; empty: chosen from the values
  std::optional<double> surface;  ///< intensity whose surface is analyzed in place of the volume
  bool quiet = false;

  /// Sets seed, threads, grid and sigma of the library's options, e.g. DetectionOptions or FrameOptions.
  template <typename Options>
  void applyTo(Options& options) const {
    options.seed = seed;
    options.num_threads = threads;
    options.num_cells = grid;
    options.sigma = sigma.value_or(0.0);
  }
};

/// The estimators of the transform.
inline const std::vector<std::string> kMethodNames{"sampled", "convolution", "rotational", "voting"};

/// \param name one of kMethodNames.
inline TransformMethod methodNamed(const std::string& name) {
  return name == "convolution"  ? TransformMethod::Convolution
         : name == "rotational" ? TransformMethod::Rotational
         : name == "voting"     ? TransformMethod::Voting
                                : TransformMethod::Sampled;
}

/// Number of points spread over a mesh by the tools of the database, where a model is described once and queried often.
constexpr int kDatabaseMeshPoints = 20'000;

/// Which of the common flags a tool offers.
enum CommonFlag : unsigned {
  kJson = 1u << 0,
  kSeed = 1u << 1,
  kThreads = 1u << 2,
  kGrid = 1u << 3,
  kViewpoint = 1u << 4,
  kQuiet = 1u << 5,
  kSigma = 1u << 6,
  kMeshPoints = 1u << 7,
  kVolumes = 1u << 8,
  kAnalysisFlags = (1u << 6) - 1,             ///< all flags except -sigma and -points
  kShapeFlags = kAnalysisFlags | kMeshPoints  ///< flags of tools that analyze one cloud or mesh
};

/// \return the provenance in the JSON of a tool: tool, version, seed, and the options given.
const nlohmann::json& madeBy();

/// Declares the flags of a tool, each bound to a variable that holds its default, and reads them from argv.
/// The bound variables must outlive parse().
class CommandLine {
public:
  /// \param tool name of the program
  /// \param summary one sentence
  /// \param example a complete command
  CommandLine(std::string tool, std::string summary, std::string example);

  /// Arguments without a flag, in the order of declaration; required ones come first.
  /// \param value std::string of a required argument, or an optional of it.
  template <typename Value>
  CommandLine& positional(const std::string& name, Value& value, const std::string& help) {
    constexpr bool is_required = std::is_same_v<Value, std::string>;
    positionals_.push_back({name, help, is_required, [&value](const std::string& text) { value = text; }});
    return *this;
  }
  /// All following arguments, to the end of the command line, at least one if they are required; declared last.
  CommandLine& positionals(const std::string& name, std::vector<std::string>& values, const std::string& help,
                           bool required = true);

  CommandLine& flag(const std::string& name, bool& value, const std::string& help);
  /// \param placeholder in the help; FILE.png and FILE.html also name how the value must end, unless it is "-".
  CommandLine& text(const std::string& name, const std::string& placeholder, std::optional<std::string>& value,
                    const std::string& help);
  CommandLine& choice(const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                      const std::string& help);
  /// \param value double, int, or an optional of these, whose help states the default.
  template <typename Value>
  CommandLine& number(const std::string& name, Value& value, const Range& range, const std::string& help);
  CommandLine& number(const std::string& name, std::uint64_t& value, const std::string& help);
  /// A vector that must not be zero.
  CommandLine& direction(const std::string& name, std::optional<Eigen::Vector3d>& value, const std::string& help);
  /// A plane a x + b y + c z + d = 0.
  CommandLine& plane(const std::string& name, std::optional<Eigen::Vector4d>& value, const std::string& help);
  CommandLine& common(CommonOptions& options, unsigned flags);

  /// Reads the arguments into the bound variables.
  /// \return false if -h or -version was given: the text is then on standard output, and the tool has nothing more to
  /// do
  /// \throws UsageError naming flag, value and rule
  bool parse(int argc, const char* const* argv);

  /// \return true if the flag was on the parsed command line
  bool given(const std::string& name) const;

  /// Rejects flags that would have no effect.
  /// \param there whether the flag that they belong to was given
  /// \throws UsageError for the first of the flags that was given without it
  void goWith(const std::string& what, bool there, std::initializer_list<const char*> flags) const;

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

  CommandLine& add(const std::string& name, const std::string& placeholder, const std::string& help, Assign assign);
  std::string closestFlag(const std::string& unknown) const;
  /// \return the flag that an argument names in full; null if it is a value or not a flag of this tool.
  const boost::program_options::option_description* flagNamed(const std::string& argument) const;
  void readTokens(int argc, const char* const* argv);
  void assignPositionals() const;
  /// Rejects an output that is an input or another output.
  void checkFiles() const;

  std::string tool_, summary_, example_;
  std::vector<Positional> positionals_;
  std::vector<std::string> file_flags_;
  const std::uint64_t* seed_ = nullptr;  // seed of a tool that draws random numbers
  boost::program_options::options_description flags_;
  boost::program_options::variables_map values_;
};

}  // namespace pcl_symmetry::apps
