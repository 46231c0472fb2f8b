#include "options.h"

#include <pcl/console/print.h>

#include <algorithm>
#include <boost/algorithm/string.hpp>
#include <boost/filesystem/path.hpp>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <new>
#include <numeric>
#include <sstream>

namespace pcl_symmetry::apps {

namespace po = boost::program_options;

namespace {

std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

[[noreturn]] void reject(const std::string& name, const std::string& value, const std::string& rule) {
  throw UsageError(name + " = " + value + ", " + rule);
}

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

std::string oneLine(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return c == '\n' || c == '\r'; }, ' ');
  boost::algorithm::trim(text);
  return text;
}

}  // namespace

bool Range::contains(double value) const {
  return (min_open ? value > min : value >= min) && (max_open ? value < max : value <= max);
}

std::string Range::rule() const {
  const bool has_min = std::isfinite(min), has_max = std::isfinite(max);
  std::string text = "must be ";
  if (has_min) text += (min_open ? "> " : ">= ") + shortest(min);
  if (has_min && has_max) text += " and ";
  if (has_max) text += (max_open ? "< " : "<= ") + shortest(max);
  return has_min || has_max ? text : "must be a number";
}

double parseNumber(const std::string& name, const std::string& text, const Range& range) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || std::isspace(static_cast<unsigned char>(text[0]))) {
    reject(name, text, "must be a number");
  }
  if (!std::isfinite(value)) reject(name, text, "must be finite");
  if (!range.contains(value)) reject(name, text, range.rule());
  return value;
}

std::int64_t parseInteger(const std::string& name, const std::string& text, const Range& range) {
  char* end = nullptr;
  errno = 0;
  const long long value = std::strtoll(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || std::isspace(static_cast<unsigned char>(text[0]))) {
    reject(name, text, "must be a whole number");
  }
  if (errno == ERANGE) reject(name, text, "is too large");
  if (!range.contains(static_cast<double>(value))) reject(name, text, range.rule());
  return value;
}

std::vector<double> parseNumbers(const std::string& name, const std::string& text, const Range& range) {
  std::vector<std::string> parts;
  boost::algorithm::split(parts, text, boost::is_any_of(","));
  std::vector<double> values;
  for (const std::string& part : parts) values.push_back(parseNumber(name, part, range));
  return values;
}

Eigen::Vector3d parseVector(const std::string& name, const std::string& text) {
  std::vector<std::string> parts;
  boost::algorithm::split(parts, text, boost::is_any_of(","));
  if (parts.size() != 3) reject(name, text, "must be three numbers X,Y,Z");
  Eigen::Vector3d value;
  for (int i = 0; i < 3; ++i) {
    char* end = nullptr;
    value[i] = std::strtod(parts[i].c_str(), &end);
    if (parts[i].empty() || *end != '\0' || !std::isfinite(value[i])) {
      reject(name, text, "must be three finite numbers X,Y,Z");
    }
  }
  return value;
}

Viewpoint parseViewpoint(const std::string& name, const std::string& text) {
  if (text == "auto") return {};
  if (text == "none") return {Viewpoint::Mode::None, Eigen::Vector3d::Zero()};
  try {
    return {Viewpoint::Mode::Given, parseVector(name, text)};
  } catch (const UsageError&) {
    reject(name, text, "must be auto, none or X,Y,Z");
  }
}

CommandLine::CommandLine(std::string tool, std::string summary, std::string example)
    : tool_(std::move(tool)), summary_(std::move(summary)), example_(std::move(example)) {
  flags_.add_options()("help,h", "print this text");
  flag_names_.push_back("help");
}

CommandLine& CommandLine::positional(const std::string& name, std::string& value, const std::string& help) {
  positionals_.push_back({name, help, true, [&value](const std::string& text) { value = text; }});
  return *this;
}

CommandLine& CommandLine::positional(const std::string& name, std::optional<std::string>& value,
                                     const std::string& help) {
  positionals_.push_back({name, help, false, [&value](const std::string& text) { value = text; }});
  return *this;
}

CommandLine& CommandLine::positionals(const std::string& name, std::vector<std::string>& values,
                                      const std::string& help) {
  positionals_.push_back({name, help, true, [&values](const std::string& text) { values.push_back(text); }, true});
  return *this;
}

