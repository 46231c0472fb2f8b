#include "io/volume_input.h"

#include <boost/algorithm/string.hpp>
#include <new>

#include "command_line/tool_errors.h"
#include "io/file_text.h"
#include "io/load_module.h"
#include "pictures/drawing.h"

namespace pcl_symmetry::apps {

bool isVolumePath(const std::string& path) {
  for (const char* ending : {".nii", ".nii.gz", ".nrrd", ".nhdr", ".mha", ".mhd", ".vti"})
    if (boost::algorithm::iends_with(path, ending)) return true;
  return false;
}

Volume loadVolume(const std::string& path) {
  Volume volume;
  try {
    functionOf<decltype(readVolume)>(kDrawingModule, "readVolume")(path, volume);
  } catch (const std::bad_alloc&) {
    throw InputError(path + ": is too large for the memory of this machine");
  } catch (const std::invalid_argument& error) {
    throw InputError(path + ": cannot be read, " + error.what());
  }
  return volume;
}

}  // namespace pcl_symmetry::apps
