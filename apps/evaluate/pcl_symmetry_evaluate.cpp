/// Measures the methods of this library, and those of others, on data with known answers.
#include <cstdio>
#include <string>

#include "common/command_line/command_line.h"
#include "common/command_line/run_tool.h"
#include "common/processes/shared_work.h"
#include "evaluate/frames/alignment.h"
#include "evaluate/planes/planes.h"
#include "evaluate/recognition/recognition.h"
#include "evaluate/registration/registration.h"
#include "evaluate/retrieval/retrieval.h"
#include "evaluate/rotations/rotations.h"
#include "evaluate/scenes/scenes.h"
#include "evaluate/segmentation/segmentation.h"
#include "evaluate/shapes/shapes.h"

namespace {

using namespace pcl_symmetry::apps;

struct SubCommand {
  const char* name;
  const char* summary;
  int (*run)(int argc, char** argv, SharedWork& processes);
};

// derived: all rooms of the folder that are a sub-command.
constexpr SubCommand kSubCommands[] = {
    {"planes", "how well symmetry planes are found", evaluatePlanes},
    {"alignment", "how well the frames of scans agree with those of whole models", evaluateAlignment},
    {"recognition", "how well a scan tells which model of a database it shows", evaluateRecognition},
    {"registration", "how well scans are brought to models of their objects", evaluateRegistration},
    {"retrieval", "how well shapes find others of their class", evaluateRetrieval},
    {"rotations", "how well groups of rotations of solids are found", evaluateRotations},
    {"segmentation", "how close segmentations come to those that people made", evaluateSegmentation},
    {"scenes", "planes and models of objects among others, seen by a depth camera", evaluateScenes},
    {"shapes", "decisions on shapes made by code: folds, views, random clouds, composites", evaluateShapes}};

void printUsage() {
  std::printf(
      "Measures how well symmetries are found and shapes are cut into parts, on data with known answers.\n\n"
      "Usage: pcl_symmetry_evaluate COMMAND [-flag value]\n\n");
  for (const SubCommand& command : kSubCommands) std::printf("  %-14s %s\n", command.name, command.summary);
  std::printf(
      "\nThe processes that mpirun or srun starts share the work.\n"
      "\npcl_symmetry_evaluate COMMAND -h tells the flags of a command.\n\nExample:\n"
      "  pcl_symmetry_evaluate planes meshes -csv clouds.csv\n");
}

int run(int argc, char** argv, SharedWork& processes) {
  if (argc < 2) throw UsageError("missing argument 'COMMAND'");
  const std::string name = argv[1];
  if (name == "-h" || name == "-help" || name == "--help") {
    printUsage();
    return 0;
  }
  if (name == "-version" || name == "--version") {
    printVersion("pcl_symmetry_evaluate");
    return 0;
  }
  for (const SubCommand& command : kSubCommands)
    if (name == command.name) return command.run(argc - 1, argv + 1, processes);
  throw UsageError("unknown command '" + name + "'");
}

}  // namespace

int main(int argc, char** argv) {
  SharedWork processes;
  return processes.end(runTool(argc, argv, [&](int count, char** words) { return run(count, words, processes); }));
}
