/// The numbers of the decision by logistic regression, and the C++ header that holds them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <string>
#include <vector>

#include "calibrate/planes/evidence_samples.h"

namespace pcl_symmetry::apps {

/// Shares of the surface: a symmetry has at least the first, an asymmetric plane less than the second. derived: the
/// definition (evidence/README.md).
constexpr double kSymmetric = 0.97, kAsymmetric = 0.90;
/// By EvidenceKind. derived: its names.
constexpr std::array<const char*, 3> kKindNames{"surface", "scan", "volume"};

/// The numbers of one kind of evidence.
struct KindFit {
  Eigen::VectorXd coefficients;  ///< of logOddsTerms()
  ShareInterval share_errors{};  ///< 95 of 100 lie between, units of shareUnit()
  int num_symmetric = 0, num_asymmetric = 0;
};

using DecisionFit = std::array<KindFit, 3>;

/// Whether the plane is at a symmetry of the mesh, within the limits of a right answer: what a scan or a cut hides
/// leaves right planes a little off. Where points resolve no surface, the plane itself has to be a symmetry: noise
/// hides small asymmetries, and with the limits 9 in place of 7 of 84 noisy clouds of asymmetric models of fold 0 are
/// called symmetric.
bool isSymmetry(const EvidenceSample& sample);

/// \param samples those of one cloud side by side; PlaneEvidence::further is set as the fit has it.
/// \throws InputError where a kind has no symmetries or nothing else.
DecisionFit fitDecision(std::vector<EvidenceSample>& samples, const EvidenceUnits& units = {});

/// What a form of the log odds is worth: each plane is judged by a fit to the other models.
/// \param num_parts >= 2, of the models, in turn by name.
/// \return mean negative log likelihood of the planes with their weights in the fit, nats, by EvidenceKind.
/// \throws InputError as fitDecision().
std::array<double, 3> crossValidation(const std::vector<EvidenceSample>& samples, int num_parts);

/// Log odds of a fit that may differ from that of the library.
double logOdds(const PlaneEvidence& evidence, const DecisionFit& fit, const EvidenceUnits& units = {});

/// The text of src/core/evidence/confidence_fit.h.
/// \param tolerance share of the diameter.
std::string headerText(const DecisionFit& fit, std::size_t num_models, double tolerance);

}  // namespace pcl_symmetry::apps
