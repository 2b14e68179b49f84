#include "tools/program.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <thread>

#include "remomask/error.h"

namespace remomask::tools {

namespace {

// A signal handler can reach nothing but static storage.
std::stop_source& interrupt_source() {
  static std::stop_source source;
  return source;
}

volatile std::sig_atomic_t interrupt_count = 0;

void on_interrupt(int) {
  interrupt_count = interrupt_count + 1;
  if (interrupt_count > 1) _exit(130);
}

std::string duration_text(double seconds) {
  const long whole = std::lround(seconds);
  if (whole >= 3600) return fmt::format("{}h{:02}m", whole / 3600, whole % 3600 / 60);
  if (whole >= 60) return fmt::format("{}m{:02}s", whole / 60, whole % 60);
  return fmt::format("{}s", whole);
}

struct ProgressPrinter {
  using Clock = std::chrono::steady_clock;
  bool terminal = isatty(STDERR_FILENO) != 0;
  bool open_line = false;
  std::string stage;
  double first_done = 0;
  Clock::time_point started, printed;

  void operator()(const Progress& progress) {
    const auto now = Clock::now();
    if (progress.stage != stage) {
      end_line();
      stage = progress.stage;
      started = now;
      first_done = progress.done;
      printed = now - std::chrono::hours(1);
    }
    const bool complete = progress.total > 0 && progress.done >= progress.total;
    const double interval = terminal ? 0.2 : 10.0;
    if (!complete && std::chrono::duration<double>(now - printed).count() < interval) return;
    printed = now;
    const double elapsed = std::chrono::duration<double>(now - started).count();
    std::string line = stage;
    if (progress.total > 0) {
      const double share = std::clamp(progress.done / progress.total, 0.0, 1.0);
      line += fmt::format(" {:3.0f} %", 100 * share);
      if (terminal) {
        const int filled = static_cast<int>(share * 20);
        line += " [" + std::string(static_cast<size_t>(filled), '=') +
                std::string(static_cast<size_t>(20 - filled), ' ') + "]";
      }
      line += fmt::format(" {:g}/{:g}", progress.done, progress.total);
      if (progress.done > first_done && !complete) {
        const double rate = (progress.done - first_done) / std::max(1e-9, elapsed);
        line += ", " + duration_text((progress.total - progress.done) / rate) + " left";
      }
    }
    line += ", " + duration_text(elapsed);
    if (!progress.detail.empty()) line += "  " + progress.detail;
    if (terminal) {
      fmt::print(stderr, "\r\033[K{}", line.substr(0, 180));
      open_line = true;
    } else {
      fmt::print(stderr, "{}\n", line);
    }
    std::fflush(stderr);
    if (complete) end_line();
  }

  void end_line() {
    if (open_line) fmt::print(stderr, "\n");
    open_line = false;
  }
};

/// Seeds as strings, wherever they stand: 64 bits do not fit into the numbers of most JSON
/// readers.
void write_seeds_as_text(nlohmann::json& document) {
  for (auto& [name, member] : document.items()) {
    if (member.is_structured()) write_seeds_as_text(member);
    if (!document.is_object()) continue;
    if (name == "seed" && member.is_number_integer()) member = member.dump();
    if (name != "seeds" || !member.is_array()) continue;
    for (auto& seed : member) {
      if (seed.is_number_integer()) seed = seed.dump();
    }
  }
}

ProgressPrinter& progress_printer() {
  static ProgressPrinter printer;
  return printer;
}

}  // namespace

Monitor TerminalProgram::monitor() {
  struct sigaction action {};
  action.sa_handler = on_interrupt;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // stop_source is not safe inside a signal handler: a watcher passes the signal on.
  static std::jthread watcher([](const std::stop_token& ended) {
    while (!ended.stop_requested()) {
      if (interrupt_count > 0) interrupt_source().request_stop();
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
  });
  Monitor result;
  if (!quiet) result.progress = [](const Progress& value) { progress_printer()(value); };
  result.stop = interrupt_source().get_token();
  return result;
}

void TerminalProgram::finish_progress() { progress_printer().end_line(); }

void TerminalProgram::print_json(const nlohmann::json& document) {
  if (!json) return;
  answered_ = true;
  nlohmann::json answer = document;
  write_seeds_as_text(answer);
  // Text from files may hold bytes that are not UTF-8: shown, not fatal.
  fmt::print("{}\n", answer.dump(2, ' ', false, nlohmann::json::error_handler_t::replace));
}

void TerminalProgram::warn(const std::string& message) {
  finish_progress();
  fmt::print(stderr, "warning: {}\n", message);
}

}  // namespace remomask::tools
