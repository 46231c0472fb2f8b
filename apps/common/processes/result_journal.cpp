#include "common/processes/result_journal.h"

#include <boost/filesystem.hpp>
#include <cstdint>
#include <utility>

#include "command_line/tool_errors.h"
#include "recognition/packed_bytes.h"

namespace pcl_symmetry::apps {

namespace {

constexpr char kTitle[] = "pcl_symmetry journal 1\n";  // chosen: the number is that of the layout

std::string recordOf(const std::string& name, const std::string& result) {
  detail::PackedBytes record;
  record.putText(name);
  record.putText(result);
  detail::PackedBytes whole;
  whole.put(detail::Checksum().add(record.bytes()).value());
  whole.append(record.bytes());
  return whole.bytes();
}

}  // namespace

ResultJournal::ResultJournal(std::string path, const std::string& purpose) : path_(std::move(path)) {
  boost::system::error_code error;
  const bool is_new = !boost::filesystem::exists(path_, error) || boost::filesystem::file_size(path_, error) == 0;
  if (!is_new) read(purpose);
  file_.open(path_, std::ios::binary | (is_new ? std::ios::trunc : std::ios::app));
  if (is_new) file_ << kTitle << recordOf("purpose", purpose) << std::flush;
  if (!file_) throw InputError(path_ + ": cannot be written");
}

void ResultJournal::read(const std::string& purpose) {
  std::string text;
  {
    std::ifstream file(path_, std::ios::binary);
    text.assign(std::istreambuf_iterator<char>(file), {});
    if (!file) throw InputError(path_ + ": cannot be read");
  }
  const std::string title = kTitle;
  if (text.compare(0, title.size(), title) != 0) throw InputError(path_ + ": is not a journal of this tool");
  text.erase(0, title.size());
  detail::UnpackedBytes bytes(text);
  std::size_t num_whole = 0, num_records = 0;
  try {
    while (bytes.left() > 0) {
      const auto checksum = bytes.get<std::int64_t>();
      std::string name = bytes.text(), result = bytes.text();
      if (recordOf(name, result)
              .compare(0, sizeof(checksum), reinterpret_cast<const char*>(&checksum), sizeof(checksum)) != 0)
        break;
      if (num_records++ > 0)
        results_[name] = std::move(result);
      else if (result != purpose)
        throw InputError(path_ + ": is of a run with other flags or models, must be of the same");
      num_whole = text.size() - bytes.left();
    }
  } catch (const std::invalid_argument&) {  // the last record is cut off
  }
  if (num_records == 0) throw InputError(path_ + ": is not a journal of this tool");
  boost::system::error_code error;
  boost::filesystem::resize_file(path_, title.size() + num_whole, error);
  if (error) throw InputError(path_ + ": " + error.message());
}

void ResultJournal::add(const std::string& name, const std::string& result) {
  file_ << recordOf(name, result) << std::flush;
  if (!file_) throw InputError(path_ + ": cannot be written");
}

void runWithJournal(SharedWork& processes, ResultJournal* journal, const std::vector<std::string>& names,
                    const WorkFunctions& functions, int num_threads) {
  std::string is_done(names.size(), '0');
  if (journal)
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto found = journal->results().find(names[i]);
      if (found == journal->results().end()) continue;
      functions.take(i, found->second);
      is_done[i] = '1';
    }
  processes.broadcast(is_done);
  std::vector<std::size_t> left;
  for (std::size_t i = 0; i < names.size(); ++i)
    if (is_done[i] == '0') left.push_back(i);
  processes.run(left.size(),
                {[&](std::size_t k) { return functions.work(left[k]); },
                 [&](std::size_t k, const std::string& result) {
                   if (journal) journal->add(names[left[k]], result);
                   functions.take(left[k], result);
                 },
                 [&](std::size_t k) { return functions.lost(left[k]); }},
                num_threads);
}

}  // namespace pcl_symmetry::apps
