#include "evaluate/shapes/shape_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/base/constants.h"
#include "core/base/random.h"
#include "evaluate/runs/packed_rows.h"
#include "pcl_symmetry/symmetry_maxima_refinement.h"

namespace pcl_symmetry::apps {

namespace {

constexpr double kLineAngle = 3.0 * kDegree;  // radians; derived: the limit of `planes`
constexpr int kMostFolds = 64;                // planes; chosen: above the 25 of the shapes with most folds

}  // namespace

std::uint64_t ShapeRowOptions::caseSeed(int i) const {
  return RandomStream(seed, 2 * static_cast<std::uint64_t>(i) + (report ? 1 : 0))();
}

Proportion& ShapeReport::at(const std::string& row, std::size_t column) {
  auto found = std::find_if(rows_.begin(), rows_.end(), [&](const auto& entry) { return entry.first == row; });
  if (found == rows_.end()) found = rows_.insert(found, {row, std::vector<Proportion>(columns_.size())});
  return found->second.at(column);
}

void ShapeReport::add(const ShapeReport& cloud) {
  for (const auto& [name, rates] : cloud.rows_)
    for (std::size_t i = 0; i < rates.size(); ++i) at(name, i) += rates[i];
  for (const auto& [name, count] : cloud.tallies_) tallies_[name] += count;
  notes_.insert(notes_.end(), cloud.notes_.begin(), cloud.notes_.end());
  log_.insert(log_.end(), cloud.log_.begin(), cloud.log_.end());
}

void ShapeReport::print() const {
  constexpr int kNameWidth = 22, kWidth = 34;  // characters; chosen: the longest entry fits
  std::printf("%-*s", kNameWidth, "");
  for (const std::string& column : columns_) std::printf("| %-*s", kWidth, column.c_str());
  std::printf("\n");
  const auto printRow = [&](const auto& row) {
    std::printf("%-*s", kNameWidth, row.first.c_str());
    for (const Proportion& rate : row.second) std::printf("| %-*s", kWidth, rate.text().c_str());
    std::printf("\n");
  };
  for (const auto& row : rows_)
    if (row.first != "all") printRow(row);
  for (const auto& row : rows_)
    if (row.first == "all") printRow(row);
  for (const std::string& line : notes_) std::printf("%s\n", line.c_str());
}

nlohmann::json ShapeReport::json() const {
  nlohmann::json rows = nlohmann::json::array();
  for (const auto& [name, rates] : rows_) {
    nlohmann::json row{{"row", name}};
    for (std::size_t i = 0; i < rates.size(); ++i) {
      const Interval interval = rates[i].wilson();
      row[columns_[i]] = {
          {"count", rates[i].count}, {"total", rates[i].total}, {"low", interval.low}, {"high", interval.high}};
    }
    rows.push_back(row);
  }
  return {{"rows", rows}, {"notes", notes_}};
}

std::string ShapeReport::csv() const {
  std::string text;
  for (const std::string& line : log_) text += line + "\n";
  return text;
}

void put(detail::PackedBytes& bytes, const ShapeReport& report) {
  const auto putSize = [&](const auto& list) { bytes.put(static_cast<std::uint32_t>(list.size())); };
  putSize(report.rows_);
  for (const auto& [name, rates] : report.rows_) {
    bytes.putText(name);
    putSize(rates);
    for (const Proportion& rate : rates) bytes.put(rate);
  }
  putSize(report.tallies_);
  for (const auto& [name, count] : report.tallies_) {
    bytes.putText(name);
    bytes.put(count);
  }
  for (const auto* lines : {&report.notes_, &report.log_}) {
    putSize(*lines);
    for (const std::string& line : *lines) bytes.putText(line);
  }
}

void get(detail::UnpackedBytes& bytes, ShapeReport& report) {
  const auto eachOf = [&](const auto& read) {
    for (auto left = bytes.get<std::uint32_t>(); left > 0; --left) read();
  };
  eachOf([&] {
    std::vector<Proportion>& rates = report.rows_.emplace_back(bytes.text(), std::vector<Proportion>()).second;
    eachOf([&] { rates.push_back(bytes.get<Proportion>()); });
  });
  eachOf([&] {
    const std::string name = bytes.text();
    report.tallies_[name] = bytes.get<int>();
  });
  for (auto* lines : {&report.notes_, &report.log_}) eachOf([&] { lines->push_back(bytes.text()); });
}

ShapeReport measuredCases(const ShapeCases& cases, ResumableRun& work, Step& step) {
  std::vector<std::string> names;
  for (int i = 0; i < cases.count; ++i) names.push_back("cloud " + std::to_string(i));
  const auto measure = [&](std::size_t i) {
    ItemRows<ShapeReport> item{{cases.report.ofCloud()}, ""};
    cases.measure(static_cast<int>(i), item.rows.front());
    return item;
  };
  std::vector<std::string> left_out;
  ShapeReport report = cases.report;
  for (const ShapeReport& cloud : joinedRows(rowsOfItems<ShapeReport>(names, measure, work, step), left_out))
    report.add(cloud);
  cases.conclude(report);
  for (const std::string& reason : left_out) report.note("left out: " + reason);
  return report;
}

std::vector<SymmetryPlane> ShapeAnswers::symmetries() const {
  std::vector<SymmetryPlane> found;
  std::copy_if(planes.begin(), planes.end(), std::back_inserter(found),
               [](const SymmetryPlane& plane) { return plane.kind == PlaneKind::Symmetry; });
  return found;
}

bool ShapeAnswers::callLine(const Eigen::Vector3d& direction) const {
  const bool is_along = std::all_of(axes.begin(), axes.end(), [&](const SymmetryAxis& axis) {
    return std::abs(axis.direction.dot(direction)) >= std::cos(kLineAngle);
  });
  return !axes.empty() && is_along && symmetries().empty() && centers.empty();
}

ShapeAnswers detectShape(const pcl::PointCloud<pcl::PointXYZ>::ConstPtr& cloud, const DetectionOptions& options) {
  SymmetryMaximaRefinement<pcl::PointXYZ> refinement;
  refinement.setOptions(options);
  refinement.setInputCloud(cloud);
  ShapeAnswers answers;
  answers.planes = refinement.compute();
  answers.axes = refinement.getAxes();
  answers.turns = refinement.getTurns();
  answers.centers = refinement.getCenters();
  return answers;
}

DetectionOptions detectionOptions(const ShapeRowOptions& options) {
  DetectionOptions detection;
  detection.max_planes = kMostFolds;
  detection.seed = options.seed + 1;
  detection.num_threads = detection.edt.num_threads = options.threads;
  return detection;
}

}  // namespace pcl_symmetry::apps
