#include "base/parallel.h"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace matstruct {

void parallel_for(const Context& context, Index n, Index grain, const std::function<void(Index, Index)>& body) {
  context.check();
  const auto run = [&](const tbb::blocked_range<Index>& range) {
    context.check();
    body(range.begin(), range.end());
  };
  // simple_partitioner splits by size alone, so that ranges are the same whatever the number of threads.
  tbb::task_arena arena(context.threads > 0 ? context.threads : tbb::info::default_concurrency());
  arena.execute([&] {
    tbb::parallel_for(tbb::blocked_range<Index>(0, n, static_cast<std::size_t>(grain)), run, tbb::simple_partitioner());
  });
}

}  // namespace matstruct
