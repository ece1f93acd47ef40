// matstruct-mesher: does what can crash, hang or exhaust memory (Gmsh, OpenCASCADE, exact constructions) in a process
// of its own. Not meant for people: the library starts it, sends a Request and reads an Answer (protocol.h). A copy of
// the process does each task, as loading the libraries takes longer than most tasks.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <exception>
#include <optional>
#include <stdexcept>

#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
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

struct Files {
  int in = -1, out = -1;
};

// Waits for the next task; nothing if the other end is gone.
std::optional<Files> next_task() {
  char nothing = 0;
  iovec data{&nothing, 1};
  alignas(cmsghdr) std::array<char, CMSG_SPACE(2 * sizeof(int))> buffer{};
  msghdr message{};
  message.msg_iov = &data;
  message.msg_iovlen = 1;
  message.msg_control = buffer.data();
  message.msg_controllen = buffer.size();
  if (recvmsg(STDIN_FILENO, &message, MSG_CMSG_CLOEXEC) != 1) return std::nullopt;
  const cmsghdr* header = CMSG_FIRSTHDR(&message);
  if (!header || header->cmsg_type != SCM_RIGHTS || header->cmsg_len != CMSG_LEN(2 * sizeof(int))) return std::nullopt;
  std::array<int, 2> both{};
  std::memcpy(both.data(), CMSG_DATA(header), sizeof both);
  return Files{both[0], both[1]};
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
  while (const auto files = next_task()) {
    const pid_t copy = fork();
    if (copy == 0) work(*files);
    close(files->in);
    close(files->out);
    int status = 0;
    if (copy < 0 || waitpid(copy, &status, 0) != copy) return 1;
    if (send(STDIN_FILENO, &status, sizeof status, MSG_NOSIGNAL) != sizeof status) return 1;
  }
}
