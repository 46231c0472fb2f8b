#include "retrieval_methods.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <numeric>

#include "pcl_symmetry/core/axis_rotations.h"
#include "pcl_symmetry/core/parallel.h"
#include "pcl_symmetry/core/random.h"
#include "pcl_symmetry/core/reference_scaling.h"
#include "pcl_symmetry/core/shape_description.h"
#include "pcl_symmetry/core/signature_projection.h"
#include "pcl_symmetry/core/symmetry_descriptor.h"

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

/// Least L2 distances of signatures, a column each, in all rotations of axes.
Eigen::MatrixXf leastDistances(const Eigen::MatrixXf& signatures, const RetrievalOptions& options,
                               const RetrievalProgress& progress) {
  constexpr Eigen::Index kColumns = 64;
  Eigen::MatrixXf cosines = Eigen::MatrixXf::Constant(signatures.cols(), signatures.cols(), -1.0f);
  const auto num_blocks = static_cast<std::size_t>((signatures.cols() + kColumns - 1) / kColumns);
  forEachModel(num_blocks, options, progress, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kColumns;
    const Eigen::Index count = std::min(kColumns, signatures.cols() - first);
    Eigen::MatrixXf rotated(signatures.rows(), count), products(signatures.cols(), count);
    for (int r = 0; r < kNumAxisRotations; ++r) {
      for (Eigen::Index i = 0; i < count; ++i)
        rotateSignature(signatures.col(first + i).data(), r, rotated.col(i).data());
      products.noalias() = signatures.transpose() * rotated;
      cosines.middleCols(first, count) = cosines.middleCols(first, count).cwiseMax(products);
    }
  });
  return (2.0f - 2.0f * cosines.cwiseMax(cosines.transpose()).array()).max(0.0f).sqrt();
}

}  // namespace

std::vector<RetrievalMethod> publishedMethods(const std::vector<Points>& clouds, bool canonical,
                                              const RetrievalOptions& options, const RetrievalProgress& progress) {
  std::vector<SymmetryDescriptors> descriptors(clouds.size());
  forEachModel(clouds.size(), options, progress, [&](std::size_t i) {
    Eigen::Isometry3d T_frame_input = Eigen::Isometry3d::Identity();
    if (canonical) {
      DescriptionOptions description;
      description.num_threads = 1;
      T_frame_input.linear() = describeShape(clouds[i], description).frame.axes.transpose();
    }
    T_frame_input.translation() = -T_frame_input.linear() * centerOfMass(clouds[i]);
    DescriptorOptions descriptor;
    descriptor.num_threads = 1;
    descriptors[i] = symmetryDescriptors(clouds[i], T_frame_input, descriptor);
  });
  const auto distances = [&](const auto& distance) {
    return symmetricDistances(clouds.size(), options.num_threads, [&](std::size_t i, std::size_t j) -> float {
      return distance(descriptors[i], descriptors[j]);
    });
  };
  using D = const SymmetryDescriptors&;
  const Eigen::MatrixXf prsd =
      distances([](D a, D b) { return planeDescriptorDistance(a.prsd.data(), b.prsd.data(), a.prsd.size()); });
  const Eigen::MatrixXf prst =
      distances([](D a, D b) { return planeDescriptorDistance(a.prst.data(), b.prst.data(), a.prst.size()); });
  const Eigen::MatrixXf gedt =
      distances([](D a, D b) { return std::sqrt(sqDistance(a.gedt.data(), b.gedt.data(), a.gedt.size())); });
  const std::string where = canonical ? ", symmetry axes" : ", axes of the files";
  return {{"PRSD" + where, prsd},
          {"PRST" + where, prst},
          {"GEDT" + where, gedt},
          {"PRST x GEDT" + where, prst.cwiseProduct(gedt)}};
}

std::vector<RetrievalMethod> signatureMethods(const std::vector<Points>& clouds, const RetrievalOptions& options,
                                              const RetrievalProgress& progress) {
  const auto size = static_cast<Eigen::Index>(clouds.size());
  std::vector<Eigen::MatrixXf> signatures(clouds.size());
  forEachModel(
      clouds.size(), options, [&](double share) { progress(0.5 * share); },
      [&](std::size_t i) {
        DescriptionOptions description;
        description.num_threads = 1;
        signatures[i] = describeShape(clouds[i], description).signatures;
      });
  Eigen::MatrixXf first(kSignatureSize, size);
  for (Eigen::Index i = 0; i < size; ++i) first.col(i) = signatures[static_cast<std::size_t>(i)].col(0);
  const Eigen::MatrixXf plain = leastDistances(first, options, [&](double share) { progress(0.5 + 0.5 * share); });

  const std::vector<Eigen::Index> references = drawReferences(clouds.size(), options);
  Eigen::MatrixXf reference_signatures(kSignatureSize, static_cast<Eigen::Index>(references.size()));
  for (std::size_t r = 0; r < references.size(); ++r)
    reference_signatures.col(static_cast<Eigen::Index>(r)) = first.col(references[r]);
  ProjectionOptions projection_options;
  projection_options.num_threads = options.num_threads;
  const SignatureProjection projection = SignatureProjection::fit(reference_signatures, projection_options);
  std::vector<Eigen::MatrixXf> compact(clouds.size()), rotations(clouds.size());
  forEachModel(
      clouds.size(), options, [](double) {},
      [&](std::size_t i) {
        compact[i] = projection.project(signatures[i]);
        rotations[i] = projection.rotations(compact[i]);
      });
  const Eigen::MatrixXf distances =
      symmetricDistances(clouds.size(), options.num_threads, [&](std::size_t i, std::size_t j) {
        return std::min(signatureDistance(rotations[i], compact[j]), signatureDistance(rotations[j], compact[i]));
      });
  return {{"signatures", plain},
          {"signatures, scaled", scaled(plain, references, options)},
          {"compact signatures", distances},
          {"compact signatures, scaled", scaled(distances, references, options)}};
}

}  // namespace pcl_symmetry::apps
