/// What queries and changes of a large database cost, and what they find: benchmark_database_size DATABASE MODELS FILE
/// [SCANS]. FILE is a database of MODELS models, made where it is missing of those of DATABASE and of variants of them.
/// Queries of match are true variants; SCANS is a folder of PCD files, named as models of DATABASE, that are
/// recognized.
#include <pcl/io/pcd_io.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/matching/shape_description.h"
#include "database_variants.h"

namespace {

using namespace pcl_symmetry;
namespace fs = std::filesystem;

constexpr int kNumQueries = 100, kNumMeasured = 60;

double memory(const char* field) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(field, 0) == 0) return std::atof(line.c_str() + std::string(field).size() + 1) / 1024.0;
  return 0.0;
}

/// Medians of wall and processor time, milliseconds.
class Times {
public:
  template <typename Body>
  void add(const Body& body) {
    const auto start = std::chrono::steady_clock::now();
    const std::clock_t processor = std::clock();
    body();
    used_.push_back(1000.0 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC);
    wall_.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
  }
  void print(const char* what) const {
    std::printf("%-24s %9.1f ms %9.1f ms of processors, memory %4.0f MB, at most %4.0f MB\n", what, median(wall_),
                median(used_), memory("VmRSS:"), memory("VmHWM:"));
    std::fflush(stdout);
  }

private:
  static double median(std::vector<double> times) {
    std::nth_element(times.begin(), times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2), times.end());
    return times[times.size() / 2];
  }

  std::vector<double> wall_, used_;
};

template <typename Body>
void timed(const char* what, const Body& body) {
  Times times;
  times.add(body);
  times.print(what);
}

SymmetryDatabase::Cloud cloudOf(const Points& points) {
  SymmetryDatabase::Cloud cloud(static_cast<std::uint32_t>(points.cols()), 1);
  cloud.getMatrixXfMap(3, 4, 0) = points;
  return cloud;
}

std::string sourceOf(const std::string& name) {
  return name.substr(0, name.find('~'));
}

/// Distances, as SymmetryDatabase::match() has them, by a comparison with all forms.
class ExactScan {
public:
  explicit ExactScan(const std::string& file) {
    detail::ModelStore store(file, 10.0, "");
    fitted_ = detail::FittedForms::unpacked(store.projection().value());
    compact_.resize(fitted_.forms->numDimensions(), detail::kFormsPerModel * store.size());
    Eigen::Index next = 0;
    store.eachForms(fitted_.id, [&](std::int64_t, const std::string& bytes) {
      const detail::CompactForm form = detail::CompactForm::unpacked(bytes);
      compact_.middleCols<detail::kFormsPerModel>(next) = form.compact;
      next += detail::kFormsPerModel;
      typical_.push_back(form.typical);
    });
  }

  /// The least distance.
  double nearest(const Points& points) const {
    const detail::CompactForm form = fitted_.forms->formOf(describeShape(points).signatures, 0);
    const Eigen::RowVectorXf cosines = (fitted_.forms->rotations(form).transpose() * compact_).colwise().maxCoeff();
    double least = 1e9;
    for (std::size_t i = 0; i < typical_.size(); ++i) {
      const float cosine =
          cosines.segment<detail::kFormsPerModel>(detail::kFormsPerModel * static_cast<Eigen::Index>(i)).maxCoeff();
      least = std::min(least, std::sqrt(std::max(0.0, 2.0 - 2.0 * cosine) / (typical_[i] * form.typical)));
    }
    return least;
  }

private:
  detail::FittedForms fitted_;
  Eigen::MatrixXf compact_;
  std::vector<float> typical_;
};

struct Query {
  std::string model;
  Points points;
};

std::vector<Query> queriesOf(benchmark::VariantSource& source) {
  std::vector<Query> queries;
  const auto& models = source.models();
  for (std::size_t i = 0; i < kNumQueries; ++i) {
    const detail::StoredModel& model = models[(i * models.size() + models.size() / 2) / kNumQueries];
    RandomStream random(5, i);
    queries.push_back({model.name, benchmark::VariantSource::trueVariant(source.points(model), random)});
  }
  return queries;
}

