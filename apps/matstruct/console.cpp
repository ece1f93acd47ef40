#include "console.h"

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>

namespace matstruct::tool {

namespace {

constexpr int kBarWidth = 30;
constexpr auto kBarPeriod = std::chrono::milliseconds(100);
constexpr const char* kClearLine = "\r\033[K";

// The one global of the tool: a signal handler can reach nothing else.
std::atomic<bool> stop_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free, "a signal handler may only touch lock-free atomics");

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace

void add_console_options(CLI::App& command, ConsoleOptions& options) {
  command.add_option("--threads", options.threads, "worker threads, 0 = all cores; never changes the result")
      ->type_name("N")
      ->check(CLI::Range(0, 4096).description(""))
      ->capture_default_str();
  auto* quiet = command.add_flag("-q,--quiet", options.quiet, "say nothing but errors");
  command.add_flag("-v,--verbose", options.verbose, "say more about input and result")->excludes(quiet);
}

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = [](int) { stop_requested.store(true); };
  action.sa_flags = static_cast<int>(SA_RESETHAND | SA_RESTART);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
}

bool interrupted() {
  return stop_requested.load();
}

void say(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  fmt::print(stderr, "matstruct: {}\n", text);
}

Console::Console(const ConsoleOptions& options) : options_(options), terminal_(isatty(STDERR_FILENO) != 0) {
  context_.threads = options.threads;
  context_.stop = &stop_requested;
  if (!options.quiet)
    context_.progress = [this](const std::string& stage, double fraction) { return show(stage, fraction); };
}

Console::~Console() {
  clear_bar();
}

bool Console::show(const std::string& stage, double fraction) {
  const bool changed = stage != stage_;
  if (changed) {
    end_stage();
    stage_ = stage;
    stage_started_ = Clock::now();
  }
  if (terminal_ && (changed || Clock::now() - drawn_ > kBarPeriod)) {
    draw_bar(fraction);
    drawn_ = Clock::now();
  }
  return true;
}

void Console::draw_bar(double fraction) const {
  const int filled = static_cast<int>(kBarWidth * std::clamp(fraction, 0.0, 1.0));
  fmt::print(stderr, "{}[{:#<{}}{:-<{}}] {:3.0f} % {:6.1f} s  {}", kClearLine, "", filled, "", kBarWidth - filled,
             100 * std::clamp(fraction, 0.0, 1.0), seconds_since(started_), stage_);
  std::fflush(stderr);
}

void Console::clear_bar() const {
  if (terminal_ && !stage_.empty()) fmt::print(stderr, kClearLine);
}

void Console::end_stage() {
  if (!stage_.empty() && !terminal_) fmt::print(stderr, "{:8.2f} s  {}\n", seconds_since(stage_started_), stage_);
}

void Console::finish() {
  clear_bar();
  end_stage();
  stage_.clear();
  if (options_.quiet) return;
  for (const std::string& warning : context_.warnings) say("warning: " + warning);
}

void Console::tell(const std::string& text) const {
  if (!options_.quiet) say(text);
}

void Console::detail(const std::string& text) const {
  if (!options_.verbose) return;
  clear_bar();
  say(text);
}

}  // namespace matstruct::tool
