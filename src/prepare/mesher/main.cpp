// matstruct-mesher: does what can crash, hang or exhaust memory (Gmsh, OpenCASCADE, exact constructions) in a process
// of its own. Not meant for people: the library starts it, sends a Request and reads an Answer (protocol.h).
#include <algorithm>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include <sys/resource.h>
#include <unistd.h>

#include "prepare/mesher/tasks.h"

namespace {

using matstruct::mesher::Answer;
using matstruct::mesher::Request;
using matstruct::mesher::Task;

constexpr rlim_t kMemoryLimit = rlim_t{16} << 30;  // bytes of address space

void limit_memory() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_max, kMemoryLimit);
  setrlimit(RLIMIT_AS, &limit);
}

// The answer keeps the true standard output for itself; what libraries print goes to standard error.
std::FILE* take_standard_output() {
  const int out = dup(STDOUT_FILENO);
  dup2(STDERR_FILENO, STDOUT_FILENO);
  return fdopen(out, "wb");
}

Answer perform(const Request& request) {
  switch (request.task) {
    case Task::kFill:
      return fill(request);
    case Task::kCad:
#ifdef MATSTRUCT_HAVE_OCCT
      return read_cad(request);
#else
      throw std::runtime_error("matstruct was built without OpenCASCADE");
#endif
    case Task::kResolve:
      return resolve(request);
    case Task::kIntersections:
      return find_intersections(request);
    case Task::kFillHoles:
      return fill_holes(request);
    case Task::kWrap:
      return wrap(request);
  }
  throw std::runtime_error("unknown task");
}

Answer answer(const Request& request) {
  Answer failed;
  try {
    return perform(request);
  } catch (const std::exception& error) {
    failed.error = error.what();
  } catch (...) {
    failed.error = "failed for an unknown reason";
  }
  return failed;
}

}  // namespace

int main() {
  limit_memory();
  std::FILE* out = take_standard_output();
  const auto request = matstruct::mesher::read<Request>(stdin);
  if (!out || !request) return 1;
  const bool written = matstruct::mesher::write(out, answer(*request));
  _exit(written ? 0 : 1);  // nothing to tidy up, and Gmsh's own end is one more place to crash
}
