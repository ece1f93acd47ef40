// Asks matstruct-mesher and waits for its answer.
#pragma once

#include <matstruct/context.h>

#include "prepare/mesher/protocol.h"

namespace matstruct::mesher {

/// The mesher is started when it is first needed and stays with the context: most of the time of a small task would be
/// loading its libraries. Every task is done by a copy (fork) of it, so that a crash does not matter to the next one.
/// Answers with an error if the process crashes, runs out of memory or takes longer than `seconds`. Throws Error if
/// there is no mesher to run, Cancelled if the context was asked to stop.
Answer run(const Request& request, double seconds, Context& context);

/// Starts the mesher ahead of its first task: it loads its libraries while the caller goes on. Does nothing where it
/// cannot be started: run() says why.
void start(Context& context);

}  // namespace matstruct::mesher
