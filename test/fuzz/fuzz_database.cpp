/// A database of models that is a file of arbitrary bytes.
#include <pcl/exceptions.h>
#include <unistd.h>

#include <fstream>

#include "fuzz/byte_source.h"
#include "pcl_symmetry/symmetry_database.h"

namespace {

using namespace pcl_symmetry;

void readFile(const std::string& file) {
  DatabaseOptions options;
  options.num_threads = 1;
  options.lock_timeout = 0.0;
  SymmetryDatabase::check(file);
  const SymmetryDatabase database(file, options);
  for (const std::string& name : database.names()) {
    database.info(name);
    for (const pcl::PointXYZ& point : database.cloud(name)) FUZZ_CHECK(point.getVector3fMap().allFinite());
  }
  pcl::PointCloud<pcl::PointXYZ> query;
  for (int i = 0; i < 27; ++i)
    query.push_back({static_cast<float>(i % 3), static_cast<float>(i / 3 % 3), 1.1f * static_cast<float>(i / 9)});
  database.match(query);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const std::string file = "/dev/shm/pcl_symmetry_fuzz_" + std::to_string(::getpid()) + ".db";
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  try {
    readFile(file);
  } catch (const pcl::IOException&) {
  }
  for (const char* other : {"", "-wal", "-shm", "-journal"}) ::unlink((file + other).c_str());
  return 0;
}
