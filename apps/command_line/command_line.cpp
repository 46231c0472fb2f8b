#include "command_line/command_line.h"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem.hpp>
#include <iostream>
#include <map>
#include <numeric>
#include <sstream>

#include "io/answers.h"
#include "io/file_text.h"
#include "io/shape_output.h"

namespace pcl_symmetry::apps {

namespace po = boost::program_options;

namespace {

/// Former spellings, which are accepted for one version.
const std::map<std::string, std::string> kRenamedFlags{
    {"symmetrise", "symmetrize"}, {"colour", "color"}, {"colour_tolerance", "color_tolerance"}};

/// Groups of the help, in order: what is written, what is read, how it is computed. Flags of only this tool are listed
/// between the first two.
const std::vector<std::pair<std::string, std::vector<std::string>>> kFlagGroups{
    {"Output", {"json", "png", "html", "csv", "support", "profile", "report", "resume"}},
    {"Analysis", {}},
    {"Input", {"viewpoint", "ground", "label", "points", "levels", "surface"}},
    {"Computation", {"grid", "sigma", "seed", "threads", "quiet"}},
    {"Help", {"help", "version"}}};

/// Flags that name files to read; all other flags of files name outputs.
const std::vector<std::string> kReadFlags{"target", "database", "check", "landmarks"};

/// \return number of columns of the terminal, or of a page.
unsigned helpWidth() {
  winsize size{};
  const bool known = ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? std::clamp<unsigned>(size.ws_col, 60, 160) : 100;
}

constexpr std::size_t kHelpColumn = 26;  // where the description of a name begins

/// \return words in lines that fit the terminal, from a column on; the name is before them, or above if it is longer
std::string inColumn(std::string line, std::size_t column, const std::string& words) {
  std::string text;
  if (line.size() + 1 > column && !line.empty()) text = std::exchange(line, "") + "\n";
  line.resize(column, ' ');
  std::istringstream paragraphs(words);
  for (std::string paragraph; std::getline(paragraphs, paragraph); line.assign(column, ' ')) {
    std::istringstream stream(paragraph);
    for (std::string word; stream >> word; line += word + " ") {
      if (line.size() == column || line.size() + word.size() <= helpWidth()) continue;
      text += boost::algorithm::trim_right_copy(line) + "\n";
      line.assign(column, ' ');
    }
    text += boost::algorithm::trim_right_copy(line) + "\n";
  }
  return text;
}

nlohmann::json made_by;  // provenance of the command line that was parsed last

std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row.back();
}

}  // namespace

const nlohmann::json& madeBy() {
  return made_by;
}

CommandLine::CommandLine(std::string tool, std::string summary, std::string example)
    : tool_(std::move(tool)), summary_(std::move(summary)), example_(std::move(example)) {
  flags_.add_options()("help,h", "print this text")("version", "print the version");
}

CommandLine& CommandLine::positionals(const std::string& name, std::vector<std::string>& values,
                                      const std::string& help, bool required) {
  positionals_.push_back({name, help, required, [&values](const std::string& text) { values.push_back(text); }, true});
  return *this;
}

CommandLine& CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  flags_.add_options()(name.c_str(), po::bool_switch(&value), help.c_str());
  return *this;
}

CommandLine& CommandLine::add(const std::string& name, const std::string& placeholder, const std::string& help,
                              Assign assign) {
  if (boost::algorithm::starts_with(placeholder, "FILE")) file_flags_.push_back(name);
  flags_.add_options()(name.c_str(), po::value<std::string>()->value_name(placeholder)->notifier(std::move(assign)),
                       help.c_str());
  return *this;
}

CommandLine& CommandLine::text(const std::string& name, const std::string& placeholder,
                               std::optional<std::string>& value, const std::string& help) {
  const std::string ending = boost::algorithm::starts_with(placeholder, "FILE.") ? placeholder.substr(4) : "";
  return add(name, placeholder, help, [&value, name, ending](const std::string& text) {
    const bool is_checked = !ending.empty() && text != "-";
    if (is_checked && !boost::algorithm::iends_with(text, ending))
      rejectValue("-" + name, text, "must end in " + ending);
    if (text.empty()) throw UsageError("-" + name + " must not be empty");
    if (ending == ".png") findDisplay();
    value = text;
  });
}

