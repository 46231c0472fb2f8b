/// Interrupts writers of a database and damages its bytes: benchmark_database_safety [INTERRUPTIONS [BYTES]], 500
/// kills, 500 power failures and 10 000 bytes by default. Exit status 1 if anything was lost, torn or taken for
/// something else.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "pcl/damaged_database.h"
#include "pcl/interrupted_writer.h"

namespace {

using namespace pcl_symmetry;

int interrupt(test::Interruption interruption, const char* name, int count, const std::string& folder) {
  test::InterruptedWriter writer(folder + "/" + name + ".db");
  int num_wrong = 0;
  for (int i = 0; i < count; ++i) {
    const std::string wrong = writer.run(interruption, static_cast<std::uint64_t>(i));
    if (!wrong.empty()) std::printf("%s %d: %s\n", name, i, wrong.c_str());
    num_wrong += wrong.empty() ? 0 : 1;
  }
  std::printf("%d times %s: %zu changes, %d times wrong\n", count, name, writer.numChanges(), num_wrong);
  return num_wrong;
}

int damage(int count, const std::string& folder) {
  test::DamagedDatabase database(folder + "/damaged.db");
  RandomStream random(1);
  int num_wrong = 0;
  for (int i = 0; i < count; ++i) {
    const std::size_t place = random.below(database.size());
    const auto mask = static_cast<char>(i % 2 == 0 ? 0xff : 1 << random.below(8));
    const std::string wrong = database.flip(place, mask);
    if (!wrong.empty())
      std::printf("byte %zu, bits %02x: %s\n", place, static_cast<unsigned char>(mask), wrong.c_str());
    num_wrong += wrong.empty() ? 0 : 1;
  }
  std::printf("%d bytes damaged, one at a time, of %zu: %d found, %d harmless, %d times wrong\n", count,
              database.size(), database.numFound(), count - database.numFound() - num_wrong, num_wrong);
  return num_wrong;
}

}  // namespace

int main(int argc, char** argv) {
  const int num_interruptions = argc > 1 ? std::atoi(argv[1]) : 500, num_bytes = argc > 2 ? std::atoi(argv[2]) : 10'000;
  const std::string folder = (std::filesystem::temp_directory_path() / "pcl_symmetry_database_safety").string();
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  const int num_wrong = interrupt(test::Interruption::Kill, "killed", num_interruptions, folder) +
                        interrupt(test::Interruption::PowerFailure, "power failed", num_interruptions, folder) +
                        damage(num_bytes, folder);
  std::filesystem::remove_all(folder);
  return num_wrong == 0 ? 0 : 1;
}
