// What the commands share: options for talkativeness and threads, progress on stderr, interruption, names in messages.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>
#include <utility>

#include <CLI/CLI.hpp>

#include <matstruct/context.h>
#include <matstruct/error.h>

namespace matstruct::tool {

struct ConsoleOptions {
  bool quiet = false;
  bool verbose = false;
  int threads = 0;
};

/// Adds --threads, --quiet and --verbose.
void add_console_options(CLI::App& command, ConsoleOptions& options);

/// Turns SIGINT and SIGTERM into a request to stop; a second one ends the program at once.
void catch_interrupts();
bool interrupted();

/// One line on stderr, whatever the text: "matstruct: text".
void say(std::string text);

/// Progress on stderr: a bar if stderr is a terminal, else a line per finished stage. Owns the context of a command.
class Console {
 public:
  explicit Console(const ConsoleOptions& options);
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  Context& context() { return context_; }
  /// Ends the progress display and prints the context's warnings.
  void finish();
  /// A sentence about the result, unless --quiet.
  void tell(const std::string& text) const;
  /// A detail, only if --verbose.
  void detail(const std::string& text) const;

 private:
  using Clock = std::chrono::steady_clock;
  bool show(const std::string& stage, double fraction);
  void draw_bar(double fraction) const;
  void clear_bar() const;
  void end_stage();

  ConsoleOptions options_;
  bool terminal_;
  std::string stage_;
  Clock::time_point started_ = Clock::now();
  Clock::time_point stage_started_ = started_;
  Clock::time_point drawn_;
  Context context_;
};

/// Calls `work`; an Error that does not name the file gets its name in front.
template <class Work>
auto naming(const std::filesystem::path& file, const Work& work) {
  try {
    return work();
  } catch (const Error& error) {
    const std::string text = error.what();
    if (text.find(file.filename().string()) != std::string::npos) throw;
    throw Error(file.string() + ": " + text);
  }
}

}  // namespace matstruct::tool
