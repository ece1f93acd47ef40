#include "prepare/mesher_process.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <thread>

#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <matstruct/error.h>

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

pid_t start(const fs::path& program, int in, int out) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, in, STDIN_FILENO);
  posix_spawn_file_actions_adddup2(&actions, out, STDOUT_FILENO);
  posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
  std::string name = program.string();
  char* arguments[] = {name.data(), nullptr};
  pid_t process = 0;
  const int error = posix_spawn(&process, name.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0)
    throw Error(fmt::format("the program {} cannot be started: {}.", name, std::generic_category().message(error)));
  return process;
}

void stop(pid_t process) {
  kill(process, SIGKILL);
  waitpid(process, nullptr, 0);
}

// Waits for the process; returns what went wrong, or nothing.
std::string wait(pid_t process, double seconds, Context& context) {
  constexpr std::chrono::milliseconds kShort{1}, kLong{20};
  const auto begin = Clock::now();
  for (auto pause = kShort;; pause = std::min(2 * pause, kLong)) {
    int status = 0;
    const pid_t ended = waitpid(process, &status, WNOHANG);
    if (ended == process && WIFSIGNALED(status)) return fmt::format("crashed with signal {}", WTERMSIG(status));
    if (ended == process || (ended < 0 && errno != EINTR)) return "";
    try {
      context.check();
    } catch (...) {
      stop(process);
      throw;
    }
    if (Clock::now() - begin > std::chrono::duration<double>(seconds)) {
      stop(process);
      return fmt::format("was stopped after {:.0f} seconds", seconds);
    }
    std::this_thread::sleep_for(pause);
  }
}

}  // namespace

Answer run(const Request& request, double seconds, Context& context) {
  Answer failed;
  failed.error = "was not tried, as there is no time left";
  if (seconds <= 0) return failed;
  const fs::path program = find_program();
  const File in = temporary_file(), out = temporary_file();
  if (!write(in.get(), request)) throw Error("the surface cannot be handed to the mesher; is the disk full?");
  std::rewind(in.get());
  failed.error = wait(start(program, fileno(in.get()), fileno(out.get())), seconds, context);
  if (!failed.error.empty()) return failed;
  std::rewind(out.get());
  if (auto answer = read<Answer>(out.get())) return *answer;
  failed.error = "ended without a result";
  return failed;
}

}  // namespace matstruct::mesher
