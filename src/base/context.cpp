#include <matstruct/context.h>
#include <matstruct/error.h>

namespace matstruct {

void Context::report(const std::string& stage, double fraction) {
  check();
  if (progress && !progress(stage, fraction)) throw Cancelled();
}

void Context::check() const {
  if (stop && stop->load(std::memory_order_relaxed)) throw Cancelled();
}

}  // namespace matstruct
