/// Error of the three estimators against the time they take (Figure 6), measured against the full sum.
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <functional>
#include <optional>

#include "command_line/command_line.h"
#include "command_line/run_tool.h"
#include "pictures/chart.h"
#include "core/base/parallel.h"
#include "core/base/random.h"
#include "models.h"
#include "pcl_symmetry/core/closest_point_search.h"
#include "pcl_symmetry/core/planar_transform.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::benchmarks;

constexpr int kNumBins = 64;  // of theta, phi and r
constexpr double kTarget = 0.01;

struct Settings {
  std::array<std::optional<std::string>, 5> files;
  std::optional<std::string> data, csv, png;
  int num_points = 10'000;
  int num_cells = 64;
  int num_probes = 300;
  int num_repeats = 9;
};

double prst(double d) {
  return std::sqrt(std::max(0.0, 0.5 * (1.0 + d)));
}

/// D(gamma) = sum over cells of f(x) f(gamma x) / sum f^2, with exact distances to the points.
std::vector<double> fullSum(const Points& points, const GaussianEdt& edt, const std::vector<ReflectionPlane>& planes) {
  const auto search = makeFlannSearch(points);
  std::vector<std::size_t> cells;
  for (std::size_t i = 0; i < edt.values().size(); ++i)
    if (edt.values()[i] > 0.0f) cells.push_back(i);
  std::vector<double> values(planes.size());
  parallelBlocks(planes.size(), 0, [&](std::size_t p) {
    Points reflected(3, cells.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      reflected.col(i) = planes[p].reflect(edt.cellCenter(cells[i])).cast<float>();
    std::vector<int> indices;
    std::vector<float> sq_distances;
    search->search(reflected, 1, indices, sq_distances);
    double sum = 0.0;
    for (std::size_t i = 0; i < cells.size(); ++i)
      sum += edt.values()[cells[i]] * std::exp(-sq_distances[i] / (edt.sigma() * edt.sigma()));
    values[p] = sum / edt.sqNorm();
  });
  return values;
}

/// What one estimator did with one setting on one model.
struct Measurement {
  std::string model;
  std::string method;
  double setting;  ///< samples, spacing in sigmas, or pairs
  double best_ms;
  double median_ms;
  double rms;          ///< of PRST against the full sum at the bin centers
  double bias;         ///< mean error of PRST, the same
  double rms_average;  ///< of PRST against the averages over the bins, over all of them
};

/// The full sum at random bins, and the averages over all bins.
struct Reference {
  std::vector<std::size_t> bins;
  std::vector<double> at_centers;
  std::vector<float> averages;
};

Reference makeReference(const Points& points, const GaussianEdt& edt, const PlaneGrid& grid, int num_probes) {
  Reference reference;
  RandomStream random(3);
  std::vector<ReflectionPlane> planes;
  for (int i = 0; i < num_probes; ++i) {
    reference.bins.push_back(random.below(grid.size()));
    planes.push_back(grid.plane(grid.bin(reference.bins.back())));
  }
  reference.at_centers = fullSum(points, edt, planes);
  // Averages: two by two by two bins in one, each at its center by convolution.
  const PlaneGrid fine(2 * grid.numTheta(), 2 * grid.numPhi(), 2 * grid.numRadius(), grid.center(), grid.radius());
  const SymmetryMap map = convolutionTransform(edt, fine);
  reference.averages.assign(grid.size(), 0.0f);
  for (std::size_t i = 0; i < fine.size(); ++i) {
    const PlaneGrid::Bin bin = fine.bin(i);
    reference.averages[grid.index({bin.theta / 2, bin.phi / 2, bin.radius / 2})] += 0.125f * map[i];
  }
  return reference;
}

Measurement measure(const std::string& model, const std::string& method, double setting, int num_repeats,
                    const Reference& reference, const std::function<SymmetryMap()>& estimate) {
  std::vector<double> times;
  SymmetryMap map;
  for (int i = 0; i < num_repeats; ++i) {
    const auto start = std::chrono::steady_clock::now();
    map = estimate();
    times.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(times.begin(), times.end());
  Measurement result{model, method, setting, times.front(), times[times.size() / 2], 0.0, 0.0, 0.0};
  const double size = static_cast<double>(reference.bins.size());
  for (std::size_t i = 0; i < reference.bins.size(); ++i) {
    const double error = map.prst(reference.bins[i]) - prst(reference.at_centers[i]);
    result.rms += error * error / size;
    result.bias += error / size;
  }
  double sq_sum = 0.0;
  for (std::size_t i = 0; i < map.values.size(); ++i) sq_sum += std::pow(map.prst(i) - prst(reference.averages[i]), 2);
  result.rms = std::sqrt(result.rms);
  result.rms_average = std::sqrt(sq_sum / static_cast<double>(map.values.size()));
  return result;
}

std::vector<Measurement> measureModel(const Model& model, const Settings& settings) {
  const Points points = model.sample(settings.num_points);
  GaussianEdtOptions edt_options;
  edt_options.num_cells = settings.num_cells;
  const GaussianEdt edt(points, edt_options);
  const PlaneGrid grid(kNumBins, kNumBins, kNumBins, edt.center(), edt.radius());
  const Reference reference = makeReference(points, edt, grid, settings.num_probes);
  std::vector<Measurement> results;
  for (const int num_samples : {32, 64, 128, 256, 512, 1024, 2048, 4096}) {
    SampledTransformOptions options;
    options.num_samples = num_samples;
    results.push_back(measure(model.name, "sampled", num_samples, settings.num_repeats, reference,
                              [&] { return sampledTransform(edt, grid, options); }));
  }
  for (const double spacing : {1.0, 0.9, 0.7, 0.5}) {
    ConvolutionTransformOptions options;
    options.spacing = spacing;
    results.push_back(measure(model.name, "convolution", spacing, std::min(3, settings.num_repeats), reference,
                              [&] { return convolutionTransform(edt, grid, options); }));
  }
  for (const bool near : {true, false}) {
    for (const std::int64_t num_pairs : {200'000, 2'000'000, 20'000'000}) {
      VotingTransformOptions options;
      options.num_pairs = num_pairs;
      if (!near) options.near_distance = 0.0;
      results.push_back(measure(model.name, near ? "voting" : "voting, as written", static_cast<double>(num_pairs), 1,
                                reference, [&] { return votingTransform(edt, grid, options); }));
    }
  }
  return results;
}

std::vector<Measurement> select(const std::vector<Measurement>& all, const std::string& model,
                                const std::string& method) {
  std::vector<Measurement> selected;
  for (const Measurement& m : all)
    if ((model.empty() || m.model == model) && m.method == method) selected.push_back(m);
  return selected;
}

/// Time at which the error falls below the target, on straight lines through the logarithms; beyond the last
/// measurement the error falls as the root of the time.
double timeToTarget(const std::vector<Measurement>& curve, double Measurement::*error) {
  const Measurement& last = curve.back();
  if (last.*error > kTarget) return last.best_ms * std::pow(last.*error / kTarget, 2.0);
  std::size_t i = 1;
  while (curve[i].*error > kTarget) ++i;
  const Measurement &a = curve[i - 1], &b = curve[i];
  const double slope = std::log(b.best_ms / a.best_ms) / std::log(b.*error / (a.*error));
  return a.best_ms * std::pow(kTarget / (a.*error), slope);
}

void printTable(const std::vector<Measurement>& all) {
  std::printf("%-12s %-20s %10s %10s %10s %9s %9s %9s\n", "model", "method", "setting", "best ms", "median ms", "rms %",
              "bias %", "rms avg %");
  for (const Measurement& m : all)
    std::printf("%-12s %-20s %10.4g %10.2f %10.2f %9.3f %9.3f %9.3f\n", m.model.c_str(), m.method.c_str(), m.setting,
                m.best_ms, m.median_ms, 100.0 * m.rms, 100.0 * m.bias, 100.0 * m.rms_average);
}

void printTargets(const std::vector<Measurement>& all, const std::vector<Model>& models) {
  std::printf("\n%-12s %18s %22s %10s %22s %18s\n", "model", "sampled, 1 % [ms]", "voting, 1 % [ms]", "ratio",
              "default: rms % at ms", "convolution % ms");
  const double default_samples = SampledTransformOptions().num_samples,
               default_spacing = ConvolutionTransformOptions().spacing;
  for (const Model& model : models) {
    const auto sampled = select(all, model.name, "sampled"), voting = select(all, model.name, "voting");
    const double sampled_ms = timeToTarget(sampled, &Measurement::rms);
    // Voting estimates averages: judged by those, which favours it.
    const double voting_ms = timeToTarget(voting, &Measurement::rms_average);
    std::printf("%-12s %18.2f %22.0f %10.0f", model.name.c_str(), sampled_ms, voting_ms, voting_ms / sampled_ms);
    for (const Measurement& m : sampled)
      if (m.setting == default_samples) std::printf(" %12.3f at %6.2f", 100.0 * m.rms, m.best_ms);
    for (const Measurement& m : select(all, model.name, "convolution"))
      if (m.setting == default_spacing) std::printf(" %9.3f at %6.1f", 100.0 * m.rms, m.best_ms);
    std::printf("\n");
  }
}

void writeCsv(const std::string& file, const std::vector<Measurement>& all) {
  std::ofstream out(file);
  out << "model,method,setting,best_ms,median_ms,rms,bias,rms_average\n";
  for (const Measurement& m : all)
    out << m.model << ",\"" << m.method << "\"," << m.setting << ',' << m.best_ms << ',' << m.median_ms << ',' << m.rms
        << ',' << m.bias << ',' << m.rms_average << '\n';
  if (!out.flush()) throw std::runtime_error(file + ": cannot be written");
}

/// Root mean square error and mean time over the models for each setting.
apps::ChartSeries meanCurve(const std::vector<Measurement>& all, const std::string& method,
                            double Measurement::*error) {
  apps::ChartSeries series{method, {}, {}};
  const auto selected = select(all, "", method);
  for (const Measurement& first : select(all, all.front().model, method)) {
    double sq_error = 0.0, time = 0.0;
    int count = 0;
    for (const Measurement& m : selected) {
      if (m.setting != first.setting) continue;
      sq_error += m.*error * (m.*error);
      time += m.best_ms;
      ++count;
    }
    series.x.push_back(time / count);
    series.y.push_back(std::sqrt(sq_error / count));
  }
  return series;
}

std::vector<Model> modelsOf(const Settings& settings) {
  std::vector<Model> models;
  for (const auto& file : settings.files)
    if (file) models.push_back(readOff(*file));
  return models.empty() ? fiveModels(settings.data.value_or("")) : models;
}

int run(int argc, char** argv) {
  Settings settings;
  apps::CommandLine line("benchmark_accuracy", "Error of the estimators against the full sum, and the time they take.",
                         "benchmark_accuracy -data /usr/share/doc/libcgal-demo/data/meshes -png error.png");
  for (std::size_t i = 0; i < settings.files.size(); ++i)
    line.positional("model" + std::to_string(i + 1), settings.files[i], "an OFF file, instead of the five models");
  line.text("data", "FOLDER", settings.data, "with bull, cow, elephant, hand and camel .off; synthetic shapes without")
      .text("csv", "FILE", settings.csv, "for the table")
      .text("png", "FILE", settings.png, "for a plot of error against time");
  if (!line.parse(argc, argv)) return 0;
  const std::vector<Model> models = modelsOf(settings);
  std::vector<Measurement> all;
  for (const Model& model : models) {
    const auto results = measureModel(model, settings);
    all.insert(all.end(), results.begin(), results.end());
  }
  printTable(all);
  printTargets(all, models);
  if (settings.csv) writeCsv(*settings.csv, all);
  if (settings.png) {
    apps::Chart chart;
    chart.title = "Error of PRST against time, mean of the models";
    chart.x = {"time [ms]", true, {}};
    chart.y = {"root mean square error of PRST", true, {}};
    chart.series = {meanCurve(all, "sampled", &Measurement::rms), meanCurve(all, "convolution", &Measurement::rms),
                    meanCurve(all, "voting", &Measurement::rms_average),
                    meanCurve(all, "voting, as written", &Measurement::rms_average)};
    apps::ChartSeries target{"1 %", {1e-3, 1e9}, {kTarget, kTarget}};
    target.reference = true;
    chart.series.push_back(target);
    apps::writeChart(chart, *settings.png);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  return pcl_symmetry::apps::runTool(argc, argv, run);
}
