#include "evaluate/retrieval/retrieval_methods.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "common/scanner/virtual_scanner.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "core/descriptors/symmetry_descriptor.h"
#include "core/descriptors/turnable_gedt.h"
#include "core/descriptors/turnable_prst.h"
#include "core/geometry/axis_rotations.h"
#include "core/geometry/principal_axes.h"
#include "core/matching/reference_scaling.h"
#include "core/matching/shape_description.h"
#include "core/matching/signature_projection.h"
#include "pcl_symmetry/recognition/symmetry_database.h"

namespace pcl_symmetry::apps {

namespace {

/// Calls work(i) for every model, on all cores, a model on one.
void forEachModel(std::size_t size, const RetrievalOptions& options, const RetrievalProgress& progress,
                  const std::function<void(std::size_t)>& work) {
  std::atomic<std::size_t> done{0};
  parallelBlocks(size, options.num_threads, [&](std::size_t i) {
    work(i);
    progress(static_cast<double>(++done) / static_cast<double>(size));
  });
}

/// \param distance of two models, called for each pair once.
Eigen::MatrixXf symmetricDistances(std::size_t size, int num_threads,
                                   const std::function<float(std::size_t, std::size_t)>& distance) {
  Eigen::MatrixXf distances = Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(size), static_cast<Eigen::Index>(size));
  parallelBlocks(size, num_threads, [&](std::size_t i) {
    for (std::size_t j = 0; j < i; ++j)
      distances(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = distance(i, j);
  });
  return distances + distances.transpose().eval();
}

/// Models drawn whatever their class, ascending.
std::vector<Eigen::Index> drawReferences(std::size_t size, const RetrievalOptions& options) {
  std::vector<Eigen::Index> order(size);
  std::iota(order.begin(), order.end(), 0);
  RandomStream random(options.seed);
  for (std::size_t i = size; i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  order.resize(std::min(size, static_cast<std::size_t>(options.num_references)));
  std::sort(order.begin(), order.end());
  return order;
}

Eigen::MatrixXf scaled(const Eigen::MatrixXf& distances, const std::vector<Eigen::Index>& references,
                       const RetrievalOptions& options) {
  Eigen::VectorXf inverse_root(distances.rows());
  for (Eigen::Index i = 0; i < distances.rows(); ++i) {
    std::vector<float> to_references;
    for (const Eigen::Index reference : references)
      to_references.push_back(i == reference ? std::numeric_limits<float>::infinity() : distances(i, reference));
    const float typical = typicalDistance(std::move(to_references), static_cast<std::size_t>(options.num_nearest));
    inverse_root[i] = 1.0f / std::sqrt(typical);
  }
  return inverse_root.asDiagonal() * distances * inverse_root.asDiagonal();
}

/// Descriptors of all models that can be turned to all orders and signs of their axes.
struct TurnableDescriptors {
  std::string name;
  std::vector<Eigen::MatrixXf> forms;  ///< of each model, a column for each of its frames
  SignatureRotation rotate;
};

/// The first form of every model.
Eigen::MatrixXf firstForms(const TurnableDescriptors& descriptors) {
  Eigen::MatrixXf first(descriptors.forms.front().rows(), static_cast<Eigen::Index>(descriptors.forms.size()));
  for (Eigen::Index i = 0; i < first.cols(); ++i) first.col(i) = descriptors.forms[static_cast<std::size_t>(i)].col(0);
  return first;
}

/// L2 distances of the first forms in that rotation of axes where their product over all descriptors is least.
Eigen::MatrixXf leastDistances(const std::vector<const TurnableDescriptors*>& descriptors,
                               const RetrievalOptions& options, const RetrievalProgress& progress) {
  // Models that are compared with all others at a time. chosen: half is slower, twice needs more memory.
  constexpr Eigen::Index kColumns = 64;
  std::vector<Eigen::MatrixXf> forms;
  for (const TurnableDescriptors* one : descriptors) forms.push_back(firstForms(*one));
  const Eigen::Index size = forms.front().cols();
  Eigen::MatrixXf least(size, size);
  const auto num_blocks = static_cast<std::size_t>((size + kColumns - 1) / kColumns);
  forEachModel(num_blocks, options, progress, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kColumns, count = std::min(kColumns, size - first);
    for (int r = 0; r < kNumAxisRotations; ++r) {
      Eigen::MatrixXf product = Eigen::MatrixXf::Ones(size, count);
      for (std::size_t d = 0; d < forms.size(); ++d) {
        Eigen::MatrixXf rotated(forms[d].rows(), count);
        for (Eigen::Index i = 0; i < count; ++i)
          descriptors[d]->rotate(forms[d].col(first + i).data(), r, rotated.col(i).data());
        const Eigen::MatrixXf cosines = forms[d].transpose() * rotated;
        product.array() *= (2.0f - 2.0f * cosines.array()).max(0.0f).sqrt();
      }
      if (r == 0)
        least.middleCols(first, count) = product;
      else
        least.middleCols(first, count) = least.middleCols(first, count).cwiseMin(product);
    }
  });
  return least.cwiseMin(least.transpose().eval());
}

/// Distances of the compact forms, in the best of all frames and rotations of axes.
Eigen::MatrixXf compactDistances(const TurnableDescriptors& descriptors, const RetrievalOptions& options) {
  const std::size_t size = descriptors.forms.size();
  const std::vector<Eigen::Index> references = drawReferences(size, options);
  Eigen::MatrixXf reference_forms(descriptors.forms.front().rows(), static_cast<Eigen::Index>(references.size()));
  for (std::size_t r = 0; r < references.size(); ++r)
    reference_forms.col(static_cast<Eigen::Index>(r)) =
        descriptors.forms[static_cast<std::size_t>(references[r])].col(0);
  ProjectionOptions projection_options;
  projection_options.num_threads = options.num_threads;
  const SignatureProjection projection =
      SignatureProjection::fit(reference_forms, projection_options, descriptors.rotate);
  std::vector<Eigen::MatrixXf> compact(size), rotations(size);
  forEachModel(
      size, options, [](double) {},
      [&](std::size_t i) {
        compact[i] = projection.project(descriptors.forms[i]);
        rotations[i] = projection.rotations(compact[i]);
      });
  return symmetricDistances(size, options.num_threads, [&](std::size_t i, std::size_t j) {
    return std::min(signatureDistance(rotations[i], compact[j]), signatureDistance(rotations[j], compact[i]));
  });
}

/// Distances as they are, and scaled by those to the references.
void addMethod(const std::string& name, const Eigen::MatrixXf& distances, bool charted, const RetrievalOptions& options,
               std::vector<RetrievalMethod>& methods) {
  const std::vector<Eigen::Index> references = drawReferences(static_cast<std::size_t>(distances.rows()), options);
  methods.push_back({name, distances, charted});
  methods.push_back({name + ", scaled", scaled(distances, references, options), false});
}

/// PRST = sqrt((1 + D) / 2) as equation 1 has it, from the root of D that descriptors hold.
std::vector<float> byEquation1(const std::vector<float>& roots) {
  std::vector<float> values;
  values.reserve(roots.size());
  for (const float root : roots) values.push_back(std::sqrt(0.5f * (1.0f + root * root)));
  return values;
}

}  // namespace

std::vector<RetrievalMethod> publishedMethods(const std::vector<SymmetryDescriptors>& models, ModelAxes axes,
                                              const RetrievalOptions& options) {
  const auto distances = [&](const auto& distance) {
    return symmetricDistances(models.size(), options.num_threads,
                              [&](std::size_t i, std::size_t j) -> float { return distance(models[i], models[j]); });
  };
  using D = const SymmetryDescriptors&;
  const Eigen::MatrixXf prsd =
      distances([](D a, D b) { return planeDescriptorDistance(a.prsd.data(), b.prsd.data(), a.prsd.size()); });
  const Eigen::MatrixXf prst =
      distances([](D a, D b) { return planeDescriptorDistance(a.prst.data(), b.prst.data(), a.prst.size()); });
  const Eigen::MatrixXf gedt =
      distances([](D a, D b) { return std::sqrt(sqDistance(a.gedt.data(), b.gedt.data(), a.gedt.size())); });
  const auto values = [](const std::vector<float>& v) {
    return Eigen::Map<const Eigen::ArrayXf>(v.data(), static_cast<Eigen::Index>(v.size()));
  };
  const Eigen::MatrixXf greatest =
      distances([&](D a, D b) { return (values(a.prsd) - values(b.prsd)).abs().maxCoeff(); });
  std::vector<std::vector<float>> by_letter;
  by_letter.reserve(models.size());
  for (D model : models) by_letter.push_back(byEquation1(model.prst));
  const Eigen::MatrixXf letter =
      symmetricDistances(models.size(), options.num_threads, [&](std::size_t i, std::size_t j) -> float {
        return planeDescriptorDistance(by_letter[i].data(), by_letter[j].data(), by_letter[i].size());
      });
  const std::string where = ", " + nameOf(axes);
  const bool charted = axes != ModelAxes::Principal;
  return {{"PRSD" + where, prsd, charted},
          {"PRST" + where, prst, charted},
          {"GEDT" + where, gedt, charted},
          {"PRST x GEDT" + where, prst.cwiseProduct(gedt), charted},
          {"PRSD by the maximum" + where, greatest, false},
          {"PRST by equation 1" + where, letter, false},
          {"PRST by equation 1 x GEDT" + where, letter.cwiseProduct(gedt), false}};
}

std::vector<RetrievalMethod> signatureMethods(std::vector<TurnableForms> models, const RetrievalOptions& options,
                                              const RetrievalProgress& progress) {
  TurnableDescriptors prst{"PRST", {}, rotateTurnablePRST}, gedt{"GEDT", {}, rotateTurnableGEDT},
      signatures{"signatures", {}, rotateSignature};
  for (TurnableForms& model : models) {
    prst.forms.push_back(std::move(model.prst));
    gedt.forms.push_back(std::move(model.gedt));
    signatures.forms.push_back(std::move(model.signatures));
  }
  std::vector<RetrievalMethod> methods;
  double done = 0.0;
  const auto least = [&](const std::vector<const TurnableDescriptors*>& of) {
    constexpr double kShare = 0.25;  // derived: four comparisons
    const Eigen::MatrixXf distances = leastDistances(of, options, [&](double x) { progress(done + kShare * x); });
    done += kShare;
    return distances;
  };
  addMethod("PRST, all turns", least({&prst}), true, options, methods);
  addMethod("GEDT, all turns", least({&gedt}), true, options, methods);
  addMethod("PRST x GEDT, all turns", least({&prst, &gedt}), true, options, methods);
  const Eigen::MatrixXf compact_prst = compactDistances(prst, options), compact_gedt = compactDistances(gedt, options);
  addMethod("compact PRST", compact_prst, false, options, methods);
  addMethod("compact GEDT", compact_gedt, false, options, methods);
  addMethod("compact PRST x GEDT", compact_prst.cwiseProduct(compact_gedt), false, options, methods);
  addMethod("signatures", least({&signatures}), false, options, methods);
  addMethod("compact signatures", compactDistances(signatures, options), true, options, methods);
  return methods;
}

RetrievalMethod databaseMethod(const std::vector<Points>& clouds, const RetrievalOptions& options,
                               const RetrievalProgress& progress) {
  const auto asCloud = [](const Points& points) {
    SymmetryDatabase::Cloud cloud(static_cast<std::uint32_t>(points.cols()), 1);
    cloud.getMatrixXfMap(3, 4, 0) = points;
    return cloud;
  };
  DatabaseOptions database_options;
  database_options.num_references = options.num_references;
  database_options.num_threads = options.num_threads;
  database_options.num_views = 1;  // for scans, which are not asked for here
  SymmetryDatabase database(":memory:", database_options);
  std::vector<ModelInput> models;
  for (std::size_t i = 0; i < clouds.size(); ++i)
    models.push_back({std::to_string(i), {}, [&, i] { return asCloud(clouds[i]); }});
  database.build(models, [&](double share) { return progress(0.5 * share), true; });
  const auto size = static_cast<Eigen::Index>(clouds.size());
  RetrievalMethod method{"SymmetryDatabase::match", Eigen::MatrixXf::Constant(size, size, 1e6f)};
  Viewpoint none;
  none.mode = Viewpoint::Mode::None;
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Isometry3d pose = randomPose(options.seed + 100'000 + static_cast<std::uint64_t>(i), 0.0);
    const Points turned = pose.linear().cast<float>() * clouds[static_cast<std::size_t>(i)];
    for (const ModelMatch& match : database.match(asCloud(turned), static_cast<int>(size), none))
      method.distances(std::stol(match.name), i) = static_cast<float>(match.distance);
    progress(0.5 + 0.5 * static_cast<double>(i + 1) / static_cast<double>(size));
  }
  return method;
}

}  // namespace pcl_symmetry::apps
