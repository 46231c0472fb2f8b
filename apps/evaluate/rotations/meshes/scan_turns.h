/// What the turns that are found in single scans really map off the mesh, by exact distances: how far their confidence
/// can be trusted.
#pragma once

#include <string>
#include <vector>

#include "core/detection/scan_axes/turn_signs.h"
#include "evaluate/shared/model_list.h"
#include "pcl_symmetry/core/detection/plane_detection.h"

namespace pcl_symmetry::apps {

/// Turns that were found in a scan, and what is true of them on the whole mesh.
struct JudgedTurn {
  /// Point and direction in the frame of the scan.
  SymmetryTurn turn{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()};
  TurnSigns signs;
  bool of_solid = false;  ///< made by code
  double excess = 0.0;    ///< the greater of the true shares over what RotationLimits allow of each

  bool isRight() const { return excess <= 1.0; }
};

/// Turns of scans of a model from random sides, whatever their confidence.
/// \param num_views scans, each judged on its own.
/// \throws InputError where the file has no faces; std::invalid_argument where they have no area.
std::vector<JudgedTurn> judgedTurns(const Model& model, int num_views);

/// The same for one scan of a solid made by code: see turningScan().
/// \param i which solid and view.
std::vector<JudgedTurn> judgedTurnsOfSolid(int i, bool report);

/// How a table calls a solid.
std::string solidName(int i);

/// A row for each turn, from which calibrate_turns can fit.
/// \param names of what each list of turns is of.
std::string turnTable(const std::vector<std::string>& names, const std::vector<std::vector<JudgedTurn>>& turns);

/// \throws InputError naming the file and the line.
std::vector<JudgedTurn> readTurnTable(const std::string& path);

std::string packed(const std::vector<JudgedTurn>& judged);
/// \throws std::invalid_argument for bytes that packed() did not make.
std::vector<JudgedTurn> unpackedTurns(const std::string& bytes);

}  // namespace pcl_symmetry::apps
