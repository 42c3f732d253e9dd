#include "rig/console/console_progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace lumitexel {
namespace {

using namespace std::chrono_literals;
constexpr auto kTerminalInterval = 100ms;  // smooth to the eye
constexpr auto kLineInterval = 5s;         // readable in a log
constexpr int kBarWidth = 24;

double seconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double>(duration).count();
}

}  // namespace

ConsoleProgress::ConsoleProgress() : terminal_(isatty(STDERR_FILENO) == 1) {}

void ConsoleProgress::begin(const std::string& stage, std::int64_t total, const std::string& unit) {
  const std::scoped_lock lock(mutex_);
  finish_locked();
  stage_ = stage;
  part_.clear();
  unit_ = unit;
  total_ = total;
  last_done_ = 0;
  started_ = shown_ = std::chrono::steady_clock::now();
  open_ = true;
  if (terminal_) show(0, started_);
}

void ConsoleProgress::update(std::int64_t done) {
  const std::scoped_lock lock(mutex_);
  last_done_ = std::max(last_done_, done);
  const Instant now = std::chrono::steady_clock::now();
  if (now - shown_ < (terminal_ ? std::chrono::steady_clock::duration(kTerminalInterval) : kLineInterval)) return;
  shown_ = now;
  show(last_done_, now);
}

void ConsoleProgress::part(const std::string& name) {
  const std::scoped_lock lock(mutex_);
  part_ = name;
}

void ConsoleProgress::finish() {
  const std::scoped_lock lock(mutex_);
  finish_locked();
}

void ConsoleProgress::finish_locked() {
  if (!open_) return;
  const double elapsed_s = seconds(std::chrono::steady_clock::now() - started_);
  const std::string unit = last_done_ == 1 && unit_.ends_with('s') ? unit_.substr(0, unit_.size() - 1) : unit_;
  std::fprintf(stderr, "%s%-28s %lld %s in %.1f s\n", terminal_ ? "\r\033[K" : "", stage_.c_str(),
               static_cast<long long>(last_done_), unit.c_str(), elapsed_s);
  open_ = false;
}

void ConsoleProgress::show(std::int64_t done, Instant now) {
  const double elapsed_s = seconds(now - started_);
  const double rate = elapsed_s > 0 ? static_cast<double>(done) / elapsed_s : 0.0;
  const double left_s = rate > 0 ? static_cast<double>(total_ - done) / rate : 0.0;
  const double fraction = total_ > 0 ? static_cast<double>(done) / static_cast<double>(total_) : 0.0;
  const std::string& label = part_.empty() ? stage_ : part_;  // not both: a line that wraps cannot be drawn over
  if (terminal_) {
    const int filled = std::clamp(static_cast<int>(fraction * kBarWidth), 0, kBarWidth);
    const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                            std::string(static_cast<std::size_t>(kBarWidth - filled), '.');
    std::fprintf(stderr, "\r\033[K%-28s [%s]", label.c_str(), bar.c_str());
  } else {
    std::fprintf(stderr, "%-28s", label.c_str());
  }
  std::fprintf(stderr, " %lld/%lld %s, %.3g/s, %.0f s left", static_cast<long long>(done),
               static_cast<long long>(total_), unit_.c_str(), rate, left_s);
  if (!terminal_) std::fputc('\n', stderr);
  std::fflush(stderr);
}

}  // namespace lumitexel
