#include "craze/core/progress.hpp"

#include "craze/core/errors.hpp"

#include <fmt/format.h>

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <mutex>
#include <thread>
#include <utility>

namespace craze {

namespace {

std::atomic<Verbosity> loudness{Verbosity::normal};
std::atomic<bool> stop_asked{false};
static_assert(std::atomic<bool>::is_always_lock_free);
std::mutex output;
std::vector<std::string> notices;

bool on_terminal() { return isatty(STDERR_FILENO) != 0; }

std::int64_t now_ns()
{
    return std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string duration(double seconds)
{
    const auto s = static_cast<int>(seconds + 0.5);
    return s < 60 ? fmt::format("{} s", s) : fmt::format("{} min {:02} s", s / 60, s % 60);
}

// Ctrl-C a second time ends at once.
void on_signal(int signal)
{
    if (stop_asked.exchange(true)) {
        std::signal(signal, SIG_DFL);
        std::raise(signal);
    }
}

}  // namespace

void set_verbosity(Verbosity verbosity) { loudness = verbosity; }

void say(std::string_view line)
{
    if (loudness == Verbosity::quiet) return;
    const std::lock_guard lock(output);
    fmt::print(stderr, "{}{}\n", on_terminal() ? "\r\033[K" : "", line);
}

void notice(std::string_view line)
{
    say(fmt::format("notice: {}", line));
    const std::lock_guard lock(output);
    notices.emplace_back(line);
}

std::vector<std::string> take_notices()
{
    const std::lock_guard lock(output);
    return std::exchange(notices, {});
}

void catch_interrupts()
{
    std::signal(SIGINT, on_signal);
    std::signal(SIGTERM, on_signal);
}

bool interrupted() { return stop_asked; }

void check_interrupt()
{
    if (stop_asked) throw Interrupted();
}

struct Progress::State {
    std::string what;
    std::int64_t total;
    std::thread::id owner = std::this_thread::get_id();
    std::int64_t start = now_ns();
    std::atomic<std::int64_t> done{0}, next_print{0};
    bool shown = false;
};

Progress::Progress(std::string_view what, std::int64_t total)
    : state_(new State{std::string(what), std::max<std::int64_t>(total, 1)})
{
    state_->next_print = state_->start + 500'000'000;
}

Progress::~Progress()
{
    if (state_->shown && on_terminal()) {
        const std::lock_guard lock(output);
        fmt::print(stderr, "\r\033[K");
    }
    delete state_;
}

void Progress::advance(std::int64_t steps)
{
    const std::int64_t done = state_->done += steps;
    if (stop_asked && std::this_thread::get_id() == state_->owner) throw Interrupted();
    if (loudness == Verbosity::quiet) return;
    const std::int64_t now = now_ns();
    std::int64_t due = state_->next_print;
    const bool terminal = on_terminal();
    const std::int64_t pause = terminal ? 100'000'000 : 10'000'000'000;
    if (now < due || !state_->next_print.compare_exchange_strong(due, now + pause)) return;
    const double share = std::min(1.0, static_cast<double>(done) / static_cast<double>(state_->total));
    const double spent = static_cast<double>(now - state_->start) * 1e-9;
    const std::string left = share > 0.02 ? duration(spent / share - spent) + " left" : "";
    const std::lock_guard lock(output);
    state_->shown = true;
    if (terminal) {
        const auto filled = static_cast<std::size_t>(share * 30);
        fmt::print(stderr, "\r\033[K  {:<34} [{:<30}] {:3.0f} %  {}", state_->what, std::string(filled, '='),
                   share * 100, left);
        std::fflush(stderr);
    } else {
        fmt::print(stderr, "  {}: {:.0f} %, {}\n", state_->what, share * 100, left);
    }
}

Stopwatch::Stopwatch() : start_ns_(now_ns()) {}

double Stopwatch::seconds() const { return static_cast<double>(now_ns() - start_ns_) * 1e-9; }

std::int64_t peak_memory()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<std::int64_t>(usage.ru_maxrss) * 1024;
}

}  // namespace craze
