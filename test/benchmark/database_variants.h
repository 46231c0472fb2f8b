/// Databases of many models: variants of those of a small one.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "pcl_symmetry/core/point_set.h"
#include "pcl_symmetry/symmetry_database.h"
#include "recognition/fitted_forms.h"

namespace pcl_symmetry::benchmark {

/// How descriptions of true variants differ from those of their models.
struct Variation {
  std::vector<Eigen::VectorXf> views;  ///< differences of View::values from the nearest view of the model, turned to it
  std::vector<Eigen::VectorXf> forms;  ///< differences of compact forms from the nearest of the model, turned to it
};

/// A small database, whose models have been described.
class VariantSource {
public:
  /// \throws pcl::IOException.
  explicit VariantSource(const std::string& file);

  /// A true variant of a cloud: every second point, moved along each axis by 0.25 % of the diagonal (standard
  /// deviation), turned, and scaled by a factor between 0.5 and 2.
  static Points trueVariant(const Points& points, RandomStream& random);

  const std::vector<detail::StoredModel>& models() { return store_.models(); }
  const detail::CompactForms& forms() const { return *fitted_.forms; }
  Points points(const detail::StoredModel& model);
  /// Describes \p count true variants.
  Variation measure(int count);
  /// Makes a database of \p count models: the models themselves first, then variants with names MODEL~NUMBER. Their
  /// clouds are 16 true variants of a quarter of the points; their views and compact forms are those of the model and a
  /// difference that was measured, drawn at random.
  void fill(const std::string& file, int count, const Variation& variation);

private:
  struct Described {
    std::vector<View> views;
    detail::CompactForm form;
  };
  struct Similarity;
  struct MovedCloud;
  struct MadeVariant;
  Described stored(const detail::StoredModel& model);
  static MovedCloud movedCloud(const Points& cloud, std::size_t model, std::size_t number);
  std::vector<MadeVariant> made(const detail::StoredModel& model, std::size_t first, std::size_t count,
                                const std::vector<MovedCloud>& clouds, const Variation& variation);

  detail::ModelStore store_;
  detail::FittedForms fitted_;
  std::map<std::int64_t, detail::CompactForm> stored_;
};

}  // namespace pcl_symmetry::benchmark
