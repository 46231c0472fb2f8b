#include "database_variants.h"

#include <Eigen/Geometry>
#include <cmath>
#include <complex>
#include <map>
#include <mutex>
#include <optional>

#include "core/base/constants.h"
#include "core/base/parallel.h"
#include "core/matching/shape_description.h"
#include "recognition/database_parts.h"
#include "recognition/packed_model.h"

namespace pcl_symmetry::benchmark {

namespace {

constexpr double kNoise = 0.0025;          // diagonals; chosen: that of a good scanner, see trueVariant()
constexpr std::size_t kVariantPoints = 4;  // every fourth point. chosen: recognition uses 5000 of 20 000
constexpr std::size_t kClouds = 16;        // of the variants of a model. chosen: packing one takes as long as all else
constexpr std::size_t kChunk = 128;        // variants that are made before they are stored. chosen: 5 MB

double normal(RandomStream& random) {
  return std::sqrt(-2.0 * std::log(1.0 - random.uniform())) * std::cos(2.0 * kPi * random.uniform());
}

Points everyNth(const Points& points, std::size_t step, double noise, RandomStream& random) {
  const auto stride = static_cast<Eigen::Index>(step);
  const Eigen::Index offset = static_cast<Eigen::Index>(random.below(step));
  const double sigma = noise * (points.rowwise().maxCoeff() - points.rowwise().minCoeff()).cast<double>().norm();
  Points kept(3, (points.cols() - offset + stride - 1) / stride);
  for (Eigen::Index i = 0; i < kept.cols(); ++i)
    for (Eigen::Index k = 0; k < 3; ++k)
      kept(k, i) = points(k, offset + i * stride) + static_cast<float>(sigma * normal(random));
  return kept;
}

/// View::values of the picture turned by \p angle: harmonic m times exp(-i m angle).
Eigen::VectorXf turned(const Eigen::VectorXf& values, double angle) {
  constexpr int kRow = 2 * kViewRings;
  Eigen::VectorXf result = values;
  for (int m = 1; m <= kViewHarmonics; ++m) {
    const auto factor = std::polar(1.0, -m * angle);
    for (int i = 0; i < kRow; ++i) {
      const int re = kRow * (2 * m - 1) + i, im = kRow * 2 * m + i;
      const auto value = factor * std::complex<double>(values[re], values[im]);
      result[re] = static_cast<float>(value.real());
      result[im] = static_cast<float>(value.imag());
    }
  }
  return result;
}

/// The difference of a view from the nearest one of its model.
Eigen::VectorXf differenceOf(const View& view, const std::vector<View>& model) {
  const ViewComparison comparison(view);
  Eigen::VectorXf least;
  for (const View& other : model) {
    const double turn = comparison.compare(other.values.data(), 2.0f).turn;
    for (const double angle : {turn, -turn})
      if (const Eigen::VectorXf difference = turned(view.values, angle) - other.values;
          least.size() == 0 || difference.norm() < least.norm())
        least = difference;
  }
  return least;
}

template <typename Value>
const Value& drawn(const std::vector<Value>& values, RandomStream& random) {
  return values[random.below(values.size())];
}

}  // namespace

/// A rotation and a factor.
struct VariantSource::Similarity {
  explicit Similarity(RandomStream& random)
      : rotation(Eigen::Quaterniond(normal(random), normal(random), normal(random), normal(random)).normalized()),
        scale(std::exp2(2.0 * random.uniform() - 1.0)) {}

  Points of(const Points& points) const { return static_cast<float>(scale) * (rotation.cast<float>() * points); }

