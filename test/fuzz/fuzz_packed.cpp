/// The parts of models that are stored in a database, as any bytes; the first byte chooses the part.
#include <stdexcept>

#include "core/matching/view_code.h"
#include "fuzz/byte_source.h"
#include "recognition/fitted_forms.h"
#include "recognition/packed_model.h"

namespace {

using namespace pcl_symmetry;

/// What may stand in a row of the database, once its checksum holds.
void readPart(const std::string& bytes, void (*unpack)(const std::string&)) {
  try {
    unpack(bytes);
  } catch (const std::invalid_argument&) {
  }
}

void compareCodes(const std::string& part) {
  ViewCodeIndex index;
  index.add(part);
  index.nearest(ViewCode{}, 3, 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  void (*const parts[])(const std::string&) = {[](const std::string& part) { detail::unpackedCloud(part); },
                                               [](const std::string& part) { detail::unpackedSignatures(part); },
                                               [](const std::string& part) { detail::unpackedViews(part); },
                                               [](const std::string& part) { detail::CompactForm::unpacked(part); },
                                               [](const std::string& part) { detail::CompactForms::unpacked(part); },
                                               compareCodes,
                                               [](const std::string& part) { detail::unpackedSurfaces(part); }};
  fuzz::ByteSource source(data, size);
  const int kind = source.below(7);
  readPart(source.rest(), parts[kind]);
  return 0;
}
