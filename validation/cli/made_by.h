// Result files with what they were made from, in one place for all commands.
#pragma once

#include <string>
#include <vector>

#include "validation/cli/command.h"
#include "validation/result_files/provenance.h"
#include "validation/subject/subject.h"

namespace deflect::cli {

/// For the rest of the run: the command that runs. It must live as long.
void set_command(const Command&);

/// Before any work. InputError where a file that the command is to write is one that it reads, or two outputs are one
/// file: one of them would be lost. With --force a description may be written in place of the one that was read.
void require_separate_files(const Command&);

/// Before any work. InputError where a file or folder that the command is to write cannot be written.
void require_writable_outputs(const Command&);

/// write_file() of a JSON object, with its provenance (provenance.h).
void write_result(const std::string& file, const std::string& json);

/// What a result of the command names as its command: its name, positional arguments, and every option in force as
/// "--name=value", without those that do not change the result. An output that must be given is the last.
std::vector<std::string> words_of(const Command&);

/// What the running command does and from what, a line each: the program by its version and the hash of its file,
/// words_of(), inputs with their hashes. Two runs that are alike in it have the same result.
std::string identity_of_run();

/// The option by which the command must be told a file to write, as in "-o=": nullptr where it has none.
const Option* required_output(const Command&);

/// The file of an input by the name that a provenance gives it, and its hash now: empty for what is no regular file.
/// InputError where there is none.
std::string hash_of(const std::string& name);

/// Whether the result says that it was made from a file with these contents, whatever its name.
bool has_read(const std::string& result, const std::string& file);

/// Remarks where the result in this file says that it is of a subject of another name, or of one of this name in a file
/// that has changed since.
void remark_if_of_another(const std::string& result, const std::string& device, const subject::Subject&);

/// Remarks where the result in this file says what it was made from, and one of these files is not among that.
void remark_if_of_other_data(const std::string& result, const std::vector<std::string>& files);

}  // namespace deflect::cli