  Eigen::Matrix3d rotation;
  double scale;
};

struct VariantSource::MovedCloud {
  Similarity motion;
  std::string packed;
  std::size_t num_points;
};

struct VariantSource::MadeVariant {
  ModelInfo info;
  detail::PackedModel packed;
  detail::PackedForms forms;
};

VariantSource::MovedCloud VariantSource::movedCloud(const Points& cloud, std::size_t model, std::size_t number) {
  RandomStream random(11 + model, number);
  const Similarity motion(random);
  const Points points = motion.of(everyNth(cloud, kVariantPoints, kNoise, random));
  detail::PositionCloud moved(static_cast<std::uint32_t>(points.cols()), 1);
  moved.getMatrixXfMap(3, 4, 0) = points;
  return {motion, detail::packedCloud(moved), moved.size()};
}

Points VariantSource::trueVariant(const Points& points, RandomStream& random) {
  const Similarity motion(random);
  return motion.of(everyNth(points, 2, kNoise, random));
}

VariantSource::VariantSource(const std::string& file)
    : store_(file, 10.0, ""), fitted_(detail::FittedForms::unpacked(store_.projection().value())) {
  store_.eachForms(fitted_.id, [&](std::int64_t id, const std::string& bytes) {
    stored_.emplace(id, detail::CompactForm::unpacked(bytes));
  });
}

Points VariantSource::points(const detail::StoredModel& model) {
  const detail::PositionCloud cloud = detail::unpackedCloud(store_.part(detail::ModelPart::Cloud, model));
  return cloud.getMatrixXfMap(3, 4, 0);
}

VariantSource::Described VariantSource::stored(const detail::StoredModel& model) {
  return {detail::unpackedViews(store_.part(detail::ModelPart::Views, model)), stored_.at(model.id)};
}

Variation VariantSource::measure(int count) {
  const auto& all = store_.models();
  const auto size = static_cast<std::size_t>(count);
  std::vector<Variation> parts(size);
  std::mutex mutex;
  parallelBlocks(size, 0, [&](std::size_t i) {
    const detail::StoredModel& model = all[i * all.size() / size];
    RandomStream random(7, i);
    std::unique_lock<std::mutex> lock(mutex);
    const Points variant = trueVariant(points(model), random);
    const Described own = stored(model);
    lock.unlock();
    const std::vector<View> views = viewsAround(variant, static_cast<int>(own.views.size()), 1);
    for (const View& view : views) parts[i].views.push_back(differenceOf(view, own.views));
    DescriptionOptions description;
    description.num_threads = 1;
    const detail::CompactForm form = fitted_.forms->formOf(describeShape(variant, description).signatures, 0);
    const Eigen::MatrixXf rotations = fitted_.forms->rotations(form);
    Eigen::Index rotation = 0, column = 0;
    (rotations.transpose() * own.form.compact).maxCoeff(&rotation, &column);
    parts[i].forms.push_back(rotations.col(rotation) - own.form.compact.col(column));
  });
  Variation all_parts;
  for (Variation& part : parts) {
    all_parts.views.insert(all_parts.views.end(), part.views.begin(), part.views.end());
    all_parts.forms.insert(all_parts.forms.end(), part.forms.begin(), part.forms.end());
  }
  return all_parts;
}

/// Variants \p first and the following ones of a model.
std::vector<VariantSource::MadeVariant> VariantSource::made(const detail::StoredModel& model, std::size_t first,
                                                            std::size_t count, const std::vector<MovedCloud>& clouds,
                                                            const Variation& variation) {
  const Described own = stored(model);
  const std::string signatures = store_.part(detail::ModelPart::Signatures, model);
  std::vector<MadeVariant> variants(count);
  parallelBlocks(count, 0, [&](std::size_t i) {
    RandomStream random(static_cast<std::uint64_t>(model.id), first + i);
    const MovedCloud& cloud = clouds[(first + i) % clouds.size()];
    std::vector<View> views = own.views;
    for (View& view : views) {
      view.values += drawn(variation.views, random);
      view.values.normalize();
      view.radius *= cloud.motion.scale;
      view.T_view_input.linear() *= cloud.motion.rotation.transpose();
      view.T_view_input.translation() *= cloud.motion.scale;
    }
    detail::CompactForm form = own.form;
    for (Eigen::Index k = 0; k < form.compact.cols(); ++k)
      form.compact.col(k) = (form.compact.col(k) + drawn(variation.forms, random)).normalized();
    variants[i].info = {model.name + "~" + std::to_string(first + i), 0, {}, cloud.num_points};
    variants[i].packed = {cloud.packed, signatures, detail::packedViews(views), cloud.num_points};
    variants[i].forms = {0, form.packed(), fitted_.coder->codesOf(views)};
  });
  return variants;
}

void VariantSource::fill(const std::string& file, int count, const Variation& variation) {
  detail::ModelStore target(file, 10.0, "");
  detail::PackedProjection projection = fitted_.packed();
  projection.id = 0;
  target.setProjection(projection, {});
  const std::int64_t id = target.projectionId();
  const auto& all = store_.models();
  for (std::size_t m = 0; m < all.size() && m < static_cast<std::size_t>(count); ++m) {
    const detail::StoredModel& model = all[m];
    const Described own = stored(model);
    const Points cloud = points(model);
    const detail::PackedModel whole{
        store_.part(detail::ModelPart::Cloud, model), store_.part(detail::ModelPart::Signatures, model),
        store_.part(detail::ModelPart::Views, model), static_cast<std::size_t>(cloud.cols())};
    target.add({model.name, 0, {}, whole.num_points}, whole, id,
               {0, own.form.packed(), fitted_.coder->codesOf(own.views)});
    const std::size_t num_variants = (static_cast<std::size_t>(count) - m - 1) / all.size();
    std::vector<MovedCloud> clouds;
    for (std::size_t i = 0; i < std::min(num_variants, kClouds); ++i) clouds.push_back(movedCloud(cloud, m, i));
    for (std::size_t first = 0; first < num_variants; first += kChunk)
      for (MadeVariant& variant : made(model, first, std::min(kChunk, num_variants - first), clouds, variation))
        target.add(variant.info, variant.packed, id, std::move(variant.forms));
  }
  // Tables lie one behind the other, as after a build, which makes forms at its end.
  detail::SQLiteConnection(file, detail::SQLiteAccess::Change, 10.0).run("VACUUM");
}

}  // namespace pcl_symmetry::benchmark
