// What a computation shares with its caller: threads, progress, cancellation, warnings. No global state.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <matstruct/types.h>

namespace matstruct {

namespace mesher {
class Process;
}

/// Told about a stage's progress; `fraction` of the stage, in [0, 1]. Called from the thread that runs the computation.
/// Returning false cancels.
using Progress = std::function<bool(const std::string& stage, double fraction)>;

/// Passed down by reference through the stages of one computation. Not to be shared by two that run at once.
struct Context {
  int threads = 0;                          ///< worker threads, 0 = all cores; never changes a result
  Progress progress;                        ///< may be empty
  const std::atomic<bool>* stop = nullptr;  ///< may be null; set to true from anywhere to cancel
  std::vector<std::string> warnings;        ///< sentences for the report; added to, never cleared
  std::shared_ptr<mesher::Process> mesher;  ///< set and used by the library; ends with the context

  /// Reports progress; throws Cancelled if asked to stop.
  void report(const std::string& stage, double fraction);
  /// Throws Cancelled if asked to stop.
  void check() const;
};

}  // namespace matstruct
