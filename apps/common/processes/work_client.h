/// The other processes of a run: each asks the first one for items and sends what it has done.
#pragma once

#include <cstdint>
#include <string>

#include "common/processes/message_channel.h"
#include "common/processes/work_functions.h"

namespace pcl_symmetry::apps {

class WorkClient {
public:
  explicit WorkClient(MessageChannel& channel) : channel_(channel) {}

  /// \return the next text that the first process makes known.
  std::string hear();

  /// Does items until all of the run are done.
  void run(const WorkFunctions& functions);

  /// Says that nothing more is needed.
  void leave();

private:
  /// \throws std::runtime_error where the first process does not answer.
  Message ask(Message question);
  std::string workOn(std::size_t item, const WorkFunctions& functions);

  MessageChannel& channel_;
  std::int64_t num_texts_ = 0, run_ = 0;
};

}  // namespace pcl_symmetry::apps
