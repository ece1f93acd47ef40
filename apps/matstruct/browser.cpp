#include "browser.h"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <sstream>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include <matstruct/error.h>

#include "console.h"

extern char** environ;

namespace matstruct::tool {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr const char* kBrowserVariable = "MATSTRUCT_BROWSER";
constexpr std::chrono::seconds kTimeLimit{60};

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "matstruct-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error("no temporary folder can be made; is the disk full?");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// The address of a file; bytes that have a meaning in addresses are escaped.
std::string url(const fs::path& file) {
  std::string text = "file://";
  for (const char c : fs::absolute(file).string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) || std::string_view("/-._~").find(c) != std::string_view::npos)
      text += c;
    else
      text += fmt::format("%{:02X}", byte);
  }
  return text;
}

// Starts the program in a process group of its own, silent.
pid_t start(std::vector<std::string> words) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
  std::vector<char*> arguments;
  for (std::string& w : words) arguments.push_back(w.data());
  arguments.push_back(nullptr);
  pid_t process = 0;
  const int error = posix_spawn(&process, arguments[0], &actions, &attributes, arguments.data(), environ);
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw Error(fmt::format("the browser {} cannot be started.", words.front()));
  return process;
}

// Whether the process ends well before the limit; afterwards nothing of its group is left.
bool ends_well(pid_t process) {
  const auto end = Clock::now() + kTimeLimit;
  int status = 0;
  bool ended = false;
  while (!ended && Clock::now() < end && !interrupted()) {
    ended = waitpid(process, &status, WNOHANG) == process;
    if (!ended) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  kill(-process, SIGKILL);
  if (!ended) waitpid(process, &status, 0);
  return ended && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

}  // namespace

fs::path find_browser() {
  if (const char* given = std::getenv(kBrowserVariable)) return given;
  const char* path = std::getenv("PATH");
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"}) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (const fs::path file = fs::path(folder) / name; access(file.c_str(), X_OK) == 0) return file;
  }
  throw Error(fmt::format("no browser was found, which pictures are made with; install chromium or set {} to one.",
                          kBrowserVariable));
}

void photograph(const fs::path& browser, const fs::path& page, const std::string& address, int width, int height,
                const fs::path& picture) {
  const TemporaryFolder profile;
  const fs::path shot = profile.path() / "picture.png";
  const bool good = ends_well(start(
      {browser.string(), "--headless", "--no-sandbox", "--disable-quic", "--no-first-run",
       "--disable-background-networking", "--disable-component-update", "--disable-sync", "--use-angle=swiftshader",
       "--enable-unsafe-swiftshader", "--hide-scrollbars", "--allow-file-access-from-files",
       "--force-device-scale-factor=1", "--user-data-dir=" + profile.path().string(), "--virtual-time-budget=2000",
       fmt::format("--window-size={},{}", width, height), "--screenshot=" + shot.string(), url(page) + address}));
  if (interrupted()) throw Error("interrupted.");
  if (!good || !fs::exists(shot))
    throw Error(fmt::format("{}: the browser {} made no picture.", page.string(), browser.string()));
  std::error_code error;
  fs::copy_file(shot, picture, fs::copy_options::overwrite_existing, error);
  if (error) throw Error(fmt::format("{}: cannot be written: {}.", picture.string(), error.message()));
}

}  // namespace matstruct::tool
