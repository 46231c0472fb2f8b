/// What is done with the items of shared work.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

namespace pcl_symmetry::apps {

struct WorkFunctions {
  /// Does item i, on any process; errors that belong to the item are a part of the result.
  std::function<std::string(std::size_t i)> work;
  /// Takes the result of item i, on the first process, one call at a time, in any order.
  std::function<void(std::size_t i, const std::string& result)> take;
  /// \return what is taken for an item whose process died, and that of a second attempt too.
  std::function<std::string(std::size_t i)> lost;
};

}  // namespace pcl_symmetry::apps
