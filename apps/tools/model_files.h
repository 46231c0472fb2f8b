/// Which files a database is built of, and what is stored of each.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "command_line/tool_errors.h"
#include "pcl_symmetry/symmetry_database.h"

namespace pcl_symmetry::apps {

struct ModelFile {
  std::string path;
  std::string name;  ///< of the model
};

/// \param arguments files; folders, with the shape files in them and in folders of theirs; patterns with *, ? and [];
/// and lists "@FILE" of any of these, one on each line, # before comments.
/// \param by_path names are paths, "_" for "/", within the folder that was given; else the file's name without ending.
/// \throws InputError where a list or folder cannot be read or a pattern has no file. A file that is missing is kept,
/// to be reported with those that cannot be used.
std::vector<ModelFile> modelFiles(const std::vector<std::string>& arguments, bool by_path);

/// \return 16 hexadecimal digits, the CRC-64 of the bytes of a file.
/// \throws InputError where it cannot be read.
std::string fileChecksum(const std::string& path);

/// \param mesh_points number of points spread over a mesh; a part of the checksum, as another number is another model.
/// \param tags of all these models.
std::vector<ModelInput> modelInputs(const std::vector<ModelFile>& files, int mesh_points, std::uint64_t seed,
                                    const std::vector<std::string>& tags);

}  // namespace pcl_symmetry::apps
