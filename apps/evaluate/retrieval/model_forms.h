/// What the ways of retrieval compare of one model, and its way from one process to another.
#pragma once

#include <Eigen/Core>
#include <string>

#include "core/descriptors/symmetry_descriptor.h"
#include "pcl_symmetry/core/geometry/point_set.h"

namespace pcl_symmetry::apps {

/// Axes that a model is described in.
enum class ModelAxes { AsGiven, Symmetry, Principal };

/// \return e.g. "symmetry axes".
std::string nameOf(ModelAxes axes);

/// The paper's descriptors in one frame, about the center of mass.
SymmetryDescriptors publishedForms(const Points& cloud, ModelAxes axes);

/// Descriptors that can be turned to all orders and signs of their axes: a column for each frame of the model.
struct TurnableForms {
  Eigen::MatrixXf prst, gedt, signatures;
};

TurnableForms turnableForms(const Points& cloud);

std::string packed(const SymmetryDescriptors& forms);
std::string packed(const TurnableForms& forms);
/// \throws std::invalid_argument for bytes that packed() did not make.
void unpack(const std::string& bytes, SymmetryDescriptors& forms);
void unpack(const std::string& bytes, TurnableForms& forms);

}  // namespace pcl_symmetry::apps
