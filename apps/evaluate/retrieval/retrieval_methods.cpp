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
#include "core/descriptors/turnable_prst.h"
#include "core/geometry/axis_rotations.h"
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

/// Least L2 distances of the first forms in all rotations of axes.
Eigen::MatrixXf leastDistances(const Eigen::MatrixXf& signatures, SignatureRotation rotate,
                               const RetrievalOptions& options, const RetrievalProgress& progress) {
  // Descriptors that are compared with all others at a time. chosen: half is slower, twice needs more memory.
  constexpr Eigen::Index kColumns = 64;
  Eigen::MatrixXf cosines = Eigen::MatrixXf::Constant(signatures.cols(), signatures.cols(), -1.0f);
  const auto num_blocks = static_cast<std::size_t>((signatures.cols() + kColumns - 1) / kColumns);
  forEachModel(num_blocks, options, progress, [&](std::size_t block) {
    const Eigen::Index first = static_cast<Eigen::Index>(block) * kColumns;
    const Eigen::Index count = std::min(kColumns, signatures.cols() - first);
    Eigen::MatrixXf rotated(signatures.rows(), count), products(signatures.cols(), count);
    for (int r = 0; r < kNumAxisRotations; ++r) {
      for (Eigen::Index i = 0; i < count; ++i) rotate(signatures.col(first + i).data(), r, rotated.col(i).data());
      products.noalias() = signatures.transpose() * rotated;
      cosines.middleCols(first, count) = cosines.middleCols(first, count).cwiseMax(products);
    }
  });
  return (2.0f - 2.0f * cosines.cwiseMax(cosines.transpose()).array()).max(0.0f).sqrt();
}

/// By the descriptors as they are and by their compact forms, both also with scaled distances.
std::vector<RetrievalMethod> turnableMethods(const TurnableDescriptors& descriptors, const RetrievalOptions& options,
                                             const RetrievalProgress& progress) {
  const std::size_t size = descriptors.forms.size();
  Eigen::MatrixXf first(descriptors.forms.front().rows(), static_cast<Eigen::Index>(size));
  for (std::size_t i = 0; i < size; ++i) first.col(static_cast<Eigen::Index>(i)) = descriptors.forms[i].col(0);
  const Eigen::MatrixXf plain = leastDistances(first, descriptors.rotate, options, progress);

  const std::vector<Eigen::Index> references = drawReferences(size, options);
  Eigen::MatrixXf reference_forms(first.rows(), static_cast<Eigen::Index>(references.size()));
  for (std::size_t r = 0; r < references.size(); ++r)
    reference_forms.col(static_cast<Eigen::Index>(r)) = first.col(references[r]);
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
  const Eigen::MatrixXf distances = symmetricDistances(size, options.num_threads, [&](std::size_t i, std::size_t j) {
    return std::min(signatureDistance(rotations[i], compact[j]), signatureDistance(rotations[j], compact[i]));
  });
  const std::string& name = descriptors.name;
  return {{name, plain},
          {name + ", scaled", scaled(plain, references, options), true},
          {"compact " + name, distances},
          {"compact " + name + ", scaled", scaled(distances, references, options), true}};
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
  TurnableDescriptors prst{"PRST, all turns", std::vector<Eigen::MatrixXf>(clouds.size()), rotateTurnablePRST};
  TurnableDescriptors signatures{"signatures", std::vector<Eigen::MatrixXf>(clouds.size()), rotateSignature};
  forEachModel(
      clouds.size(), options, [&](double share) { progress(0.5 * share); },
      [&](std::size_t i) {
        DescriptionOptions description;
        description.num_threads = 1;
        const ShapeDescription shape = describeShape(clouds[i], description);
        signatures.forms[i] = shape.signatures;
        const std::vector<Eigen::Matrix3d> frames = signatureFrames(clouds[i], shape.frame);
        prst.forms[i].resize(kTurnablePRSTSize, static_cast<Eigen::Index>(frames.size()));
        for (std::size_t f = 0; f < frames.size(); ++f) {
          const std::vector<float> values = turnablePRST(clouds[i], frames[f]);
          prst.forms[i].col(static_cast<Eigen::Index>(f)) =
              Eigen::Map<const Eigen::VectorXf>(values.data(), kTurnablePRSTSize);
        }
      });
  std::vector<RetrievalMethod> methods =
      turnableMethods(prst, options, [&](double share) { progress(0.5 + 0.2 * share); });
  for (RetrievalMethod& method :
       turnableMethods(signatures, options, [&](double share) { progress(0.7 + 0.3 * share); }))
    methods.push_back(std::move(method));
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
  RetrievalMethod method{"SymmetryDatabase::match", Eigen::MatrixXf::Constant(size, size, 1e6f), true};
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
