/// Rows of one item of shared work as bytes.
#pragma once

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/command_line/console.h"
#include "evaluate/runs/resumable_run.h"
#include "evaluate/shared/model_list.h"
#include "recognition/packing/packed_bytes.h"

namespace pcl_symmetry::apps {

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
  std::string left_out;       ///< why it, or a part of it, gives none; empty where it does
  std::string attached = {};  ///< a text that goes along
};

/// Needs put(PackedBytes&, const Row&).
template <typename Row>
std::string packed(const ItemRows<Row>& item) {
  detail::PackedBytes bytes;
  bytes.putText(item.left_out);
  bytes.putText(item.attached);
  for (const Row& row : item.rows) put(bytes, row);
  return bytes.bytes();
}

/// Needs get(UnpackedBytes&, Row&).
/// \throws std::invalid_argument where bytes are missing.
template <typename Row>
ItemRows<Row> unpackedRows(const std::string& packed) {
  detail::UnpackedBytes bytes(packed);
  ItemRows<Row> item;
  item.left_out = bytes.text();
  item.attached = bytes.text();
  while (bytes.left() > 0) {
    item.rows.emplace_back();
    get(bytes, item.rows.back());
  }
  return item;
}

/// Evaluates items, shared by the processes of a run.
/// \param names of the items, none twice in a run.
/// \param evaluate gives the ItemRows<Row> of an item.
/// \param step shows how far it is.
/// \return one for each item, on the first process.
template <typename Row, typename Evaluate>
std::vector<ItemRows<Row>> rowsOfItems(const std::vector<std::string>& names, const Evaluate& evaluate,
                                       ResumableRun& work, Step& step) {
  std::vector<ItemRows<Row>> all(names.size());
  double num_done = 0.0;
  work.run(names, {[&](std::size_t i) { return packed<Row>(evaluate(i)); },
                   [&](std::size_t i, const std::string& bytes) {
                     all[i] = unpackedRows<Row>(bytes);
                     step.progress(++num_done / static_cast<double>(names.size()));
                   },
                   [&](std::size_t i) {
                     return packed(ItemRows<Row>{{}, names[i] + ": the process that did it died"});
                   }});
  return all;
}

/// The same for models: \p evaluate is given a model.
template <typename Row, typename Evaluate>
std::vector<ItemRows<Row>> rowsOfModels(const std::vector<Model>& models, const Evaluate& evaluate, ResumableRun& work,
                                        Step& step) {
  std::vector<std::string> names;
  for (const Model& model : models) names.push_back(model.key);
  return rowsOfItems<Row>(
      names, [&](std::size_t i) { return evaluate(models[i]); }, work, step);
}

/// Puts the rows of all items one behind the other.
/// \param left_out why items give none.
template <typename Row>
std::vector<Row> joinedRows(std::vector<ItemRows<Row>> items, std::vector<std::string>& left_out) {
  std::vector<Row> rows;
  for (ItemRows<Row>& item : items) {
    std::move(item.rows.begin(), item.rows.end(), std::back_inserter(rows));
    if (!item.left_out.empty()) left_out.push_back(std::move(item.left_out));
  }
  return rows;
}

}  // namespace pcl_symmetry::apps
