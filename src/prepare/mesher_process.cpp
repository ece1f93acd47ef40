#include "prepare/mesher_process.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <dlfcn.h>
#include <fcntl.h>
#include <poll.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <matstruct/error.h>

#include "prepare/mesher/file_packet.h"

extern char** environ;

namespace matstruct::mesher {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kVariable = "MATSTRUCT_MESHER";
constexpr const char* kProgram = "matstruct-mesher";

// The folder of the executable or shared library that this code was linked into.
fs::path own_folder() {
  Dl_info info{};
  std::error_code ignored;
  if (dladdr(reinterpret_cast<const void*>(&own_folder), &info) == 0 || !info.dli_fname) return {};
  const fs::path file = fs::canonical(info.dli_fname, ignored);
  return file.empty() ? fs::canonical("/proc/self/exe", ignored).parent_path() : file.parent_path();
}

fs::path find_program() {
  if (const char* given = std::getenv(kVariable)) return given;
  const fs::path own = own_folder();
  for (const fs::path& folder : {own, own / "../libexec/matstruct", fs::path(MATSTRUCT_MESHER_FOLDER)}) {
    std::error_code ignored;
    if (!folder.empty() && fs::exists(folder / kProgram, ignored)) return folder / kProgram;
  }
  throw Error(
      fmt::format("the program {}, which reads CAD files and fills surfaces with tetrahedra, was not found; install "
                  "matstruct with Gmsh or set {} "
                  "to the program's path.",
                  kProgram, kVariable));
}

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

// A nameless file: vanishes with the last process that holds it, so nothing is ever left behind.
File temporary_file() {
  File file(std::tmpfile());
  if (!file) throw Error("no temporary file can be made; is the disk full?");
  fcntl(fileno(file.get()), F_SETFD, FD_CLOEXEC);
  return file;
}

// What the loader and the sanitizers need. Gmsh copies others, and what it makes depends on where its memory lies,
// hence on their lengths.
std::vector<char*> environment() {
  constexpr std::array<std::string_view, 4> kPassed{
      "LD_LIBRARY_PATH=", "ASAN_OPTIONS=", "UBSAN_OPTIONS=", "LSAN_OPTIONS="};
  std::vector<char*> variables;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (std::any_of(kPassed.begin(), kPassed.end(),
                    [&](std::string_view name) { return std::string_view(*variable).starts_with(name); }))
      variables.push_back(*variable);
  variables.push_back(nullptr);
  return variables;
}

std::string crash(int status) {
  return WIFSIGNALED(status) ? fmt::format("crashed with signal {}", WTERMSIG(status)) : "";
}

}  // namespace

// Copies of itself do the work (protocol.h), so that it can be asked again after one has crashed.
class Process {
 public:
  explicit Process(const fs::path& program) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends) != 0)
      throw Error("no connection with the mesher can be made; are too many files open?");
    socket_ = ends[0];
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDIN_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    std::string name = kProgram;
    char* arguments[] = {name.data(), nullptr};
    std::vector<char*> variables = environment();
    const int error = posix_spawn(&id_, program.c_str(), &actions, nullptr, arguments, variables.data());
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error == 0) return;
    close(socket_);
    throw Error(
        fmt::format("the program {} cannot be started: {}.", program.string(), std::generic_category().message(error)));
  }
  Process(const Process&) = delete;
  ~Process() {
    end();
    close(socket_);
  }

  // Has a copy read the request and write the answer. Returns what went wrong, or nothing.
  std::string perform(const Files& files, double seconds, Context& context) {
    constexpr int kPause = 20;  // milliseconds between two looks at the context
    const auto begin = Clock::now();
    bool ended = !send_files(socket_, files);
    while (!ended) {
      context.check();
      if (Clock::now() - begin > std::chrono::duration<double>(seconds)) {
        end();
        return fmt::format("was stopped after {:.0f} seconds", seconds);
      }
      pollfd event{socket_, POLLIN, 0};
      if (poll(&event, 1, kPause) <= 0) continue;
      int status = 0;
      if (recv(socket_, &status, sizeof status, 0) == sizeof status) return crash(status);
      ended = true;
    }
    return crash(end());
  }

  bool ended() const { return id_ == 0; }

 private:
  // Ends it, and a copy at work with it. Returns how it ended.
  int end() {
    int status = 0;
    if (id_ != 0) {
      kill(id_, SIGKILL);
      waitpid(id_, &status, 0);
    }
    id_ = 0;
    return status;
  }

  pid_t id_ = 0;
  int socket_ = -1;
};

namespace {

void ensure_running(Context& context) {
  if (!context.mesher || context.mesher->ended()) context.mesher = std::make_shared<Process>(find_program());
}

}  // namespace

void start(Context& context) {
  try {
    ensure_running(context);
  } catch (const Error&) {
    // run() meets the same error, where an answer is needed.
  }
}

Answer run(const Request& request, double seconds, Context& context) {
  Answer failed;
  failed.error = "was not tried, as there is no time left";
  if (seconds <= 0) return failed;
  ensure_running(context);
  const File in = temporary_file(), out = temporary_file();
  if (!write(in.get(), request)) throw Error("the surface cannot be handed to the mesher; is the disk full?");
  std::rewind(in.get());
  try {
    failed.error = context.mesher->perform({fileno(in.get()), fileno(out.get())}, seconds, context);
  } catch (...) {
    context.mesher.reset();
    throw;
  }
  if (!failed.error.empty()) return failed;
  std::rewind(out.get());
  if (auto answer = read<Answer>(out.get())) return *answer;
  failed.error = "ended without a result";
  return failed;
}

}  // namespace matstruct::mesher
