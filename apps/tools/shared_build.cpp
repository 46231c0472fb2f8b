#include "tools/shared_build.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <utility>

#include "pcl_symmetry/impl/cloud_conversion.hpp"
#include "recognition/database_parts.h"
#include "recognition/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

enum class Outcome : char { Stored = 's', Kept = 'k', Failed = 'f' };

/// A model on its way to the first process.
std::string bytesOf(const ModelInfo& info, const detail::PackedModel& model) {
  detail::PackedBytes bytes;
  bytes.put(static_cast<char>(Outcome::Stored));
  bytes.put(static_cast<std::uint64_t>(model.num_points));
  bytes.put(static_cast<std::uint32_t>(info.source.tags.size()));
  for (const std::string& tag : info.source.tags) bytes.putText(tag);
  for (const std::string& text : {info.source.path, info.source.checksum, model.cloud, model.signatures, model.views})
    bytes.putText(text);
  return bytes.bytes();
}

std::string failed(const std::string& reason) {
  return static_cast<char>(Outcome::Failed) + reason;
}

class SharedBuild {
public:
  SharedBuild(SharedWork& processes, const std::string& file, const DatabaseOptions& options,
              const std::vector<ModelInput>& inputs, StoreOrder order, const BuildProgress& progress)
      : processes_(processes), options_(options), inputs_(inputs), order_(order), progress_(progress) {
    if (processes_.isFirst()) parts_.emplace(file, options);
  }

  BuildReport run() {
    shareChecksums();
    std::set<std::string> names;
    for (std::size_t i = 0; i < inputs_.size(); ++i)
      if (!names.insert(inputs_[i].name).second) repeated_.insert(i);
    processes_.run(inputs_.size(), {[this](std::size_t i) { return described(i); },
                                    [this](std::size_t i, const std::string& bytes) { takeInOrder(i, bytes); },
                                    [](std::size_t) { return failed("the processes that described it died"); }});
    for (const auto& [i, reason] : failures_) report_.failures.emplace_back(inputs_[i].name, reason);
    if (parts_) detail::withBadArguments([&] { parts_->save(); });
    return report_;
  }

private:
  /// All processes know what is stored.
  void shareChecksums() {
    detail::PackedBytes bytes;
    if (parts_) {
      for (const ModelInput& input : inputs_) {
        const auto found = parts_->store.find(input.name);
        bytes.putText(found ? found->second.source.checksum : "");
      }
    }
    std::string text = bytes.bytes();
    processes_.broadcast(text);
    detail::UnpackedBytes checksums(text);
    for (std::size_t i = 0; i < inputs_.size(); ++i) stored_.push_back(checksums.text());
  }

  std::string described(std::size_t i) const {
    const ModelInput& input = inputs_[i];
    try {
      if (repeated_.count(i) > 0)
        throw std::invalid_argument("name = '" + input.name + "' is that of an earlier model, names must differ");
      detail::checkModelName(input.name);
      ModelInfo info{input.name, 0, input.source ? input.source() : ModelSource(), 0};
      if (!stored_[i].empty() && stored_[i] == info.source.checksum) return {static_cast<char>(Outcome::Kept)};
      const Points points = detail::finitePoints(input.load(), options_.max_points);
      return bytesOf(info, detail::describedModel(points, options_).packed);
    } catch (const std::exception& error) {
      return failed(error.what());
    }
  }

  void takeInOrder(std::size_t i, const std::string& bytes) {
    if (order_ == StoreOrder::AsDescribed) return take(i, bytes);
    waiting_[i] = bytes;
    for (auto next = waiting_.find(next_); next != waiting_.end(); next = waiting_.find(++next_)) {
      take(next_, next->second);
      waiting_.erase(next);
    }
  }

  /// On the first process.
  void take(std::size_t i, const std::string& bytes) {
    detail::UnpackedBytes packed(bytes);
    const auto outcome = static_cast<Outcome>(packed.get<char>());
    if (outcome == Outcome::Failed) {
      failures_[i] = bytes.substr(1);
    } else if (outcome == Outcome::Kept) {
      ++report_.num_kept;
    } else {
      ModelInfo info{inputs_[i].name, detail::currentTime(), {}, 0};
      detail::PackedModel model;
      model.num_points = info.num_points = packed.get<std::uint64_t>();
      info.source.tags.resize(packed.get<std::uint32_t>());
      for (std::string& tag : info.source.tags) tag = packed.text();
      for (std::string* text :
           {&info.source.path, &info.source.checksum, &model.cloud, &model.signatures, &model.views})
        *text = packed.text();
      parts_->add(info, model, detail::unpackedSignatures(model.signatures));
      ++report_.num_added;
    }
    if (progress_) progress_(static_cast<double>(++num_done_) / static_cast<double>(inputs_.size()));
  }

  SharedWork& processes_;
  const DatabaseOptions& options_;
  const std::vector<ModelInput>& inputs_;
  const StoreOrder order_;
  const BuildProgress& progress_;
  std::optional<detail::DatabaseParts> parts_;  // of the first process
  std::map<std::size_t, std::string> waiting_;  // described, while an input before them is not
  std::size_t next_ = 0;                        // that is stored in order
  std::vector<std::string> stored_;             // checksums of the inputs' sources in the database
  std::set<std::size_t> repeated_;
  std::map<std::size_t, std::string> failures_;
  BuildReport report_;
  std::size_t num_done_ = 0;
};

}  // namespace

BuildReport buildShared(SharedWork& processes, const std::string& file, const DatabaseOptions& options,
                        const std::vector<ModelInput>& inputs, StoreOrder order, const BuildProgress& progress) {
  return SharedBuild(processes, file, options, inputs, order, progress).run();
}

}  // namespace pcl_symmetry::apps