CommandLine& CommandLine::flag(const std::string& name, bool& value, const std::string& help) {
  flags_.add_options()(name.c_str(), help.c_str());
  flag_names_.push_back(name);
  switches_.emplace_back(name, &value);
  return *this;
}

CommandLine& CommandLine::add(const std::string& name, const std::string& placeholder, const std::string& help,
                              std::function<void(const std::string&)> assign) {
  flags_.add_options()(name.c_str(), po::value<std::string>()->value_name(placeholder), help.c_str());
  flag_names_.push_back(name);
  assignments_.emplace_back(name, std::move(assign));
  return *this;
}

CommandLine& CommandLine::text(const std::string& name, const std::string& placeholder,
                               std::optional<std::string>& value, const std::string& help) {
  return add(name, placeholder, help, [&value, name](const std::string& text) {
    if (text.empty()) throw UsageError("-" + name + " must not be empty");
    value = text;
  });
}

CommandLine& CommandLine::choice(const std::string& name, std::string& value, const std::vector<std::string>& allowed,
                                 const std::string& help) {
  const std::string list = boost::algorithm::join(allowed, "|");
  return add(name, list, help + " (" + value + ")", [&value, allowed, list, name](const std::string& text) {
    if (std::find(allowed.begin(), allowed.end(), text) == allowed.end()) reject("-" + name, text, "must be " + list);
    value = text;
  });
}

CommandLine& CommandLine::number(const std::string& name, double& value, const Range& range, const std::string& help) {
  return add(name, "F", help + " (" + shortest(value) + ")",
             [&value, range, name](const std::string& text) { value = parseNumber("-" + name, text, range); });
}

CommandLine& CommandLine::number(const std::string& name, std::optional<double>& value, const Range& range,
                                 const std::string& help) {
  return add(name, "F", help,
             [&value, range, name](const std::string& text) { value = parseNumber("-" + name, text, range); });
}

namespace {

int parseInt(const std::string& name, const std::string& text, const Range& range) {
  const std::int64_t value = parseInteger(name, text, range);
  if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max()) {
    reject(name, text, "is too large");
  }
  return static_cast<int>(value);
}

}  // namespace

CommandLine& CommandLine::number(const std::string& name, int& value, const Range& range, const std::string& help) {
  return add(name, "N", help + " (" + std::to_string(value) + ")",
             [&value, range, name](const std::string& text) { value = parseInt("-" + name, text, range); });
}

CommandLine& CommandLine::number(const std::string& name, std::optional<int>& value, const Range& range,
                                 const std::string& help) {
  return add(name, "N", help,
             [&value, range, name](const std::string& text) { value = parseInt("-" + name, text, range); });
}

CommandLine& CommandLine::number(const std::string& name, std::uint64_t& value, const std::string& help) {
  return add(name, "N", help + " (" + std::to_string(value) + ")", [&value, name](const std::string& text) {
    value = static_cast<std::uint64_t>(parseInteger("-" + name, text, Range::atLeast(0)));
  });
}

CommandLine& CommandLine::numbers(const std::string& name, std::vector<double>& values, const Range& range,
                                  const std::string& help) {
  std::vector<std::string> defaults;
  for (const double value : values) defaults.push_back(shortest(value));
  return add(name, "A,B,...", help + " (" + boost::algorithm::join(defaults, ",") + ")",
             [&values, range, name](const std::string& text) { values = parseNumbers("-" + name, text, range); });
}

CommandLine& CommandLine::vector(const std::string& name, std::optional<Eigen::Vector3d>& value,
                                 const std::string& help) {
  return add(name, "X,Y,Z", help, [&value, name](const std::string& text) { value = parseVector("-" + name, text); });
}

CommandLine& CommandLine::common(CommonOptions& options, unsigned flags) {
  if (flags & kGrid) number("grid", options.grid, Range::closed(8, 512), "cells along an edge of the distance field");
  if (flags & kViewpoint) {
    add("viewpoint", "auto|none|X,Y,Z", "where the scanner stood, input frame (auto)",
        [&options](const std::string& text) { options.viewpoint = parseViewpoint("-viewpoint", text); });
  }
  if (flags & kSeed) number("seed", options.seed, "start of the random streams");
  if (flags & kThreads) number("threads", options.threads, Range::closed(0, 4096), "number of threads, 0 = all");
  if (flags & kJson) text("json", "FILE", options.json_path, "write the result as JSON");
  if (flags & kQuiet) flag("quiet", options.quiet, "print errors only");
  return *this;
}

