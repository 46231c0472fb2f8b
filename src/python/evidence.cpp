#include "python/evidence.h"

#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/detection/plane_decision.h"
#include "core/detection/turn_confidence.h"
#include "core/segmentation/merge_fit.h"
#include "core/segmentation/region_merging.h"
#include "python/input_points.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

struct PlaneRow {
  double coefficients[4];
  std::int32_t kind;
  bool flat;
  double confidence, share, double_share, unknown, score, own_score, support, conflict, baseline, hold, spacing,
      roughness, tolerance, share_unit;
  double terms[7];
};

struct TurnRow {
  double point[3], direction[3];
  std::int32_t fold, kind;
  double confidence, support, off, far, halfway, grown, hold, planes_off, beside;
  double terms[7];
};

struct FrameRow {
  double constant, value, first_score, contact, principal_angle, best, other_scores, best_score;
};

struct MergeRow {
  std::int32_t into, from;
  double log_odds, area_into, area_from;
  double cues[kNumCues];
};

template <typename Values>
void copyTo(double* row, const Values& values) {
  std::copy(values.begin(), values.end(), row);
}

/// Makes the types of the rows known to NumPy, once: at the first row, as that imports NumPy.
bool registerRows() {
  PYBIND11_NUMPY_DTYPE(PlaneRow, coefficients, kind, flat, confidence, share, double_share, unknown, score, own_score,
                       support, conflict, baseline, hold, spacing, roughness, tolerance, share_unit, terms);
  PYBIND11_NUMPY_DTYPE(TurnRow, point, direction, fold, kind, confidence, support, off, far, halfway, grown, hold,
                       planes_off, beside, terms);
  PYBIND11_NUMPY_DTYPE(FrameRow, constant, value, first_score, contact, principal_angle, best, other_scores,
                       best_score);
  PYBIND11_NUMPY_DTYPE(MergeRow, into, from, log_odds, area_into, area_from, cues);
  return true;
}

void needRows() {
  static const bool is_done = registerRows();
  (void)is_done;
}

template <typename Row>
py::array arrayOfRows(const std::vector<Row>& rows) {
  needRows();
  return py::array_t<Row>(static_cast<py::ssize_t>(rows.size()), rows.data());
}

PlaneRow rowOf(const JudgedPlane& judged) {
  PlaneEvidence e = judged.evidence;
  PlaneRow row{};
  const Eigen::Vector4d coefficients = judged.plane.coefficients();
  std::copy(coefficients.data(), coefficients.data() + 4, row.coefficients);
  row.kind = static_cast<std::int32_t>(e.kind);
  row.flat = e.flat;
  row.confidence = judged.plane.confidence;
  row.share = e.share;
  row.double_share = e.double_share;
  row.unknown = e.unknown;
  row.score = e.score;
  row.own_score = e.own_score;
  row.support = e.support;
  row.conflict = e.conflict;
  row.baseline = e.baseline;
  row.hold = e.hold;
  row.spacing = e.spacing;
  row.roughness = e.roughness;
  row.tolerance = e.tolerance;
  row.share_unit = shareUnit(e);
  e.further = true;
  copyTo(row.terms, logOddsTerms(e));
  return row;
}

TurnRow rowOf(const JudgedTurn& judged) {
  const SymmetryTurn& turn = judged.turn;
  TurnRow row{};
  std::copy(turn.point.data(), turn.point.data() + 3, row.point);
  std::copy(turn.direction.data(), turn.direction.data() + 3, row.direction);
  row.fold = turn.fold;
  row.kind = static_cast<std::int32_t>(kindOf(turn));
  row.confidence = turn.confidence;
  row.support = turn.support;
  row.off = turn.off;
  row.far = turn.far;
  row.halfway = turn.halfway;
  row.grown = judged.signs.grown;
  row.hold = judged.signs.hold;
  row.planes_off = judged.signs.planes_off;
  row.beside = judged.signs.beside;
  copyTo(row.terms, turnOddsTerms(turn, judged.signs));
  return row;
}

