/// Rows of one item of shared work as bytes.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/command_line/console.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shared/model_list.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

inline std::string textOf(detail::UnpackedBytes& bytes) {
  const auto size = bytes.get<std::uint32_t>();
  return {bytes.take(size), size};
}

template <typename Value>
void putOptional(detail::PackedBytes& bytes, const std::optional<Value>& value) {
  bytes.put(value.has_value());
  if (value) bytes.put(*value);
}

template <typename Value>
void getOptional(detail::UnpackedBytes& bytes, std::optional<Value>& value) {
  if (bytes.get<bool>()) value = bytes.get<Value>();
}

/// What one item of an evaluation gives.
template <typename Row>
struct ItemRows {
  std::vector<Row> rows;
  std::string left_out;  ///< why it gives none; empty where it does
};

/// Needs put(PackedBytes&, const Row&).
template <typename Row>
std::string packed(const ItemRows<Row>& item) {
  detail::PackedBytes bytes;
  bytes.putText(item.left_out);
  for (const Row& row : item.rows) put(bytes, row);
  return bytes.bytes();
}

/// Needs get(UnpackedBytes&, Row&).
/// \throws std::invalid_argument where bytes are missing.
template <typename Row>
ItemRows<Row> unpackedRows(const std::string& packed) {
  detail::UnpackedBytes bytes(packed);
  ItemRows<Row> item;
  item.left_out = textOf(bytes);
  while (bytes.left() > 0) {
    item.rows.emplace_back();
    get(bytes, item.rows.back());
  }
  return item;
}

/// Evaluates models, shared by the processes of a run.
/// \param evaluate gives the ItemRows<Row> of a model.
/// \param step shows how far it is.
/// \return one for each model, on the first process.
template <typename Row, typename Evaluate>
std::vector<ItemRows<Row>> rowsOfModels(const std::vector<Model>& models, const Evaluate& evaluate, ResumableRun& work,
                                        Step& step) {
  std::vector<std::string> names;
  for (const Model& model : models) names.push_back(model.key);
  std::vector<ItemRows<Row>> all(models.size());
  double num_done = 0.0;
  work.run(names, {[&](std::size_t i) { return packed<Row>(evaluate(models[i])); },
                   [&](std::size_t i, const std::string& bytes) {
                     all[i] = unpackedRows<Row>(bytes);
                     step.progress(++num_done / static_cast<double>(models.size()));
                   },
                   [&](std::size_t i) {
                     return packed(ItemRows<Row>{{}, models[i].path + ": the process that did it died"});
                   }});
  return all;
}

}  // namespace pcl_symmetry::apps
