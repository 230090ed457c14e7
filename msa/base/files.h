// Files are written whole or not at all.
#pragma once

#include <filesystem>
#include <string>

namespace deflect {

/// The file's bytes; InputError "file: cannot be read (reason)".
std::string read_text(const std::filesystem::path&);

/// Writes to a neighbour and renames it over `path`, creating missing folders; InputError when that fails.
void write_text(const std::filesystem::path& path, const std::string& text);

}  // namespace deflect