CommandLine& CommandLine::choice(const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                                 const std::string& help) {
  const std::string list = boost::algorithm::join(allowed, "|");
  return add(name, list, help + " (" + value + ")", [&value, allowed, list, name](std::string text) {
    if (name == "method" && text == "exact") text = "convolution";  // its name in earlier versions
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end())
      rejectValue("-" + name, text, "must be " + list);
    value = text;
  });
}

CommandLine& CommandLine::plane(const std::string& name, std::optional<Eigen::Vector4d>& value,
                                const std::string& help) {
  return add(name, "A,B,C,D", help, [&value, name](const std::string& text) {
    const std::vector<double> numbers = parseNumbers("-" + name, text);
    if (numbers.size() != 4 || (numbers[0] == 0.0 && numbers[1] == 0.0 && numbers[2] == 0.0))
      rejectValue("-" + name, text, "must be four numbers A,B,C,D, of which A, B and C are not all zero");
    value = Eigen::Vector4d(numbers[0], numbers[1], numbers[2], numbers[3]);
  });
}

template <typename Value>
CommandLine& CommandLine::number(const std::string& name, Value& value, const Range& range, const std::string& help) {
  constexpr bool is_whole = std::is_same_v<Value, int> || std::is_same_v<Value, std::optional<int>>;
  std::string text = help;
  if constexpr (std::is_arithmetic_v<Value>)
    text += is_whole ? " (" + std::to_string(value) + ")" : formatted(" (%g)", static_cast<double>(value));
  return add(name, is_whole ? "N" : "F", text, [&value, range, name](const std::string& given) {
    if constexpr (is_whole)
      value = parseInt("-" + name, given, range);
    else
      value = parseNumber("-" + name, given, range);
  });
}
template CommandLine& CommandLine::number(const std::string&, double&, const Range&, const std::string&);
template CommandLine& CommandLine::number(const std::string&, std::optional<double>&, const Range&, const std::string&);
template CommandLine& CommandLine::number(const std::string&, int&, const Range&, const std::string&);
template CommandLine& CommandLine::number(const std::string&, std::optional<int>&, const Range&, const std::string&);

CommandLine& CommandLine::number(const std::string& name, std::uint64_t& value, const std::string& help) {
  return add(name, "N", help + " (" + std::to_string(value) + ")", [&value, name](const std::string& text) {
    value = static_cast<std::uint64_t>(parseInteger("-" + name, text, Range::atLeast(0)));
  });
}

CommandLine& CommandLine::direction(const std::string& name, std::optional<Eigen::Vector3d>& value,
                                    const std::string& help) {
  return add(name, "X,Y,Z", help, [&value, name](const std::string& text) {
    value = parseVector("-" + name, text);
    if (value->isZero(0.0)) rejectValue("-" + name, text, "must not be zero");
  });
}

CommandLine& CommandLine::common(CommonOptions& options, unsigned flags) {
  if (flags & kMeshPoints)
    number("points", options.mesh_points, Range::closed(100, 10'000'000), "number of points spread over a mesh");
  if (flags & kVolumes) {
    options.takes_volumes = true;
    add("levels", "LOW,HIGH",
        "volumes (.nii, .nii.gz, .nrrd, .nhdr, .mha, .mhd or .vti): intensities that count, as a window of a viewer "
        "(background and brightest voxels)",
        [&options](const std::string& text) {
          options.levels = parseNumbers("-levels", text);
          if (options.levels.size() != 2 || !(options.levels[0] < options.levels[1]))
            rejectValue("-levels", text, "must be LOW,HIGH with LOW < HIGH");
        });
    number("surface", options.surface, Range{}, "volumes: analyze the surface of this intensity as a mesh");
  }
  if (flags & kGrid) number("grid", options.grid, Range::closed(8, 512), "cells along an edge of the distance field");
  if (flags & kSigma)
    number("sigma", options.sigma, Range::above(0), "width of the Gaussian, input units (two cells of the field)");
  if (flags & kViewpoint) {
    add("viewpoint", "auto|none|X,Y,Z", "where the scanner stood, input frame (auto)",
        [&options](const std::string& text) { options.viewpoint = parseViewpoint("-viewpoint", text); });
  }
  if (flags & kSeed) {
    number("seed", options.seed, "start of the random streams");
    seed_ = &options.seed;
  }
  if (flags & kThreads) number("threads", options.threads, Range::closed(0, 4096), "number of threads, 0 = all");
  if (flags & kJson)
    add("json", "FILE", "write the result as JSON", [&options](const std::string& path) {
      checkTarget(path);
      options.json_path = path;
    });
  if (flags & kQuiet) flag("quiet", options.quiet, "print results and errors only");
  return *this;
}

