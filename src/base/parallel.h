// Loops over independent elements on the context's threads. Results do not depend on the number of threads as long as
// an element writes only its own output.
#pragma once

#include <functional>

#include <matstruct/context.h>

namespace matstruct {

/// Calls body(begin, end) on disjoint ranges that cover [0, n), each at most `grain` >= 1 long, in parallel; the ranges
/// are the same for any number of threads. Exceptions of the body come out of the call. Throws Cancelled when the
/// context was asked to stop.
void parallel_for(const Context& context, Index n, Index grain, const std::function<void(Index, Index)>& body);

}  // namespace matstruct
