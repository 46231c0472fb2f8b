/// The parts of models that are stored in a database, as any bytes; the first byte chooses the part.
#include <stdexcept>

#include "core/matching/view_code.h"
#include "fuzz/byte_source.h"
#include "recognition/fitted_forms.h"
#include "recognition/packed_model.h"

namespace {

using namespace pcl_symmetry;

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

void compareCodes(const std::string& part) {
  ViewCodeIndex index;
  index.add(part);
  index.nearest(ViewCode{}, 0.25, 3, 1);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteSource source(data, size);
  const int kind = source.below(6);
  const std::string bytes = source.rest();
  switch (kind) {
    case 0:
      readPart(bytes, [](const std::string& part) { detail::unpackedCloud(part); });
      break;
    case 1:
      readPart(bytes, [](const std::string& part) { detail::unpackedSignatures(part); });
      break;
    case 2:
      readPart(bytes, [](const std::string& part) { detail::unpackedViews(part); });
      break;
    case 3:
      readPart(bytes, [](const std::string& part) { detail::CompactForm::unpacked(part); });
      break;
    case 4:
      readPart(bytes, [](const std::string& part) { detail::CompactForms::unpacked(part); });
      break;
    default:
      readPart(bytes, compareCodes);
  }
  return 0;
}
