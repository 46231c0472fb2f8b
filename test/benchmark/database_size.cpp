/// What queries and changes of a large database cost: benchmark_database_size DATABASE MODELS [FILE]. Copies the models
/// of a database under new names until there are that many, in FILE or a temporary one, and asks with clouds of the
/// first.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/storage/model_store.h"

namespace {

using namespace pcl_symmetry;

double resident() {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind("VmRSS:", 0) == 0) return std::atof(line.c_str() + 6) / 1024.0;
  return 0.0;
}

template <typename Body>
void timed(const char* what, const Body& body) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t processor = std::clock();
  body();
  const double used = 1000.0 * static_cast<double>(std::clock() - processor) / CLOCKS_PER_SEC;
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  std::printf("%-16s %10.1f ms %10.1f ms of processors %6.0f MB\n", what, time.count(), used, resident());
}

/// Copies with their compact forms, so that nothing has to be fitted.
void fill(const std::string& from, const std::string& to, int count) {
  detail::ModelStore source(from, 10.0, ""), target(to, 10.0, "");
  const auto projection = source.projection();
  std::map<std::int64_t, std::string> forms;
  source.eachForms(projection->id, [&](detail::PackedForms packed) { forms[packed.model] = packed.forms; });
  target.setProjection(*projection, {});
  const auto& models = source.models();
  for (int i = 0; i < count; ++i) {
    const detail::StoredModel& model = models[static_cast<std::size_t>(i) % models.size()];
    const detail::PackedModel packed{source.part(detail::ModelPart::Cloud, model),
                                     source.part(detail::ModelPart::Signatures, model),
                                     source.part(detail::ModelPart::Views, model), 20'000};
    target.add({model.name + "_" + std::to_string(i), 0, {}, packed.num_points}, packed, target.projectionId(),
               forms.at(model.id));
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || std::atoi(argv[2]) < 1) {
    std::fprintf(stderr, "usage: benchmark_database_size DATABASE MODELS [FILE], MODELS >= 1\n");
    return 2;
  }
  const bool keeps = argc > 3;
  const std::string file = keeps ? argv[3] : (std::filesystem::temp_directory_path() / "database_size.db").string();
  if (!keeps) std::filesystem::remove(file);
  if (!std::filesystem::exists(file)) timed("fill", [&] { fill(argv[1], file, std::atoi(argv[2])); });
  std::printf("%ju bytes a model\n",
              static_cast<std::uintmax_t>(std::filesystem::file_size(file)) / std::atoi(argv[2]));
  std::unique_ptr<SymmetryDatabase> database;
  timed("open", [&] { database = std::make_unique<SymmetryDatabase>(file); });
  const std::string name = database->names().front();
  const SymmetryDatabase::Cloud cloud = database->cloud(name);
  Viewpoint none;
  none.mode = Viewpoint::Mode::None;
  timed("names", [&] { database->names(); });
  timed("match, first", [&] { database->match(cloud, 10, none); });
  for (int i = 0; i < 3; ++i) timed("match", [&] { database->match(cloud, 10, none); });
  timed("add", [&] { database->add("added", cloud); });
  timed("match after add", [&] { database->match(cloud, 10, none); });
  timed("remove", [&] { database->remove("added"); });
  database.reset();
  if (!keeps) std::filesystem::remove(file);
  return 0;
}