/// Small patches of a mesh, and their merges by any weights.
class Merging {
public:
  Merging(const AnyArray& points, const std::vector<std::vector<int>>& faces, std::uint64_t seed, int threads) {
    const InputPoints input("points", points, 0, seed);
    if (!input.rows().empty()) throw std::invalid_argument("points: vertices not all finite, must be");
    SegmentationOptions options;
    options.seed = seed;
    options.num_threads = threads;
    const py::gil_scoped_release release;
    const SurfaceGraph graph = meshGraph(input.points(), faces);
    evidence_ = WholeEvidence(graph, options).ofDivision(0);
  }

  const std::vector<int>& patches() const { return evidence_.patches.of_element; }

  py::array merges(const std::optional<std::vector<double>>& given) const {
    MergeWeights weights = kMergeFit[static_cast<std::size_t>(MergingEvidence::All)];
    if (given && given->size() != weights.size())
      throw std::invalid_argument("weights = " + std::to_string(given->size()) + " numbers, must be " +
                                  std::to_string(weights.size()));
    if (given) std::copy(given->begin(), given->end(), weights.begin());
    std::vector<MergeRow> rows;
    {
      const py::gil_scoped_release release;
      Regions regions(evidence_);
      for (const Merge& merge : mergeRegions(regions, weights)) {
        MergeRow row{merge.into, merge.from, merge.log_odds, regions.area(merge.into), regions.area(merge.from), {}};
        copyTo(row.cues, regions.cues(merge.into, merge.from));
        rows.push_back(row);
        regions.merge(merge.into, merge.from);
      }
    }
    return arrayOfRows(rows);
  }

private:
  PartEvidence evidence_;
};

}  // namespace

py::array planeEvidence(const Detection& found) {
  std::vector<PlaneRow> rows;
  if (found.evidence)
    for (const JudgedPlane& judged : found.evidence->planes) rows.push_back(rowOf(judged));
  return arrayOfRows(rows);
}

py::array turnEvidence(const Detection& found) {
  std::vector<TurnRow> rows;
  if (found.evidence)
    for (const JudgedTurn& judged : found.evidence->turns) rows.push_back(rowOf(judged));
  return arrayOfRows(rows);
}

py::array frameEvidence(const SymmetryFrame& frame) {
  std::vector<FrameRow> rows;
  for (const ProbableFrame& one : frame.probable) {
    const std::array<double, 8>& e = one.evidence;
    rows.push_back({e[0], e[1], e[2], e[3], e[4], e[5], e[6], e[7]});
  }
  return arrayOfRows(rows);
}

void addEvidence(py::module_& module) {
  py::class_<Merging>(module, "Merging", "Small patches of a mesh, and the merges that make parts of them.")
      .def(py::init([](const AnyArray& points, const std::vector<std::vector<int>>& faces, std::uint64_t seed,
                       int threads) { return std::make_unique<Merging>(points, faces, seed, threads); }),
           py::arg("points"), py::arg("faces"), py::kw_only(), py::arg("seed") = 1, py::arg("threads") = 0,
           "points: (V, 3) vertices. faces: lists of indices of vertices, three or more each.")
      .def_property_readonly("patches", &Merging::patches, "list with the patch of each face, from 0")
      .def("merges", &Merging::merges, py::arg("weights") = py::none(),
           "All merges until no two regions are neighbors, in their order, the likeliest first.\n\n"
           "weights: (14,) log odds per unit of each cue that two regions are one part; None: those of segment().\n"
           "Returns a structured array, one row a merge:\n"
           "into, from: the regions, by the number of one of their patches; `from` becomes a part of `into`\n"
           "log_odds: that the two are one part; segment() merges as long as they are positive\n"
           "area_into, area_from: shares of the surface\n"
           "cues: (14,) 1; common border over the shorter perimeter; log of the smaller and of the larger area;\n"
           "    difference of their support for planes; 1 where a plane reflects each onto the other; concavity of\n"
           "    edges along the border, radians, of patches across it, and of patches within; |log| of the ratio of\n"
           "    thicknesses; log of the thinner over the thickness at the border; share of free lines of sight; the\n"
           "    same over that within the regions; the same times the log of the smaller area");
}

}  // namespace pcl_symmetry::python
