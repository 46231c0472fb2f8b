/// Descriptors of many shapes, one PCD file for each.
#include <pcl/conversions.h>

#include <algorithm>
#include <boost/filesystem.hpp>
#include <ostream>

#include "command_line/run_on_files.h"
#include "core/matching/shape_signature.h"
#include "core/matching/symmetry_descriptor.h"
#include "io/answers.h"
#include "io/file_text.h"
#include "io/input_shape.h"
#include "io/shape_output.h"
#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "pcl_symmetry/point_types.h"

namespace {

using namespace pcl_symmetry;
using namespace pcl_symmetry::apps;
namespace fs = boost::filesystem;

/// The points spread over a mesh are the same for all seeds: -seed applies only to what is computed from them.
constexpr std::uint64_t kMeshSeed = 1;

struct DescribeOptions {
  std::string output;
  std::vector<std::string> inputs;
  std::string type = "signature";
  bool input_axes = false, by_equation_1 = false;
  int num_points = 20'000;
  std::optional<std::string> csv_path;
  bool resume = false;
  CommonOptions common;
};

CommandLine commandLine(DescribeOptions& options) {
  CommandLine line("pcl_symmetry_describe",
                   "Describes shapes by their symmetry, to tell how alike they are: one PCD file of descriptors each.",
                   "pcl_symmetry_describe descriptors models/*.off");
  line.positional("folder", options.output, "folder of the descriptors; made if it is not there")
      .positionals("inputs", options.inputs, std::string(kManyInputs) + "; of names that differ")
      .choice("type", options.type, {"signature", "prst", "prsd", "gedt"},
              "signatures in two frames, or one of the paper's descriptors")
      .flag("input_axes", options.input_axes,
            "compute the paper's descriptors in the axes of the input, not of its symmetry")
      .flag("equation_1", options.by_equation_1, "prst and prsd as sqrt((1 + D) / 2), not sqrt(D)")
      .number("points", options.num_points, Range::closed(100, 10'000'000), "number of points that describe a shape")
      .text("csv", "FILE", options.csv_path, "table of all descriptors: a row for each, its values behind the name")
      .flag("resume", options.resume, "keep the descriptors of this type that stand in the folder")
      .common(options.common, kSeed | kThreads | kViewpoint | kQuiet);
  return line;
}

template <typename PointT>
pcl::PCLPointCloud2 toBlob(const std::vector<const float*>& values, float (PointT::*field)[PointT::descriptorSize()]) {
  pcl::PointCloud<PointT> cloud;
  for (const float* descriptor : values) {
    cloud.emplace_back();
    std::copy(descriptor, descriptor + PointT::descriptorSize(), cloud.back().*field);
  }
  pcl::PCLPointCloud2 blob;
  pcl::toPCLPointCloud2(cloud, blob);
  return blob;
}

pcl::PCLPointCloud2 describe(const InputShape& input, const DescribeOptions& options) {
  const Cloud& cloud = *input.points;
  const auto max_points = static_cast<std::size_t>(options.num_points);
  const detail::SelectedPoints selected = detail::selectPoints(cloud, nullptr, max_points, options.common.seed);
  if (const std::string reason = detail::reasonForNoAnswer(selected.points); !reason.empty())
    throw InputError(input.path + ": " + reason);
  const SeenSpace seen = detail::findSeenSpace(cloud, selected.points, input.viewpoint(options.common));
  if (options.type == "signature") {
    DescriptionOptions description;
    description.seed = options.common.seed;
    description.num_threads = 1;
    description.max_points = options.num_points;
    const ShapeDescription shape = describeShape(selected.points, description, seen.visibility());
    return toBlob({shape.signatures.col(0).data(), shape.signatures.col(1).data()}, &ShapeSignature20736::signature);
  }
  DescriptorOptions descriptor;
  descriptor.seed = options.common.seed;
  descriptor.num_threads = 1;
  descriptor.by_equation_1 = options.by_equation_1;
  const Eigen::Isometry3d T_frame_input =
      descriptorFrame(selected.points, options.input_axes, seen.visibility(), descriptor);
  const SymmetryDescriptors all = symmetryDescriptors(selected.points, T_frame_input, descriptor);
  if (options.type == "prst") return toBlob({all.prst.data()}, &PRSTSignature32768::prst);
  if (options.type == "prsd") return toBlob({all.prsd.data()}, &PRSDSignature1024::prsd);
  return toBlob({all.gedt.data()}, &GEDTSignature32768::gedt);
}

/// \return the values of a file that this tool wrote; none if it holds no descriptors of the type.
std::vector<float> valuesIn(const std::string& path, const std::string& type) {
  boost::system::error_code error;
  if (!fs::exists(path, error)) return {};
  const std::string text = readWholeFile(path), end_of_header = "\nDATA binary\n";
  const std::size_t header = text.find(end_of_header);
  if (header == std::string::npos || text.find("\nFIELDS " + type + "\n") > header) return {};
  const std::size_t body = header + end_of_header.size();
  std::vector<float> values((text.size() - body) / sizeof(float));
  std::memcpy(values.data(), text.data() + body, values.size() * sizeof(float));
  return values;
}

std::size_t sizeOf(const std::string& type) {
  if (type == "signature") return ShapeSignature20736::descriptorSize();
  if (type == "prsd") return PRSDSignature1024::descriptorSize();
  return type == "prst" ? PRSTSignature32768::descriptorSize() : GEDTSignature32768::descriptorSize();
}

void writeTable(const DescribeOptions& options, const std::vector<std::string>& outputs,
                const std::vector<std::string>& failures) {
  const std::size_t size = sizeOf(options.type);
  writeStream(*options.csv_path, [&](std::ostream& table) {
    table << "file,number";
    for (std::size_t k = 1; k <= size; ++k) table << ',' << options.type << '_' << k;
    table << '\n';
    for (std::size_t i = 0; i < outputs.size(); ++i) {
      if (!failures[i].empty()) continue;
      const std::vector<float> values = valuesIn(outputs[i], options.type);
      for (std::size_t first = 0; first + size <= values.size(); first += size) {
        std::string row = csvLine({options.inputs[i], first / size + 1});
        row.pop_back();
        for (std::size_t k = first; k < first + size; ++k) row += formatted(",%.9g", static_cast<double>(values[k]));
        table << row << '\n';
      }
    }
  });
}

void describeFile(const std::string& input, const std::string& output, const DescribeOptions& options) {
  if (options.resume && !valuesIn(output, options.type).empty()) return;
  const pcl::PCLPointCloud2 blob =
      namingFile(input, [&] { return describe(loadInput(input, options.num_points, kMeshSeed), options); });
  saveCloud(output, blob, Eigen::Vector4f::Zero(), Eigen::Quaternionf::Identity(), PCDEncoding::Binary);
}

int run(int argc, char** argv) {
  DescribeOptions options;
  CommandLine line = commandLine(options);
  if (!line.parse(argc, argv)) return 0;
  line.goWith("-type prst, prsd and gedt", options.type != "signature", {"input_axes"});
  line.goWith("-type prst and prsd", options.type == "prst" || options.type == "prsd", {"equation_1"});
  line.goWith("axes of the symmetry, without -input_axes", !options.input_axes, {"viewpoint"});
  const Console console(options.common.quiet);
  const std::vector<InputFile> files = inputFiles(options.inputs);
  checkNames(files);
  makeFolder(options.output);
  options.inputs.clear();
  std::vector<std::string> outputs;
  for (const InputFile& file : files) {
    options.inputs.push_back(file.path);
    outputs.push_back((fs::path(options.output) / (fs::path(file.path).stem().string() + ".pcd")).string());
  }
  Step step(console, "Describing " + counted(options.inputs.size(), "shape"));
  std::vector<std::string> failures =
      workOnAll(options.inputs.size(), options.common.threads, step,
                [&](std::size_t i) { describeFile(options.inputs[i], outputs[i], options); });
  if (options.csv_path) writeTable(options, outputs, failures);
  failures.erase(std::remove(failures.begin(), failures.end(), ""), failures.end());
  step.done(counted(options.inputs.size() - failures.size(), "descriptor"));
  for (const std::string& failure : failures) console.error(failure);
  return failures.empty() ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  return runTool(argc, argv, run);
}
