// The ways this program refuses to go on. A message says where, what was needed, what was got, what to try.

#pragma once

#include <stdexcept>

namespace craze {

/// The caller, the settings or a file is wrong. Exit code 2.
struct InvalidInput : std::invalid_argument {
    using std::invalid_argument::invalid_argument;
};

/// The input was fine, the computation was not (diverged, did not converge, nothing left to load). Exit code 1.
struct ComputationFailed : std::runtime_error {
    using std::runtime_error::runtime_error;
};

/// The user asked to stop (Ctrl-C, SIGTERM). Finished rooms stay on disk. Exit code 130.
struct Interrupted : std::runtime_error {
    Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace craze
