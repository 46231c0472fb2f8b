/// How near each stage comes to the least time that its result could take on this machine.
///
/// The least time of a stage is the sum of the steps that its result needs, whatever the algorithm (look-ups, nearest
/// neighbours, bytes), each at the speed that a loop of nothing else reaches.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <fstream>
#include <stdexcept>
#include <string>

#include "speed/machine_kernels.h"
#include "speed/roofline_stages.h"

namespace {

using namespace pcl_symmetry::benchmarks;

constexpr int kNumRepeats = 15;  // chosen: half leaves the least times apart by a tenth, twice takes twice the time

double leastMillisecondsOf(const Work& work, const std::vector<MachineStep>& machine) {
  double nanoseconds = 0.0;
  for (std::size_t i = 0; i < work.size(); ++i) nanoseconds += work[i] * machine[i].nanoseconds;
  return 1e-6 * nanoseconds;
}

void print(const std::vector<Stage>& stages, const std::vector<MachineStep>& machine) {
  std::printf("| step | ns |\n|---|---|\n");
  for (const MachineStep& step : machine) std::printf("| %s | %.3g |\n", step.name.c_str(), step.nanoseconds);
  std::printf(
      "\n| | stage, one thread | steps, thousands | least ms | measured ms | share |\n|---|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < stages.size(); ++i) {
    std::string steps;
    for (std::size_t s = 0; s < machine.size(); ++s) {
      if (stages[i].work[s] < 500.0) continue;
      char text[96];
      std::snprintf(text, sizeof text, "%s%.0f %s", steps.empty() ? "" : ", ", 1e-3 * stages[i].work[s],
                    machine[s].name.c_str());
      steps += text;
    }
    const double least = leastMillisecondsOf(stages[i].work, machine);
    std::printf("| %zu | %s | %s | %.2f | %.2f | %.0f %% |\n", i + 1, stages[i].name.c_str(), steps.c_str(), least,
                stages[i].milliseconds, 100.0 * least / stages[i].milliseconds);
  }
}

/// Two bars for each stage on a logarithmic scale, as an SVG: any browser shows it.
void draw(const std::vector<Stage>& stages, const std::vector<MachineStep>& machine, const std::string& file) {
  constexpr double kLeft = 330.0, kDecade = 110.0, kRow = 34.0, kTop = 60.0,
                   kLeastShown = 0.01;  // pixels; milliseconds
  const auto x = [=](double ms) { return kLeft + kDecade * std::log10(std::max(ms, kLeastShown) / kLeastShown); };
  const double width = x(1000.0) + 90.0, height = kTop + kRow * static_cast<double>(stages.size()) + 20.0;
  std::ofstream out(file);
  out << "<svg xmlns='http://www.w3.org/2000/svg' width='" << width << "' height='" << height
      << "' font-family='sans-serif' font-size='13'>\n<rect width='100%' height='100%' fill='white'/>\n"
      << "<text x='10' y='24' font-size='15'>Processor time of one thread [ms]: <tspan fill='#3b6ea5'>the least that "
         "the "
         "result needs</tspan>, <tspan fill='#b0763a'>measured</tspan></text>\n";
  for (double ms = kLeastShown; ms < 2000.0; ms *= 10.0)
    out << "<line x1='" << x(ms) << "' x2='" << x(ms) << "' y1='" << kTop - 6.0 << "' y2='" << height - 16.0
        << "' stroke='#ccc'/><text x='" << x(ms) << "' y='" << kTop - 10.0 << "' text-anchor='middle'>" << ms
        << "</text>\n";
  double y = kTop;
  for (const Stage& stage : stages) {
    const double least = leastMillisecondsOf(stage.work, machine);
    const auto bar = [&](double ms, double top, const char* color) {
      out << "<rect x='" << kLeft << "' y='" << top << "' width='" << std::max(1.0, x(ms) - kLeft)
          << "' height='11' fill='" << color << "'/>\n";
    };
    bar(least, y + 2.0, "#3b6ea5");
    bar(stage.milliseconds, y + 14.0, "#d9a066");
    out << "<text x='" << kLeft - 8.0 << "' y='" << y + 18.0 << "' text-anchor='end'>" << stage.name
        << "</text><text x='" << x(stage.milliseconds) + 6.0 << "' y='" << y + 24.0 << "'>"
        << std::lround(100.0 * least / stage.milliseconds) << " %</text>\n";
    y += kRow;
  }
  out << "</svg>\n";
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

int run(int argc, char** argv) {
  const bool asked = argc == 2 && (std::string(argv[1]) == "-h" || std::string(argv[1]) == "--help");
  if (asked || argc > 2) {
    std::fprintf(asked ? stdout : stderr,
                 "usage: benchmark_roofline [FILE.svg]\n\nPrints the least time that the results of the stages need on "
                 "this machine, and the time they take;\nFILE.svg is a chart of the table. The model is the cow of the "
                 "folder in PCL_SYMMETRY_MODELS, or a synthetic animal.\n");
    return asked ? 0 : 2;
  }
  // The second of the models is the cow, the fourth of the synthetic ones has four legs: both have one plane.
  const char* folder = std::getenv("PCL_SYMMETRY_MODELS");
  const Model model = fiveModels(folder ? folder : "")[folder ? 1 : 3];
  const std::vector<MachineStep> machine = measureMachine();
  const std::vector<Stage> stages = measureStages(model, kNumRepeats);
  print(stages, machine);
  if (argc == 2) draw(stages, machine, argv[1]);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "benchmark_roofline: %s\n", error.what());
    return 1;
  }
}