/// \return least distances.
std::vector<double> matchAll(const SymmetryDatabase& database, const std::vector<Query>& queries) {
  Viewpoint none;
  none.mode = Viewpoint::Mode::None;
  timed("match, first", [&] { database.match(cloudOf(queries[0].points), 10, none); });
  Times times;
  int right = 0;
  std::vector<double> distances;
  for (const Query& query : queries) {
    std::vector<ModelMatch> found;
    times.add([&] { found = database.match(cloudOf(query.points), 10, none); });
    right += sourceOf(found.at(0).name) == query.model ? 1 : 0;
    distances.push_back(found[0].distance);
  }
  times.print("match");
  std::printf("the model of the query is the nearest: %d of %zu\n", right, queries.size());
  return distances;
}

void recognizeAll(const SymmetryDatabase& database, const std::string& folder, const RecognitionOptions& options) {
  std::vector<fs::path> scans;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".pcd" && database.contains(entry.path().stem().string()))
      scans.push_back(entry.path());
  std::sort(scans.begin(), scans.end());
  Times times;
  std::size_t right = 0, unknown = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    SymmetryDatabase::Cloud cloud;
    if (pcl::io::loadPCDFile(scans[i].string(), cloud) != 0) throw std::runtime_error(scans[i].string());
    if (i == 0) timed("recognize, first", [&] { database.recognize(cloud, options); });
    Recognition found;
    times.add([&] { found = database.recognize(cloud, options); });
    unknown += found.empty() ? 1 : 0;
    right += !found.empty() && sourceOf(found[0].name) == scans[i].stem().string() ? 1 : 0;
  }
  times.print("recognize");
  std::printf("the scanned model comes first: %zu of %zu, unknown: %zu\n", right, scans.size(), unknown);
}

void measure(const std::string& file, const std::vector<Query>& queries, const std::string& scans,
             const RecognitionOptions& options) {
  std::unique_ptr<SymmetryDatabase> database;
  timed("open", [&] { database = std::make_unique<SymmetryDatabase>(file); });
  const std::vector<double> distances = matchAll(*database, queries);
  if (!scans.empty()) {
    database = std::make_unique<SymmetryDatabase>(file);
    recognizeAll(*database, scans, options);
  }
  const SymmetryDatabase::Cloud cloud = cloudOf(queries[0].points);
  timed("add", [&] { database->add("added", cloud); });
  timed("match after add", [&] { database->match(cloud); });
  timed("remove", [&] { database->remove("added"); });
  database.reset();
  const ExactScan exact(file);
  int same = 0;
  for (std::size_t i = 0; i < queries.size(); ++i)
    same += distances[i] <= exact.nearest(queries[i].points) + 1e-3 ? 1 : 0;
  std::printf("the nearest of an exact scan is found: %d of %zu\n", same, queries.size());
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4 || std::atoi(argv[2]) < 1) {
    std::fprintf(stderr, "usage: benchmark_database_size DATABASE MODELS FILE [SCANS [CANDIDATES]], MODELS >= 1\n");
    return 2;
  }
  const std::string file = argv[3];
  benchmark::VariantSource source(argv[1]);
  if (!fs::exists(file)) {
    benchmark::Variation variation;
    timed("true variants", [&] { variation = source.measure(kNumMeasured); });
    timed("fill", [&] { source.fill(file, std::atoi(argv[2]), variation); });
  }
  const std::size_t size = SymmetryDatabase(file).size();
  std::printf("%zu models, %ju bytes each\n", size, static_cast<std::uintmax_t>(fs::file_size(file)) / size);
  RecognitionOptions options;
  if (argc > 5) options.num_candidates = std::atoi(argv[5]);
  measure(file, queriesOf(source), argc > 4 ? argv[4] : "", options);
  return 0;
}
