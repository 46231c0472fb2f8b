/// A small database of which single bytes are changed.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/random.h"
#include "recognition/model_store.h"

namespace pcl_symmetry::test {

class DamagedDatabase {
public:
  explicit DamagedDatabase(std::string file) : file_(std::move(file)) {
    {
      detail::ModelStore store(file_, 1.0, "m");
      for (const char* name : {"cube", "beam", "a longer name", "gone"}) store.add(infoOf(name), modelOf(name), 0, {});
      store.setProjection({0, 3, partOf("projection"), partOf("coder")},
                          {{1, partOf("form"), partOf("codes")}, {2, partOf("form"), partOf("codes")}});
      store.remove("gone");
    }
    std::ifstream stream(file_, std::ios::binary);
    whole_ = {std::istreambuf_iterator<char>(stream), {}};
  }

  std::size_t size() const { return whole_.size(); }
  int numFound() const { return num_found_; }

  /// Changes the bits of the mask in one byte of the whole database.
  /// \return what is wrong with what the library makes of it; empty: the damage is found, or is none.
  std::string flip(std::size_t place, char mask) {
    std::string damaged = whole_;
    damaged[place] = static_cast<char>(damaged[place] ^ mask);
    std::ofstream(file_, std::ios::binary) << damaged;
    bool found = false;
    try {
      found = !SymmetryDatabase::check(file_).empty();
    } catch (const pcl::IOException&) {
      found = true;
    }
    num_found_ += found ? 1 : 0;
    const std::string wrong = read(found);
    for (const char* ending : {"-wal", "-shm"}) std::filesystem::remove(file_ + ending);
    return wrong;
  }

private:
  static ModelInfo infoOf(const std::string& name) { return {name, 7, {"source of " + name, "", {}}, 1}; }
  static std::string partOf(const std::string& name) { return "part of " + name + std::string(5000, 'x'); }
  static detail::PackedModel modelOf(const std::string& name) { return {partOf(name), partOf(name), partOf(name), 1}; }

  /// \return what was read that was never written.
  std::string read(bool found) const {
    try {
      detail::ModelStore store(file_, 1.0, "");
      std::vector<std::string> names;
      for (const auto& model : store.models()) {
        names.push_back(model.name);
        for (const auto part : {detail::ModelPart::Cloud, detail::ModelPart::Signatures, detail::ModelPart::Views})
          if (store.part(part, model) != partOf(model.name)) return "another part of " + model.name;
        const auto info = store.find(model.name);
        if (info && info->second.source.path != "source of " + model.name) return "another source of " + model.name;
      }
      if (store.projection() && store.projection()->values != partOf("projection")) return "another projection";
      store.eachForms(1, [](std::int64_t, const std::string& bytes) {
        if (bytes != partOf("form")) throw std::runtime_error("another compact form");
      });
      store.eachViewCodes(1, [](std::int64_t, const std::string& bytes) {
        if (bytes != partOf("codes")) throw std::runtime_error("other codes of views");
      });
      for (const std::string& name : names)
        if (name != "cube" && name != "beam" && name != "a longer name") return "a model " + name;
      if (!found && names.size() != 3) return "a model is lost without a word";
    } catch (const pcl::IOException& error) {
      return found ? "" : std::string("found only when it is read: ") + error.what();
    } catch (const std::exception& error) {
      return error.what();
    }
    return "";
  }

  std::string file_, whole_;
  int num_found_ = 0;
};

}  // namespace pcl_symmetry::test
