/// Parts of arbitrary meshes and clouds: polygons of any corners, neighbors that may not exist.
#include <stdexcept>

#include "fuzz/byte_source.h"
#include "pcl_symmetry/core/surface_segmentation.h"

namespace {

using namespace pcl_symmetry;

SegmentationOptions quickOptions(fuzz::ByteSource& source) {
  SegmentationOptions options;
  options.method = source.flag() ? SegmentationMethod::Merging : SegmentationMethod::Splitting;
  options.evidence = static_cast<MergingEvidence>(source.below(2));
  options.splitting.depth = source.below(4);
  options.num_parts = source.below(6);
  options.num_threads = 1;
  return options;
}

/// \return lists of numbers that are indices of \p size things, but for some.
std::vector<std::vector<int>> takeLists(fuzz::ByteSource& source, int num_lists, int min_length, int size) {
  std::vector<std::vector<int>> lists(static_cast<std::size_t>(num_lists));
  const int length = min_length + source.below(4);
  for (std::vector<int>& list : lists)
    for (int k = 0; k < length; ++k) {
      const int number = source.take<std::uint8_t>();
      list.push_back(number == 255 ? -1 : number % (size + (number == 254 ? 1 : 0)));
    }
  return lists;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzz::ByteSource source(data, size);
  const SegmentationOptions options = quickOptions(source);
  const bool is_mesh = source.flag();
  const int num_lists = 1 + source.below(120);
  fuzz::ByteSource lists(data + (size - source.left()) + source.left() / 2, source.left() - source.left() / 2);
  fuzz::ByteSource coordinates(data + (size - source.left()), source.left() / 2);
  const Points points = fuzz::takePoints(coordinates, 200);
  const int num_points = static_cast<int>(points.cols());
  try {
    if (num_points == 0) return 0;
    const SurfaceGraph graph = is_mesh ? meshGraph(points, takeLists(lists, num_lists, 3, num_points))
                                       : cloudGraph(points, takeLists(lists, num_points, 1, num_points));
    const Segmentation parts = segmentSurface(graph, options);
    FUZZ_CHECK(static_cast<int>(parts.labels.size()) == graph.size());
    for (const int label : parts.labels) FUZZ_CHECK(label >= 0 && label < parts.num_segments);
  } catch (const std::invalid_argument&) {
  }
  return 0;
}
