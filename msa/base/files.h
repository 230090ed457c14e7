// Reads and writes files. A regular file is written completely or not at all.
//
// A regular or new file is written as a new file in the same folder (part_file.h), which is then renamed: readers see
// the old text or the new one. Links are followed. An existing file keeps its mode, owner and group; a new one gets the
// mode by the umask. A file that nobody may write is refused. Files that a rename would break are written in place,
// without that guarantee: files with several hard links, files whose owner cannot be kept, files in a folder that
// accepts no new files, files that are mount points. Anything that is not a regular file (a device, a FIFO,
// /dev/stdout) is written to directly.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace deflect {

/// A device or a FIFO may have no end: more bytes than this are refused.
inline constexpr std::size_t most_of_a_stream = std::size_t{256} << 20;

/// The file's bytes. Throws InputError "file: cannot be read (reason)".
std::string read_text(const std::filesystem::path&);

/// Writes as described above and creates missing folders. Throws InputError "file: cannot be written (reason)".
void write_text(const std::filesystem::path& path, const std::string& text);

/// Before long work: throws the InputError that write_text() would throw for this file now, or for files in this
/// folder, as far as can be told without writing.
void require_writable_file(const std::filesystem::path&);
void require_writable_folder(const std::filesystem::path&);

/// For the rest of the run write_text() refuses this file: what a command read is never what it writes. Of files that
/// are written to directly nothing is lost, and they are not refused. Not to be called while others write.
void keep_as_it_is(const std::filesystem::path&);

/// For libraries that write files themselves: `write` fills an empty file whose name ends with `suffix`, and its text
/// is returned. The file is the part file of `path`, or a temporary file where `path` is not a regular file.
std::string text_written_by(const std::filesystem::path& path, const std::string& suffix,
                            const std::function<void(const std::filesystem::path&)>& write);

/// A file name from a name chosen by the user: letters, digits, '-', '_', '.', spaces and non-ASCII characters stay;
/// others, and a leading dot, become '_'; at most 200 bytes. The result cannot leave its folder.
std::string safe_file_name(std::string_view);

}  // namespace deflect
