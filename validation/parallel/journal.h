// Finished parts of a long piece of work in a file, so that a run that was interrupted goes on where it stood.
//
// The file begins with the head: what the work is and what it is made from. A file whose head is another is refused,
// since its parts belong to other work. Behind it each part has its number, its length, its bytes (pack.h) and a
// checksum. A part is written when it is finished, in one piece: after Ctrl-C or kill -9 all finished parts are there.
// What stands behind the first part that is not whole is cut off when the file is opened again. A process of
// mpirun other than the first opens no file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include "validation/parallel/shared_cases.h"

namespace deflect::parallel {

class Journal {
 public:
  /// Opens the file, or begins it. InputError where it is in use, is that of other work, is no journal, or cannot be
  /// read or written.
  Journal(std::filesystem::path, const std::string& head, const Ranks* = nullptr);

  /// Parts that earlier runs have finished; each number once.
  std::size_t kept() const { return parts_.size(); }
  /// Those with a number from `first` to before `end`, each handed over once; and their numbers.
  std::vector<std::uint64_t> take(std::uint64_t first, std::uint64_t end,
                                  const std::function<void(std::uint64_t, const std::string& bytes)>&);

  /// From any thread. InputError where it cannot be written.
  void add(std::uint64_t number, const std::string& bytes);

  /// The work is done and its results are written: the file goes.
  void remove();

 private:
  void read(const std::string& head);
  void write(const std::string&);

  /// Open from when it gets its number.
  struct OpenFile {
    int number = -1;
    OpenFile() = default;
    ~OpenFile();
    OpenFile(const OpenFile&) = delete;
    OpenFile& operator=(const OpenFile&) = delete;
  };

  std::filesystem::path file_;
  OpenFile open_;
  std::mutex mutex_;
  std::vector<std::pair<std::uint64_t, std::string>> parts_;
};

/// As without a journal (shared_cases.h), but for those that it holds: they are taken from it. Case i has the number
/// first + i there. Rank 0 keeps its own cases as they are finished, those of other ranks when they meet.
void for_each_case(const SharedCases&, Journal*, std::uint64_t first, Ranks*, int threads,
                   const std::function<void(std::size_t done)>& told = {});

}  // namespace deflect::parallel
