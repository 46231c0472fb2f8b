/// Work that the processes of an MPI run share.
#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "common/processes/work_functions.h"

namespace pcl_symmetry::apps {

/// The processes that mpirun or srun started together, or this one alone. Make one in main(), before all else.
///
/// Each process takes the next item when it has done its last one, so that none waits for another. If another process
/// than the first dies and MPI lets the others live (mpirun --enable-recovery, srun --no-kill), its item is given to
/// another one; else MPI ends all. What the first process took before is not lost either way.
class SharedWork {
public:
  SharedWork();
  ~SharedWork();
  SharedWork(const SharedWork&) = delete;
  SharedWork& operator=(const SharedWork&) = delete;

  bool isShared() const { return size_ > 1; }
  bool isFirst() const { return rank_ == 0; }

  /// Gives all processes the text of the first one.
  void broadcast(std::string& text);
  /// Does all items; called by all processes with the same count. Where no other process shares them, \p num_threads
  /// threads do.
  /// \param num_threads 0 = one per core.
  /// \throws what the work throws on this process, and what taking throws on the first one.
  void run(std::size_t count, const WorkFunctions& functions, int num_threads = 1);
  /// Call it at the end of main(): waits for the other processes, and ends them where this one failed before run()
  /// ended or where one has died, as MPI would wait for that one.
  /// \param code exit code of this process.
  /// \return the same.
  int end(int code);

private:
  struct Processes;

  std::unique_ptr<Processes> processes_;
  int rank_ = 0, size_ = 1;
  bool ran_ = false;
};

}  // namespace pcl_symmetry::apps
