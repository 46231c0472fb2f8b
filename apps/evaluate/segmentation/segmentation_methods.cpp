#include "evaluate/segmentation/segmentation_methods.h"

#include <pcl/conversions.h>
#include <pcl/point_types.h>

#include <Eigen/Geometry>
#include <utility>

#include "common/command_line/tool_errors.h"
#include "core/base/k_means.h"
#include "pcl_symmetry/core/neighbours/closest_point_search.h"
#include "pcl_symmetry/mesh_sampling.h"
#include "pcl_symmetry/symmetry_segmentation.h"

namespace pcl_symmetry::apps {

namespace {

constexpr int kNumClusters = 6;     // clusters of k-means; chosen: people make 2 to 20 segments
constexpr int kNumPoints = 30'000;  // points of the cloud of a mesh; chosen: about a point per face of the benchmark
constexpr int kMaxDepth = 4;        // depth of the paper's method; chosen: 16 parts, twice cuts into crumbs

Segmentation ofLabels(std::vector<int> labels) {
  Segmentation segmentation;
  segmentation.labels = std::move(labels);
  return segmentation;
}

Segmentation oneSegment(const pcl::PolygonMesh& mesh) {
  return ofLabels(std::vector<int>(mesh.polygons.size(), 0));
}

/// k-means on the centers of the faces, by area: geometry alone.
Segmentation clustersOfCenters(const pcl::PolygonMesh& mesh) {
  pcl::PointCloud<pcl::PointXYZ> vertices;
  pcl::fromPCLPointCloud2(mesh.cloud, vertices);
  Eigen::MatrixXd centers = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(mesh.polygons.size()));
  std::vector<float> areas(mesh.polygons.size());
  for (std::size_t f = 0; f < mesh.polygons.size(); ++f) {
    const auto& corners = mesh.polygons[f].vertices;
    const auto at = [&](std::size_t k) -> Eigen::Vector3d {
      return vertices.at(corners[k]).getVector3fMap().cast<double>();
    };
    Eigen::Vector3d twice_area = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < corners.size(); ++k) {
      centers.col(f) += at(k) / static_cast<double>(corners.size());
      if (k >= 2) twice_area += (at(k - 1) - at(0)).cross(at(k) - at(0));
    }
    areas[f] = static_cast<float>(0.5 * twice_area.norm());
  }
  KMeansOptions options;
  options.num_clusters = kNumClusters;
  return ofLabels(kMeans(centers.cast<float>(), areas, options).labels);
}

NamedSegmentation withOptions(const std::string& name, SegmentationOptions options, int num_threads) {
  options.num_threads = num_threads;
  return {name, [options](const pcl::PolygonMesh& mesh) { return segmentSurface(meshGraph(mesh), options); }};
}

/// The paper's, to a depth.
NamedSegmentation splitting(const std::string& name, int depth, bool as_published, int num_threads) {
  SegmentationOptions options;
  options.splitting.as_published = as_published;
  options.method = SegmentationMethod::Splitting;
  options.splitting.depth = depth;
  return withOptions(name, options, num_threads);
}

NamedSegmentation merging(const std::string& name, MergingEvidence evidence, int num_threads) {
  SegmentationOptions options;
  options.merging.evidence = evidence;
  return withOptions(name, options, num_threads);
}

/// The default on points spread over the mesh; faces take the segment of the closest point.
NamedSegmentation cloudOfMesh(int num_threads) {
  return {"points", [num_threads](const pcl::PolygonMesh& mesh) {
            const auto cloud = sampleMesh(mesh, kNumPoints);
            SymmetrySegmentation<pcl::PointXYZ> segmentation;
            segmentation.setNumberOfThreads(num_threads);
            segmentation.setInputCloud(cloud);
            std::vector<pcl::PointIndices> segments;
            segmentation.segment(segments);
            std::vector<int> closest;
            std::vector<float> sq_distances;
            const Points points = cloud->getMatrixXfMap(3, 4, 0);
            makeTreeSearch(points)->search(meshGraph(mesh).centers, 1, closest, sq_distances);
            for (int& label : closest) label = segmentation.getLabels()[label];
            return ofLabels(std::move(closest));
          }};
}

}  // namespace

std::vector<NamedSegmentation> segmentationMethods(const std::vector<std::string>& names, int num_threads) {
  std::vector<NamedSegmentation> known = {{"one", oneSegment}, {"k-means", clustersOfCenters}};
  for (int depth = 1; depth <= kMaxDepth; ++depth)
    for (const bool letter : {false, true})
      known.push_back(splitting((letter ? "letter-" : "paper-") + std::to_string(depth), depth, letter, num_threads));
  known.push_back(merging("nothing", MergingEvidence::Nothing, num_threads));
  known.push_back(merging("symmetry", MergingEvidence::Symmetry, num_threads));
  known.push_back(merging("concavity", MergingEvidence::SymmetryAndConcavity, num_threads));
  known.push_back(merging("no-symmetry", MergingEvidence::AllButSymmetry, num_threads));
  known.push_back(merging("all", MergingEvidence::All, num_threads));
  SegmentationOptions without;
  without.merging.num_divisions = 1;
  known.push_back(withOptions("one-division", without, num_threads));
  without = {};
  without.merging.agree_across_planes = false;
  known.push_back(withOptions("no-agreement", without, num_threads));
  without = {};
  without.merging.cut_band = 0.0;
  known.push_back(withOptions("no-cut", without, num_threads));
  known.push_back(cloudOfMesh(num_threads));
  std::vector<NamedSegmentation> chosen;
  for (const std::string& name : names) {
    std::string list;
    bool found = false;
    for (const NamedSegmentation& method : known) {
      list += (list.empty() ? "" : ", ") + method.name;
      if (method.name != name) continue;
      chosen.push_back(method);
      found = true;
    }
    if (!found) throw UsageError("method '" + name + "': unknown, must be one of " + list);
  }
  return chosen;
}

}  // namespace pcl_symmetry::apps
