#include "validation/parallel/ranks.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <string>

#include "msa/base/error.h"
#include "msa/base/outcome.h"
#include "validation/parallel/mpi_module.h"
#include "validation/parallel/pack.h"

namespace deflect::parallel {

/// What a rank comes to a meeting with.
struct Brought {
  int code = 0;  ///< of its ending; 0: `bytes` are its work, else the message
  std::uint64_t at = Ranks::no_case;
  std::string bytes;

  template <class Archive>
  void serialize(Archive& a) {
    a(code, at, bytes);
  }
};

Ranks::Meeting Ranks::meet(const Brought& mine, const std::string& said) {
  Meeting out;
  Brought outcome{0, no_case, said};
  const std::vector<std::string> all = gather(pack(mine));
  for (std::size_t r = 0; r < all.size(); ++r) {
    Brought b = unpack<Brought>(all[r]);
    if (b.code != 0 && (outcome.code == 0 || b.at < outcome.at)) {
      outcome = b;
      if (r > 0 && b.at == no_case) outcome.bytes = fmt::format("rank {}: {}", r, b.bytes);
    }
    out.brought.push_back(std::move(b.bytes));
  }
  outcome = unpack<Brought>(from_first(pack(outcome)));
  parted_ = outcome.code != 0;
  if (parted_) throw_ending({outcome.code, outcome.bytes});
  out.said = std::move(outcome.bytes);
  return out;
}

Ranks::Meeting Ranks::meet(const std::string& mine, const std::string& said) {
  return meet(Brought{0, no_case, mine}, said);
}

void Ranks::meet_with(const std::exception_ptr& error, std::uint64_t at) {
  const Ending e = ending_of(error);
  meet(Brought{e.code, at, e.message}, "");
  throw_ending(e);  // not reached: the meeting throws
}

Launched launched() {
  const auto number = [](const char* name, int otherwise) {
    const char* const text = std::getenv(name);
    return text ? std::max(0, std::atoi(text)) : otherwise;
  };
  if (const char* const alone = std::getenv("DEFLECT_ALONE"); alone && *alone) return {};
  for (const std::string by : {"OMPI_COMM_WORLD", "PMI"})  // Open MPI; MPICH and its kin
    if (const int size = number((by + "_SIZE").c_str(), 0)) return {number((by + "_RANK").c_str(), 0), size};
  if (const int rank = number("PMIX_RANK", -1); rank >= 0) return {rank, 0};
  return {};
}

std::unique_ptr<Ranks> launched_ranks() {
  const int size = launched().size;
  if (size == 1) return nullptr;
  const auto refuse = [&](const std::string& why) {
    throw InputError(
        fmt::format("this process was started as one of {}, and {}", size > 0 ? std::to_string(size) : "some", why));
  };
  const auto loaded = outcome_of<ModelError>([] { return &load_module(mpi::module_kind); });
  if (!loaded)
    refuse(
        fmt::format("deflect has no MPI to find the others: build it where libopenmpi-dev is installed, or start "
                    "it without mpirun ({})",
                    loaded.why));
  const auto* module = static_cast<const mpi::Module*>(*loaded);
  std::string failure;
  std::unique_ptr<Ranks> ranks = module->start(failure);
  if (!ranks) refuse("MPI does not start: " + failure);
  if (size > 0 && ranks->size() != size)
    refuse(fmt::format("{} finds {} of them: start it with the mpirun of that MPI", module->library(), ranks->size()));
  if (ranks->size() == 1) return nullptr;
  return ranks;
}

int run_on_ranks(const std::function<void(Ranks*)>& work, const std::function<void(const Ending&)>& tell) {
  std::unique_ptr<Ranks> ranks;  // ends after everything was told: MPI's launcher stops all with the first that fails
  std::exception_ptr error = thrown_by([&] {
    ranks = launched_ranks();
    work(ranks.get());
    if (ranks) ranks->meet("");
  });
  if (!error) return 0;
  if (ranks && !ranks->parted())
    if (const std::exception_ptr later = thrown_by([&] { ranks->meet_with(error); })) error = later;
  const Ending end = ending_of(error);
  if (launched().rank == 0) tell(end);
  return end.code;
}

}  // namespace deflect::parallel
