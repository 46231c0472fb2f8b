/// Compares the symmetries that a file lists for a model with those of its surface.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "bop/models_info.h"
#include "bop/surface_evidence.h"

namespace pcl_symmetry::apps {

/// Turns on which a file and the surface disagree.
struct Disagreement {
  std::string says;         ///< "file only" or "surface only"
  Eigen::Vector3d axis;     ///< unit, input frame
  Eigen::Vector3d point;    ///< of the axis, input frame
  double angle = 0.0;       ///< radians; 0: any angle
  MotionEvidence evidence;  ///< of the turn; of any angle: of the worst of eight turns
};

struct SymmetryCheck {
  std::string file_group;     ///< such as D2; empty where the file's motions are no group
  std::string surface_group;  ///< such as D4
  std::string remark;         ///< what is wrong with the list itself, such as rotations that it lacks; may be empty
  std::vector<Disagreement> disagreements;

  bool agrees() const { return remark.empty() && disagreements.empty(); }
};

/// \param found symmetries of the surface.
/// \param diameter of the model, input units. Turns that differ by up to 2 % of it at every point are one.
SymmetryCheck checkSymmetries(const ListedSymmetries& listed, const ObjectSymmetries& found,
                              const SurfaceEvidence& surface, double diameter);

nlohmann::ordered_json toJson(const SymmetryCheck& check, double diameter);

/// \param name of the model.
void printCheck(const std::string& name, const SymmetryCheck& check, double diameter);

}  // namespace pcl_symmetry::apps
