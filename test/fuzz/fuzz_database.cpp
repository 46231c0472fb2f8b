/// Databases of models: a file of arbitrary bytes, and the parts of models that are stored in one. The first byte chooses.
#include <pcl/exceptions.h>
#include <unistd.h>

#include <fstream>
#include <stdexcept>

#include "core/views/view_code_index.h"
#include "fuzz/byte_source.h"
#include "pcl_symmetry/recognition/symmetry_database.h"
#include "recognition/packing/packed_bytes.h"
#include "recognition/packing/packed_model.h"
#include "recognition/search/compact_forms.h"

namespace {

using namespace pcl_symmetry;

void readFile(const std::string& bytes) {
  static const std::string file = "/dev/shm/pcl_symmetry_fuzz_" + std::to_string(::getpid()) + ".db";
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  DatabaseOptions options;
  options.num_threads = 1;
  options.lock_timeout = 0.0;
  try {
    SymmetryDatabase::check(file);
    const SymmetryDatabase database(file, options);
    for (const std::string& name : database.names()) {
      database.info(name);
      for (const pcl::PointXYZ& point : database.cloud(name)) FUZZ_CHECK(point.getVector3fMap().allFinite());
    }
    pcl::PointCloud<pcl::PointXYZ> query;
    for (int i = 0; i < 27; ++i) query.push_back({float(i % 3), float(i / 3 % 3), 1.1f * float(i / 9)});
    database.match(query);
  } catch (const pcl::IOException&) {
  }
  for (const char* other : {"", "-wal", "-shm", "-journal"}) ::unlink((file + other).c_str());
}

/// What may stand in a row of the database, once its checksum and its compression hold.
template <typename Unpack>
void readPart(const std::string& bytes, const Unpack& unpack) {
  for (const bool is_compressed : {false, true}) {
    try {
      unpack(is_compressed ? detail::compressed(bytes, detail::Effort::Low) : bytes);
    } catch (const std::invalid_argument&) {
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteSource source(data, size);
  const int kind = source.below(7);
  const std::string bytes = source.rest();
  switch (kind) {
    case 0:
      readFile(bytes);
      break;
    case 1:
      readPart(bytes, [](const std::string& part) { detail::unpackedCloud(part); });
      break;
    case 2:
      readPart(bytes, [](const std::string& part) { detail::unpackedSignatures(part); });
      break;
    case 3:
      readPart(bytes, [](const std::string& part) { detail::unpackedViews(part); });
      break;
    case 4:
      readPart(bytes, [](const std::string& part) { detail::CompactForm::unpacked(part); });
      break;
    case 5:
      readPart(bytes, [](const std::string& part) { detail::CompactForms::unpacked(part); });
      break;
    default:
      readPart(bytes, [](const std::string& part) {
        ViewCodeIndex index;
        index.add(part);
        index.nearest(ViewCode{}, 0.25, 3, 1);
      });
  }
  return 0;
}
