// Errors of the library: one sentence that a user can act on.
#pragma once

#include <stdexcept>
#include <string>

namespace matstruct {

/// Bad input or an impossible request. what() is one clear sentence: what is wrong, where, what could be done.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Thrown out of a computation that was asked to stop, by its progress callback or through Context::stop. No Error, so
/// that whoever catches those does not take an interruption for a bad input.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("the computation was cancelled") {}
};

}  // namespace matstruct
