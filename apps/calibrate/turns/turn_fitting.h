/// The numbers of the confidence of turns of scans by logistic regression, and the C++ header that holds them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "evaluate/rotations/meshes/scan_turns.h"

namespace pcl_symmetry::apps {

/// By TurnKind. derived: its names.
constexpr std::array<const char*, 3> kTurnKinds{"by any angle", "half turns", "of order 3 and more"};

/// The numbers of one kind of turns.
struct TurnFit {
  Eigen::VectorXd coefficients;  ///< of turnOddsTerms()
  int num_right = 0, num_wrong = 0;
};

/// By TurnKind. Half turns are fitted to meshes alone.
/// \throws InputError where a kind has no turns that are symmetries, or nothing else.
std::array<TurnFit, 3> fitTurns(const std::vector<JudgedTurn>& turns);

double confidenceOf(const JudgedTurn& one, const std::array<TurnFit, 3>& fit);

/// The text of src/core/detection/scan_axes/turn_confidence_fit.h.
std::string headerText(const std::array<TurnFit, 3>& fit);

}  // namespace pcl_symmetry::apps