std::string CommandLine::closestFlag(const std::string& unknown) const {
  std::string name = unknown.substr(std::min(unknown.find_first_not_of('-'), unknown.size()));
  name = name.substr(0, name.find('='));
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, name.size() / 3) + 1;
  for (const std::string& candidate : flag_names_) {
    const std::size_t distance = editDistance(name, candidate);
    if (distance < best_distance) {
      best = candidate;
      best_distance = distance;
    }
  }
  return best;
}

bool CommandLine::parse(int argc, const char* const* argv) {
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
    po::store(po::command_line_parser(argc, argv).options(all).positional(order).style(style).run(), values_);
  } catch (const po::unknown_option& error) {
    const std::string unknown = error.get_option_name();
    const std::string closest = closestFlag(unknown);
    throw UsageError("unknown flag " + unknown + (closest.empty() ? "" : ", did you mean -" + closest + "?"));
  } catch (const po::error& error) {
    throw UsageError(error.what());
  }
  if (values_.count("help")) {
    std::cout << usage();
    return false;
  }

  std::vector<std::string> arguments;
  if (values_.count("positional arguments")) {
    arguments = values_["positional arguments"].as<std::vector<std::string>>();
  }
  const bool repeated = !positionals_.empty() && positionals_.back().repeated;
  if (arguments.size() > positionals_.size() && !repeated) {
    throw UsageError("unexpected argument '" + arguments[positionals_.size()] + "'");
  }
  for (std::size_t i = 0; i < std::max(arguments.size(), positionals_.size()); ++i) {
    const Positional& positional = positionals_[std::min(i, positionals_.size() - 1)];
    if (i < arguments.size()) {
      if (arguments[i].empty()) throw UsageError("argument '" + positional.name + "' is empty");
      positional.assign(arguments[i]);
    } else if (positional.required) {
      throw UsageError("missing argument '" + positional.name + "'");
    }
  }
  for (const auto& [name, target] : switches_) {
    if (values_.count(name)) *target = true;
  }
  for (const auto& [name, assign] : assignments_) {
    if (values_.count(name)) assign(values_[name].as<std::string>());
  }
  return true;
}

bool CommandLine::given(const std::string& name) const {
  return values_.count(name) > 0;
}

std::string CommandLine::usage() const {
  std::ostringstream text;
  text << summary_ << "\n\nUsage: " << tool_;
  for (const Positional& argument : positionals_) {
    text << (argument.required ? " " + argument.name : " [" + argument.name + "]");
    if (argument.repeated) text << " [" << argument.name << " ...]";
  }
  text << " [-flag value]\n\n";
  std::size_t width = 0;
  for (const Positional& argument : positionals_) width = std::max(width, argument.name.size());
  for (const Positional& argument : positionals_) {
    text << "  " << argument.name << std::string(width - argument.name.size() + 2, ' ') << argument.help << "\n";
  }
  std::ostringstream flags;
  flags << flags_;
  text << "\n" << boost::algorithm::replace_all_copy(flags.str(), " --", " -") << "\nExample:\n  " << example_ << "\n";
  return text.str();
}

int runTool(int argc, char** argv, const std::function<int(int, char**)>& body) {
  const std::string tool = argc > 0 ? boost::filesystem::path(argv[0]).filename().string() : "pcl_symmetry";
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  const auto fail = [&tool](const std::string& message, int code) {
    std::cerr << tool << ": " << oneLine(message) << std::endl;
    return code;
  };
  try {
    return body(argc, argv);
  } catch (const UsageError& error) {
    return fail(std::string(error.what()) + " (see " + tool + " -h)", 2);
  } catch (const std::bad_alloc&) {
    return fail("not enough memory", 1);
  } catch (const std::exception& error) {
    return fail(error.what(), 1);
  } catch (...) {
    return fail("stopped by an error of unknown type", 1);
  }
}

}  // namespace pcl_symmetry::apps
