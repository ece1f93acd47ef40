// Time and memory of the stages of a computation.
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include <matstruct/compute.h>

namespace matstruct {

/// Peak resident memory of this process, MiB.
double peak_memory_mib();

class StageClock {
 public:
  explicit StageClock(Context& context) : context_(context), begin_(now()), start_(begin_) {}

  /// Announces a stage; the one before ends here.
  void begin(const std::string& name) {
    end();
    name_ = name;
    context_.report(name, 0);
  }
  /// Ends the present stage, if any.
  void end() {
    if (!name_.empty()) stages_.push_back({name_, seconds_since(start_), peak_memory_mib()});
    name_.clear();
    start_ = now();
  }
  /// Seconds since construction.
  double total() const { return seconds_since(begin_); }
  const std::vector<StageCost>& stages() const { return stages_; }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static Time now() { return std::chrono::steady_clock::now(); }
  static double seconds_since(Time t) { return std::chrono::duration<double>(now() - t).count(); }

  Context& context_;
  Time begin_, start_;
  std::string name_;
  std::vector<StageCost> stages_;
};

}  // namespace matstruct
