/// Work that the processes of an MPI run share.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <string>

namespace pcl_symmetry::apps {

/// The processes that mpirun or srun started together, or this one alone. Make one in main(), before all else.
///
/// Each process takes the next item when it has done its last one, so that none waits for another. If a process dies,
/// MPI ends the others; what the first process took before is not lost.
class SharedWork {
public:
  /// Does item i. Called on any process; errors that belong to the item are a part of the result.
  using Work = std::function<std::string(std::size_t i)>;
  /// Takes the result of item i, on the first process, one call at a time, in any order.
  using Take = std::function<void(std::size_t i, const std::string& result)>;

  SharedWork();
  ~SharedWork();
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  bool isShared() const { return size_ > 1; }
  bool isFirst() const { return rank_ == 0; }

  /// Gives all processes the text of the first one.
  void broadcast(std::string& text);
  /// Does all items; called by all processes with the same count.
  /// \throws what \p work throws on this process, and what \p take throws on the first one.
  void run(std::size_t count, const Work& work, const Take& take);
  /// Ends the other processes where this one failed before run() ended.
  /// \param code exit code of this process.
  /// \return the same.
  int end(int code);

private:
  struct Processes;
  void answer(std::size_t count, const Take& take);
  void ask(const Work& work);

  std::unique_ptr<Processes> processes_;
  int rank_ = 0, size_ = 1;
  bool ran_ = false;
};

}  // namespace pcl_symmetry::apps
