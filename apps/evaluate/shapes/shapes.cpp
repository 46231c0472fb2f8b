#include "evaluate/shapes/shapes.h"

#include <cstdio>
#include <map>

#include "common/command_line/command_line.h"
#include "common/command_line/console.h"
#include "common/shape_output/shape_output.h"
#include "evaluate/shapes/shape_report.h"
#include "evaluate/shared/model_flags.h"

namespace pcl_symmetry::apps {

namespace {

struct ShapeKind {
  const char* name;
  const char* summary;
  ShapeCases (*cases)(const ShapeRowOptions&);
};

// derived: all kinds of this room.
constexpr ShapeKind kShapeKinds[] = {
    {"folds", "prisms, tubes, rims and cones of 2 to 24 folds, and round bodies", foldCases},
    {"views", "round bodies and balls seen from one side", viewCases},
    {"turns", "axes of round bodies, of folds and of mugs seen from one side", turnCases},
    {"random", "clouds without symmetry", randomCases},
    {"composites", "two symmetric parts stuck together", compositeCases},
    {"counts", "models at 5 000, 20 000 and 100 000 points", pointCountCases}};

struct EvaluateShapesOptions {
  std::string kind;
  std::string half = "tuning";
  std::optional<std::string> folder, csv, journal;
  ShapeRowOptions rows;
  CommonOptions common;
};

CommandLine commandLine(EvaluateShapesOptions& o) {
  CommandLine line(
      "pcl_symmetry_evaluate shapes",
      "Measures decisions on shapes that are made by code: folds, views, turns, random, composites; and counts, "
      "which needs models.",
      "pcl_symmetry_evaluate shapes folds -half report");
  line.positional("KIND", o.kind, "folds, views, turns, random, composites or counts")
      .positional("FOLDER", o.folder, "of models: needed by counts; parts of composites in place of own solids")
      .choice("half", o.half, {"tuning", "report"},
              "half of the shapes: constants are chosen on one, figures given of the other")
      .number("num", o.rows.num, Range::closed(0, 1'000'000), "number of clouds, 0 = about two minutes")
      .number("points", o.rows.num_points, Range::closed(100, 10'000'000), "number of points per cloud")
      .text("csv", "FILE", o.csv, "a row for each cloud");
  ResumableRun::addFlag(line, o.journal);
  addSelectionFlags(line, o.rows.selection);
  line.common(o.common, kJson | kSeed | kThreads | kQuiet);
  return line;
}

}  // namespace

int evaluateShapes(int argc, char** argv, SharedWork& processes) {
  EvaluateShapesOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  ResumableRun work(processes, options.journal, argc, argv);
  const Console console(options.common.quiet || !work.isFirst());
  ShapeRowOptions& rows = options.rows;
  rows.report = options.half == "report";
  if (options.folder) rows.folders = {*options.folder};
  rows.seed = options.common.seed;
  rows.threads = work.threadsOfItem(options.common.threads);
  for (const ShapeKind& kind : kShapeKinds) {
    if (options.kind != kind.name) continue;
    Step step(console, std::string("Evaluating ") + kind.summary);
    const ShapeReport report = measuredCases(kind.cases(rows), work, step);
    if (!work.isFirst()) return 0;
    step.done();
    report.print();
    if (options.csv) writeText(*options.csv, report.csv());
    if (options.common.json_path) writeText(*options.common.json_path, report.json().dump(1) + "\n");
    return 0;
  }
  throw UsageError("KIND = " + options.kind + ", must be one of folds, views, turns, random, composites, counts");
}

}  // namespace pcl_symmetry::apps
