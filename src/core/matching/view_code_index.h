#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "core/matching/view_code.h"

namespace pcl_symmetry {

/// Finds shapes that a scan can show by the codes of their views: those that are compared in full, see ViewIndex.
///
/// All codes are compared. Eight million, those of 100 000 shapes, take 208 MB and milliseconds per query.
class ViewCodeIndex {
public:
  void reserve(std::size_t num_shapes, std::size_t num_views);
  /// \param codes of a shape, see packedViewCodes().
  /// \throws std::invalid_argument for another number of bytes.
  void add(const std::string& codes);

  std::size_t numShapes() const { return begins_.size() - 1; }
  std::size_t numViews() const { return begins_.back(); }

  /// \param size_weight see ViewSearchOptions.
  /// \param count >= 0.
  /// \return the numbers of the nearest shapes, rising, at most \p count. Shapes without views are never found.
  std::vector<int> nearest(const ViewCode& scan, double size_weight, int count, int num_threads) const;

private:
  std::vector<std::int8_t> codes_;         // of all shapes, one behind the other
  std::vector<std::size_t> begins_ = {0};  // of the shapes, and the end, in views
};

}  // namespace pcl_symmetry
