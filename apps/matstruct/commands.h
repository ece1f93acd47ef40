// The commands of the tool. Each adds its options to the parser and returns the action that the parsed options ask for.
#pragma once

#include <functional>
#include <stdexcept>

#include <CLI/CLI.hpp>

namespace matstruct::tool {

enum ExitCode : int {
  kDone = 0,
  kRefused = 1,  ///< the input was refused, or the output could not be written
  kBadUsage = 2,
  kGuaranteeFailed = 3,  ///< finished, but the report says that a guarantee does not hold
  kInterrupted = 130,    ///< as shells report a program that was ended by Ctrl-C
};

/// The command line asks for something that does not exist or makes no sense.
class UsageError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Returns an ExitCode; throws Error, Cancelled or UsageError.
using Action = std::function<int()>;

Action add_compute(CLI::App& command);
Action add_evaluate(CLI::App& command);
Action add_tetrahedralize(CLI::App& command);
Action add_info(CLI::App& command);
Action add_view(CLI::App& command);
Action add_reconstruct(CLI::App& command);
Action add_export(CLI::App& command);
Action add_render(CLI::App& command);

}  // namespace matstruct::tool
