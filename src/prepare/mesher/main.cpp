// matstruct-mesher: does what can crash, hang or exhaust memory (Gmsh, OpenCASCADE, exact constructions) in a process
// of its own. Not meant for people: the library starts it, sends a Request and reads an Answer (protocol.h). A copy of
// the process does each task, as loading the libraries takes longer than most tasks.
#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <stdexcept>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "prepare/mesher/file_packet.h"
#include "prepare/mesher/tasks.h"

namespace {

using matstruct::mesher::Answer;
using matstruct::mesher::Files;
using matstruct::mesher::receive_files;
using matstruct::mesher::Request;
using matstruct::mesher::Task;

constexpr rlim_t kMemoryLimit = rlim_t{16} << 30;  // bytes of address space

void limit_memory() {
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) != 0) return;
  limit.rlim_cur = std::min(limit.rlim_max, kMemoryLimit);
  setrlimit(RLIMIT_AS, &limit);
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

// In the copy: does the task and ends.
[[noreturn]] void work(const Files& files) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::FILE *in = fdopen(files.in, "rb"), *out = fdopen(files.out, "wb");
  const auto request = in ? matstruct::mesher::read<Request>(in) : std::nullopt;
  const bool written = request && out && matstruct::mesher::write(out, answer(*request));
  _exit(written ? 0 : 1);  // nothing to tidy up, and Gmsh's own end is one more place to crash
}

}  // namespace

int main() {
  limit_memory();
  while (const auto files = receive_files(STDIN_FILENO)) {
    const pid_t copy = fork();
    if (copy == 0) work(*files);
    close(files->in);
    close(files->out);
    int status = 0;
    if (copy < 0 || waitpid(copy, &status, 0) != copy) return 1;
    if (send(STDIN_FILENO, &status, sizeof status, MSG_NOSIGNAL) != sizeof status) return 1;
  }
}
