#include "validation/parallel/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iostream>

#include "validation/parallel/ranks.h"

namespace deflect::parallel {
namespace {

constexpr double patience = 1.0, pause = 0.1;  // s before the first drawing and between two
constexpr double line_pause = 10;              // s between lines that stay
constexpr std::size_t width = 24;              // of the bar

constexpr const char* wipe = "\r\x1b[K";

}  // namespace

Progress::Progress(std::size_t total, std::string what, ProgressStream stream, Clock clock)
    : total_(total), what_(std::move(what)), stream_(stream), clock_(std::move(clock)), start_(clock_()) {
  drawn_ = start_;
}

Progress::~Progress() {
  if (visible_ && !stream_.lines) *stream_.out << wipe << std::flush;
}

void Progress::update(std::size_t done) {
  if (!stream_.out) return;
  const std::lock_guard lock(mutex_);
  if (done <= done_) return;
  done_ = std::min(done, total_);
  const double now = clock_(), elapsed = now - start_, since = now - drawn_;
  if (stream_.lines ? since < line_pause : elapsed < patience || (visible_ && since < pause && done_ < total_)) return;
  drawn_ = now;
  visible_ = true;
  const double share = static_cast<double>(done_) / static_cast<double>(total_);
  const std::string count = what_.empty() ? "" : fmt::format("{} of {} {}, ", done_, total_, what_);
  const std::string text =
      fmt::format("{:3.0f} %  {}{} left", std::floor(100 * share), count, duration_text(elapsed * (1 - share) / share));
  if (stream_.lines) {
    *stream_.out << text << std::endl;
    return;
  }
  const auto filled = static_cast<std::size_t>(share * static_cast<double>(width));
  *stream_.out << wipe << fmt::format("[{}{}] {}", std::string(filled, '#'), std::string(width - filled, '.'), text)
               << std::flush;
}

double Progress::steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

ProgressStream watched_stream() {
  if (::isatty(STDERR_FILENO)) return &std::cerr;
  return {launched().size == 1 ? nullptr : &std::cerr, true};
}

std::string duration_text(double seconds) {
  const auto s = static_cast<long long>(std::ceil(std::clamp(seconds, 0.0, 3.6e9)));
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
  return fmt::format("{} h {} min", s / 3600, s % 3600 / 60);
}

}  // namespace deflect::parallel
