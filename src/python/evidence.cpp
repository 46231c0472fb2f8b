#include <pybind11/eigen.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/segmentation/merge_fit.h"
#include "core/segmentation/region_merging.h"
#include "python/computing.h"
#include "python/input_points.h"
#include "python/results.h"

namespace py = pybind11;

namespace pcl_symmetry::python {

namespace {

using Columns = std::vector<std::pair<std::string, std::string>>;  ///< names, and types as in NumPy

/// \param rows tuples with a value for each column.
template <typename Rows>
py::array arrayOfRows(const Rows& rows, const Columns& columns) {
  const py::module_ numpy = py::module_::import("numpy");
  return numpy.attr("array")(rows, numpy.attr("dtype")(columns, py::arg("align") = true));
}

/// Kinds have different terms, at most seven.
std::vector<double> padded(std::vector<double> terms) {
  terms.resize(7);
  return terms;
}

auto rowOf(const MeasuredPlane& judged) {
  const PlaneEvidence& e = judged.evidence;
  std::vector<double> terms = logOddsTerms(e);
  terms.push_back(furtherTerm(e.kind, e.unknown));
  return std::make_tuple(judged.plane.coefficients(), static_cast<int>(e.kind), e.flat, judged.plane.confidence,
                         e.share, e.double_share, e.unknown, e.score, e.own_score, e.support, e.conflict, e.baseline,
                         e.stiffness, e.spacing, e.roughness, e.tolerance, shareUnit(e), padded(terms));
}

auto rowOf(const JudgedRotation& judged) {
  const SymmetryRotation& rotation = judged.rotation;
  const HalfTurnEvidence& signs = judged.half_turns;
  return std::make_tuple(rotation.point, rotation.direction, rotation.fold, static_cast<int>(kindOf(rotation)),
                         rotation.confidence, rotation.support, rotation.off, rotation.far, rotation.halfway,
                         signs.extent_ratio, signs.stiffness, signs.planes_off_share, signs.conflicts_with_best,
                         padded(rotationOddsTerms(rotation, signs)));
}

template <typename Judged>
auto rowsOf(const std::vector<Judged>& all) {
  std::vector<decltype(rowOf(all[0]))> rows;
  for (const Judged& judged : all) rows.push_back(rowOf(judged));
  return rows;
}

/// Small patches of a mesh, and their merges with any weights.
class Merging {
public:
  Merging(const AnyArray& points, const py::object& faces, std::uint64_t seed, int threads) {
    const InputPoints input("points", points, 0, seed);
    if (!input.usesAllRows()) throw std::invalid_argument("points: vertices not all finite, must be");
    const auto options = optionsWith<SegmentationOptions>(seed, threads);
    const std::vector<std::vector<int>> polygons = polygonsOf(faces);
    const Computing computing;
    const SurfaceGraph graph = meshGraph(input.points(), polygons);
    evidence_ = WholeEvidence(graph, options).ofDivision(0);
  }

  const std::vector<int>& patches() const { return evidence_.patches.of_element; }

  py::array merges(const std::optional<std::vector<double>>& given) const {
    MergeWeights weights = kMergeFit[static_cast<std::size_t>(MergingEvidence::All)];
    if (given && given->size() != weights.size())
      throw std::invalid_argument("weights = " + std::to_string(given->size()) + " numbers, must be " +
                                  std::to_string(weights.size()));
    if (given) std::copy(given->begin(), given->end(), weights.begin());
    std::vector<std::tuple<int, int, double, double, double, Cues>> rows;
    {
      const Computing computing;
      Regions regions(evidence_);
      for (const Merge& merge : mergeRegions(regions, weights)) {
        rows.emplace_back(merge.into, merge.from, merge.log_odds, regions.area(merge.into), regions.area(merge.from),
                          regions.cues(merge.into, merge.from));
        regions.merge(merge.into, merge.from);
      }
    }
    return arrayOfRows(rows, {{"into", "i4"},
                              {"from", "i4"},
                              {"log_odds", "f8"},
                              {"area_into", "f8"},
                              {"area_from", "f8"},
                              {"cues", std::to_string(kNumCues) + "f8"}});
  }

private:
  PartEvidence evidence_;
};

}  // namespace

py::array planeEvidence(const DetectionEvidence& evidence) {
  Columns columns{{"coefficients", "4f8"}, {"kind", "i4"}, {"flat", "?"}};
  for (const char* name : {"confidence", "share", "double_share", "unknown", "score", "own_score", "support",
                           "conflict", "baseline", "hold", "spacing", "roughness", "tolerance", "share_unit"})
    columns.emplace_back(name, "f8");
  columns.emplace_back("terms", "7f8");
  return arrayOfRows(rowsOf(evidence.planes), columns);
}

py::array rotationEvidence(const DetectionEvidence& evidence) {
  Columns columns{{"point", "3f8"}, {"direction", "3f8"}, {"fold", "i4"}, {"kind", "i4"}};
  for (const char* name : {"confidence", "support", "off", "far", "halfway", "grown", "hold", "planes_off", "beside"})
    columns.emplace_back(name, "f8");
  columns.emplace_back("terms", "7f8");
  return arrayOfRows(rowsOf(evidence.rotations), columns);
}

py::array frameEvidence(const SymmetryFrame& frame) {
  Columns columns;
  for (const char* name :
       {"constant", "value", "first_score", "contact", "principal_angle", "best", "other_scores", "best_score"})
    columns.emplace_back(name, "f8");
  py::list rows;
  for (const ProbableFrame& one : frame.probable) rows.append(py::tuple(py::cast(one.evidence)));
  return arrayOfRows(rows, columns);
}

void addEvidence(py::module_& module) {
  py::class_<Merging>(module, "Merging")
      .def(py::init<const AnyArray&, const py::object&, std::uint64_t, int>(), py::arg("points"), py::arg("faces"),
           py::arg("seed"), py::arg("threads"))
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