std::string CommandLine::closestFlag(const std::string& unknown) const {
  std::string name = unknown.substr(std::min(unknown.find_first_not_of('-'), unknown.size()));
  name = name.substr(0, name.find('='));
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const auto& flag : flags_.options()) {
    if (name.size() >= 3 && flag->long_name().rfind(name, 0) == 0) return flag->long_name();
    const std::size_t distance = editDistance(name, flag->long_name());
    if (distance >= best_distance) continue;
    best = flag->long_name();
    best_distance = distance;
  }
  return best;
}

const po::option_description* CommandLine::flagNamed(const std::string& argument) const {
  const std::size_t begin = argument.find_first_not_of('-');
  return begin == 1 || begin == 2 ? flags_.find_nothrow(argument.substr(begin), false) : nullptr;
}

bool CommandLine::parse(int argc, const char* const* argv) {
  readTokens(argc, argv);
  if (given("help")) {
    std::cout << usage();
    return false;
  }
  if (given("version")) {
    std::cout << tool_ << " " << PCL_SYMMETRY_VERSION << "\n";
    return false;
  }
  assignPositionals();
  toolName() = tool_;
  checkFiles();
  po::notify(values_);
  goWith("volumes, without -surface", !given("surface"), {"levels"});
  nlohmann::json options = nlohmann::json::object();
  for (const auto& [name, value] : values_) {
    if (!given(name) || name == "positional arguments") continue;
    const auto* const text = boost::any_cast<std::string>(&value.value());
    options[name] = text ? nlohmann::json(*text) : nlohmann::json(true);
  }
  made_by = {{"tool", tool_}, {"version", PCL_SYMMETRY_VERSION}, {"options", options}};
  if (seed_) made_by["seed"] = *seed_;
  return true;
}

void CommandLine::readTokens(int argc, const char* const* argv) {
  po::options_description all;
  all.add(flags_);
  all.add_options()("positional arguments", po::value<std::vector<std::string>>());
  po::positional_options_description order;
  order.add("positional arguments", -1);
  using namespace po::command_line_style;
  values_.clear();
  try {
    const int style = allow_long | long_allow_adjacent | long_allow_next | allow_short | allow_dash_for_short |
                      short_allow_next | allow_long_disguise;
    std::vector<std::string> arguments(argv + std::min(argc, 1), argv + argc);
    for (std::string& argument : arguments) {
      const std::size_t begin = argument.find_first_not_of('-'), end = std::min(argument.find('='), argument.size());
      if (begin == 0 || begin == std::string::npos || begin > end) continue;
      const auto renamed = kRenamedFlags.find(argument.substr(begin, end - begin));
      if (renamed != kRenamedFlags.end()) argument.replace(begin, end - begin, renamed->second);
    }
    for (std::size_t i = 1; i < arguments.size() && arguments[i - 1] != "--"; ++i) {
      const auto *const flag = flagNamed(arguments[i - 1]), *const next = flagNamed(arguments[i]);
      if (flag && next && flag->semantic()->max_tokens() > 0)
        throw UsageError(arguments[i - 1] + " needs a value, but " + arguments[i] + " follows");
    }
    po::store(po::command_line_parser(arguments).options(all).positional(order).style(style).run(), values_);
  } catch (const po::unknown_option& error) {
    const std::string unknown = error.get_option_name();
    const std::string closest = closestFlag(unknown);
    throw UsageError("unknown flag " + unknown + (closest.empty() ? "" : ", did you mean -" + closest + "?"));
  } catch (const po::error& error) {
    throw UsageError(boost::algorithm::replace_all_copy(std::string(error.what()), "'--", "'-"));
  }
}

