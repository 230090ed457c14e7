// Work on many cases side by side, by threads that share nothing but the list.
#pragma once

#include <cstddef>
#include <functional>

namespace deflect::parallel {

/// Calls work(i) for i = 0 … n − 1 on `threads` threads (0: as many as the machine has), `chunk` cases at a time in
/// order. Of the errors thrown that of the first failing chunk is thrown on, whatever the number of threads; cases
/// behind it may have been left out. `done`, where given, is told how many cases are through, from any thread.
void for_each_case(std::size_t n, std::size_t chunk, int threads, const std::function<void(std::size_t)>& work,
                   const std::function<void(std::size_t)>& done = {});

/// Told how far a piece of work has come, 0 … 1, from any thread; may be empty.
using Told = std::function<void(double share)>;

/// What tells of a part of the work, from … to of the whole.
Told part_of(const Told&, double from, double to);

}  // namespace deflect::parallel
