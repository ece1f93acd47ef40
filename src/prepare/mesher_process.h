// Runs matstruct-mesher and waits for its answer.
#pragma once

#include <matstruct/context.h>

#include "prepare/mesher/protocol.h"

namespace matstruct::mesher {

/// Answers with an error if the process crashes, runs out of memory or takes longer than `seconds`. Throws Error if
/// there is no mesher to run, Cancelled if the context was asked to stop.
Answer run(const Request& request, double seconds, Context& context);

}  // namespace matstruct::mesher