void CommandLine::assignPositionals() const {
  std::vector<std::string> arguments;
  if (given("positional arguments")) arguments = values_["positional arguments"].as<std::vector<std::string>>();
  const bool repeated = !positionals_.empty() && positionals_.back().repeated;
  if (arguments.size() > positionals_.size() && !repeated)
    throw UsageError("unexpected argument '" + arguments[positionals_.size()] + "'");
  for (std::size_t i = 0; i < std::max(arguments.size(), positionals_.size()); ++i) {
    const Positional& positional = positionals_[std::min(i, positionals_.size() - 1)];
    if (i < arguments.size()) {
      if (arguments[i].empty()) throw UsageError("argument '" + positional.name + "' is empty");
      positional.assign(arguments[i]);
    } else if (positional.required) {
      throw UsageError("missing argument '" + positional.name + "'");
    }
  }
}

void CommandLine::checkFiles() const {
  namespace fs = boost::filesystem;
  struct NamedFile {
    std::string name;
    fs::path path;
    bool is_output;
  };
  std::vector<NamedFile> files;
  const auto add = [&](const std::string& name, const std::string& text, bool is_output) {
    boost::system::error_code ignored;
    const bool is_special = fs::exists(text, ignored) && !fs::is_regular_file(text, ignored);
    if (!isStandardStream(text) && !is_special) files.push_back({name, fs::weakly_canonical(text, ignored), is_output});
  };
  for (const std::string& flag : file_flags_)
    if (given(flag))
      add("-" + flag, values_[flag].as<std::string>(), std::count(kReadFlags.begin(), kReadFlags.end(), flag) == 0);
  if (given("positional arguments")) {
    const auto& arguments = values_["positional arguments"].as<std::vector<std::string>>();
    for (std::size_t i = 0; i < arguments.size(); ++i) {
      const std::string& name = positionals_[std::min(i, positionals_.size() - 1)].name;
      add(name, arguments[i], name == "output" && !given("merge"));  // -merge: all arguments are scans
    }
  }
  for (const NamedFile& output : files)
    for (const NamedFile& other : files)
      if (output.is_output && &other != &output && other.path == output.path)
        throw UsageError(output.path.string() + ": is " + other.name + " and " + output.name +
                         ", an output needs a name of its own");
  for (const NamedFile& output : files)
    if (output.is_output && isForeignShape(output.path.string()))
      throw UsageError(output.path.string() + ": is there and was not written by this tool, so it is not replaced" +
                       (flags_.find_nothrow("merge", false) ? "; -merge FILE brings several scans together" : ""));
}

bool CommandLine::given(const std::string& name) const {
  return values_.count(name) > 0 && !values_[name].defaulted();
}

void CommandLine::goWith(const std::string& what, bool there, std::initializer_list<const char*> flags) const {
  for (const char* flag : flags)
    if (!there && given(flag)) throw UsageError(std::string("-") + flag + " goes with " + what);
}

std::string CommandLine::usage() const {
  std::string synopsis = "Usage: " + tool_;
  for (const Positional& argument : positionals_) {
    if (argument.required) synopsis += " " + argument.name;
    if (!argument.required && !argument.repeated) synopsis += " [" + argument.name + "]";
    if (argument.repeated) synopsis += " [" + argument.name + " ...]";
  }
  std::string text = inColumn("", 0, summary_) + "\n" + inColumn("", 0, synopsis + " [-flag value]") + "\n";
  for (const Positional& argument : positionals_) text += inColumn("  " + argument.name, kHelpColumn, argument.help);
  const auto isGrouped = [](const std::string& flag) {
    return std::any_of(kFlagGroups.begin(), kFlagGroups.end(), [&](const auto& group) {
      return std::count(group.second.begin(), group.second.end(), flag) > 0;
    });
  };
  for (const auto& [name, known] : kFlagGroups) {
    std::string group;
    const auto addFlag = [&group](const po::option_description& flag) {
      const std::string parameter = flag.format_parameter();
      const std::string names = flag.long_name() == "help" ? "h, -help" : flag.long_name();
      group += inColumn("  -" + names + (parameter.empty() ? "" : " " + parameter), kHelpColumn, flag.description());
    };
    for (const std::string& first : known)
      for (const auto& flag : flags_.options())
        if (flag->long_name() == first) addFlag(*flag);
    for (const auto& flag : flags_.options())
      if (known.empty() && !isGrouped(flag->long_name())) addFlag(*flag);
    if (!group.empty()) text += "\n" + name + ":\n" + group;
  }
  return text + "\nExample:\n  " + example_ + "\n";
}

}  // namespace pcl_symmetry::apps
