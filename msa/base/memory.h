// How the program's memory comes from the system.
#pragma once

namespace deflect {

/// Keeps memory that is freed, up to half a GB, for what is allocated next. By default glibc gives much of it back and
/// has every page of it filled with zeros again: on that, small systems that are solved one after the other can spend
/// more time than on all else. For programs, at their start: it is of the whole process. Elsewhere than in glibc it
/// does nothing.
void keep_freed_memory();

}  // namespace deflect
