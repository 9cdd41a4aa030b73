// Long work shows how far it is, and stops cleanly when asked to.

#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace craze {

/// What is printed while rooms work: a bar on a terminal, plain lines in a log, nothing when quiet. To standard error.
enum class Verbosity { quiet, normal };
void set_verbosity(Verbosity verbosity);

/// One line of news ("images: 100 slices of 284 x 284").
void say(std::string_view line);
/// Something the user should know though work goes on; also kept for summary.json.
void notice(std::string_view line);
/// The notices since the last call, in order.
std::vector<std::string> take_notices();

/// Ctrl-C and SIGTERM set a flag; long loops ask for it.
void catch_interrupts();
bool interrupted();
/// @throws Interrupted  if the user asked to stop
void check_interrupt();

/// Progress of one piece of work: shows share done and time left, throws Interrupted when asked to stop.
/// advance() may be called from any thread; it throws only from the thread that made the object.
class Progress {
public:
    Progress(std::string_view what, std::int64_t total);
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    void advance(std::int64_t steps = 1);

private:
    struct State;
    State* state_;
};

/// Seconds since the object was made.
class Stopwatch {
public:
    Stopwatch();
    double seconds() const;

private:
    std::int64_t start_ns_;
};

/// Highest resident memory of this process so far, bytes.
std::int64_t peak_memory();

}  // namespace craze
