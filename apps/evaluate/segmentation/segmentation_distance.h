/// How far two segmentations of a mesh are apart (Chen, Golovinskiy, Funkhouser: A Benchmark for 3D Mesh Segmentation,
/// SIGGRAPH 2009, Section 4).
#pragma once

#include <pcl/PolygonMesh.h>

#include <limits>
#include <utility>
#include <vector>

namespace pcl_symmetry::apps {

/// The measures of the benchmark; 0 for equal segmentations.
struct SegmentationDistance {
  double rand = 0.0;  ///< 1 - Rand index: share of the pairs of faces that one puts together and the other apart
  /// Mean geodesic distance from the cuts of one to those of the other, both ways added, in mean distances of the
  /// surface from its center of mass; NaN where one of the two has no cut.
  double cut_discrepancy = std::numeric_limits<double>::quiet_NaN();
  double hamming = 0.0;             ///< mean of the next two
  double hamming_missing = 0.0;     ///< share of the area outside the segment that a reference segment overlaps most
  double hamming_false = 0.0;       ///< the same with the roles exchanged
  double global_consistency = 0.0;  ///< Global Consistency Error: 0 also where one refines the other
  double local_consistency = 0.0;   ///< Local Consistency Error: as above, either of the two, face by face
};

/// A segmentation with what comparisons need of it.
struct PreparedSegmentation {
  std::vector<int> labels;  ///< per face, from 0 without gaps
  int num_segments = 0;
  std::vector<float> distance;            ///< per vertex, geodesic, from the closest cut
  std::vector<std::pair<int, int>> cuts;  ///< edges, as pairs of vertices
};

/// Compares segmentations of one mesh.
///
/// Areas weigh in Hamming distance and consistency errors, pairs of faces in the Rand index. Geodesics run along edges.
class SegmentationComparison {
public:
  /// \throws std::invalid_argument where a polygon refers to a vertex that the mesh does not have.
  explicit SegmentationComparison(const pcl::PolygonMesh& mesh);

  std::size_t numFaces() const { return areas_.size(); }

  /// \param labels one per face, any numbers.
  /// \throws std::invalid_argument for another number of labels than faces.
  PreparedSegmentation prepare(const std::vector<int>& labels) const;

  /// \param reference,other of this mesh.
  SegmentationDistance compare(const PreparedSegmentation& reference, const PreparedSegmentation& other) const;

private:
  struct Edge {
    int begin, end;  ///< vertices, begin < end
    std::vector<int> faces;
    float length;
  };

  std::vector<float> distancesFrom(const std::vector<std::pair<int, int>>& cuts) const;
  double meanDistance(const PreparedSegmentation& from, const PreparedSegmentation& to) const;

  std::vector<Eigen::Vector3f> vertices_;
  std::vector<double> areas_;  ///< per face, shares of the whole
  double mean_radius_ = 0.0;
  std::vector<Edge> edges_;
  std::vector<int> first_neighbour_;               ///< per vertex, into neighbours_
  std::vector<std::pair<int, float>> neighbours_;  ///< vertex and length of the edge
};

}  // namespace pcl_symmetry::apps
