// Files are written whole or not at all, and what stands under a name is respected.
//
// A regular file, or one that is not there yet, is replaced by renaming a new file beside it (part_file.h) over it: who
// reads it sees the old text or the new one. Links are followed. A file that is there keeps its mode, owner and group;
// a new one has what the umask leaves. A file that nobody may write is refused. What a rename would tear off is written
// in place, not whole: a file with several names (hard links) or of an owner that cannot be kept, one in a folder that
// takes no new files, a file that is mounted by itself. What is no regular file (a device, a FIFO, /dev/stdout) is
// written to.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace deflect {

/// What is no regular file (a device, a FIFO) may have no end: more bytes than these are refused.
inline constexpr std::size_t most_of_a_stream = std::size_t{256} << 20;

/// The file's bytes; InputError "file: cannot be read (reason)".
std::string read_text(const std::filesystem::path&);

/// Writes as said above, creating missing folders; InputError "file: cannot be written (reason)".
void write_text(const std::filesystem::path& path, const std::string& text);

/// For libraries that write files by themselves: `write` fills an empty file whose name ends with `suffix`, and its
/// text is returned. The file is the part file of `path`, or a temporary one where that is no regular file.
std::string text_written_by(const std::filesystem::path& path, const std::string& suffix,
                            const std::function<void(const std::filesystem::path&)>& write);

/// A file's name made of a name that somebody chose: letters, digits, '-', '_', '.', spaces and what is not ASCII stay;
/// anything else, and a dot in front, becomes '_'; at most 200 bytes. It leads out of no folder.
std::string safe_file_name(std::string_view);

}  // namespace deflect
