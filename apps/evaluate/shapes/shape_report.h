/// What the kinds of generated shapes share: how they are run, and the table of their rates.
#pragma once

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdint>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/command_line/console.h"
#include "common/scanner/virtual_scanner.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shapes/swept_shape.h"
#include "evaluate/shared/model_list.h"
#include "evaluate/shared/proportion.h"
#include "pcl_symmetry/core/detection/plane_detection.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

struct ShapeRowOptions {
  int num = 0;          ///< clouds; 0 = as many as the kind has by default
  bool report = false;  ///< shapes of the report half: other curves, profiles and streams of random numbers
  int num_points = 10'000;
  std::vector<std::string> folders;  ///< of models, for the kinds that use them
  ModelSelection selection;
  std::uint64_t seed = 0;
  int threads = 0;

  int count(int by_default) const { return num > 0 ? num : by_default; }
  /// A stream of random numbers for case \p i, another for each half.
  std::uint64_t caseSeed(int i) const;
};

/// Rates in rows and columns, in the order in which rows are first named: of one cloud, or of all.
class ShapeReport {
public:
  explicit ShapeReport(std::vector<std::string> columns = {}) : columns_(std::move(columns)) {}

  /// \param column index of the column.
  Proportion& at(const std::string& row, std::size_t column);
  /// Counts what notes are made of.
  int& tally(const std::string& name) { return tallies_[name]; }

  /// A line below the table.
  void note(const std::string& line) { notes_.push_back(line); }
  /// A row of the CSV file, which tells single clouds.
  void log(const std::string& line) { log_.push_back(line); }
  /// \return one of the same columns without rows.
  ShapeReport ofCloud() const { return ShapeReport(columns_); }
  /// Adds the report of a cloud.
  void add(const ShapeReport& cloud);

  void print() const;
  nlohmann::json json() const;
  std::string csv() const;

private:
  friend void put(detail::PackedBytes& bytes, const ShapeReport& report);
  friend void get(detail::UnpackedBytes& bytes, ShapeReport& report);

  std::vector<std::string> columns_;
  std::vector<std::pair<std::string, std::vector<Proportion>>> rows_;
  std::vector<std::string> notes_, log_;
  std::map<std::string, int> tallies_;
};

// A report of a cloud as bytes: columns are left out.
void put(detail::PackedBytes& bytes, const ShapeReport& report);
void get(detail::UnpackedBytes& bytes, ShapeReport& report);

/// The clouds of one kind.
struct ShapeCases {
  ShapeReport report;  ///< of no cloud: the columns, and the titles of the CSV file
  int count = 0;       ///< of the clouds
  /// Makes cloud \p i and measures it, whatever was measured before.
  std::function<void(int i, ShapeReport& report)> measure;
  /// Writes the notes, after all clouds.
  std::function<void(ShapeReport& report)> conclude = [](ShapeReport&) {};
};

/// Measures all clouds, shared by the processes of a run.
/// \return the report, on the first process.
ShapeReport measuredCases(const ShapeCases& cases, ResumableRun& work, Step& step);

/// What the detector says of a cloud.
struct ShapeAnswers {
  std::vector<SymmetryPlane> planes;  ///< of all kinds
  std::vector<SymmetryAxis> axes;
  std::vector<SymmetryCenter> centers;
  std::vector<SymmetryTurn> turns;

  std::vector<SymmetryPlane> symmetries() const;
  /// Whether anything is called a symmetry.
  bool callSymmetric() const { return !symmetries().empty() || !axes.empty() || !centers.empty(); }
  /// Whether an axis along a direction is called a symmetry, and nothing else.
  bool callLine(const Eigen::Vector3d& direction) const;
};

/// Runs SymmetryMaximaRefinement, as a user would: the viewpoint of the cloud counts.
ShapeAnswers detectShape(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, const DetectionOptions& options);

/// The defaults of the library, with room for the planes of shapes of many folds.
DetectionOptions detectionOptions(const ShapeRowOptions& options);

/// A scan of a body with an axis, and what may break its symmetry.
struct TurningScan {
  std::string kind;  ///< round, folds or handle
  SweptShape shape;
  double reach = 0.0;                                    ///< of the body from the axis; a handle is beyond
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  ///< towards the scanner, frame of the shape
  VirtualScan scan = {};                                 ///< in a random pose
};

/// Scan \p i of kind `turns`: eight scans of each solid from random sides.
TurningScan turningScan(int i, const ShapeRowOptions& options);

// The kinds, each a table of its own. The options are kept by reference.
ShapeCases foldCases(const ShapeRowOptions& options);
ShapeCases viewCases(const ShapeRowOptions& options);
ShapeCases turnCases(const ShapeRowOptions& options);
ShapeCases randomCases(const ShapeRowOptions& options);
ShapeCases compositeCases(const ShapeRowOptions& options);
ShapeCases pointCountCases(const ShapeRowOptions& options);

}  // namespace pcl_symmetry::apps
