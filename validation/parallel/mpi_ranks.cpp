// Ranks of MPI: bytes are sent as they are, one message after another; only the main thread calls MPI.
#include <mpi.h>
#include <sched.h>

#include <algorithm>
#include <limits>

#include "msa/base/index.h"
#include "validation/parallel/mpi_module.h"

namespace deflect::parallel::mpi {
namespace {

constexpr int tag = 1;
constexpr std::size_t most = std::numeric_limits<int>::max();  // bytes in one message

template <class Send>
void in_pieces(std::size_t bytes, const Send& send) {
  for (std::size_t at = 0; at < bytes; at += most) send(at, static_cast<int>(std::min(most, bytes - at)));
}

/// Processors that this process may use, shared with those of the node that may use them too.
int processors() {
  cpu_set_t own;
  CPU_ZERO(&own);
  ::sched_getaffinity(0, sizeof own, &own);
  MPI_Comm node;
  MPI_Comm_split_type(MPI_COMM_WORLD, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &node);
  int here = 1;
  MPI_Comm_size(node, &here);
  std::vector<cpu_set_t> all(as_size(here));
  MPI_Allgather(&own, sizeof own, MPI_BYTE, all.data(), sizeof own, MPI_BYTE, node);
  MPI_Comm_free(&node);
  const auto sharing = std::count_if(all.begin(), all.end(), [&](const cpu_set_t& other) {
    cpu_set_t both;
    CPU_AND(&both, &own, &other);
    return CPU_COUNT(&both) > 0;
  });
  return std::max(1, CPU_COUNT(&own) / std::max(1, static_cast<int>(sharing)));
}

class MpiRanks : public Ranks {
 public:
  MpiRanks(int rank, int size, int threads) : Ranks(rank, size, threads) {}
  ~MpiRanks() override { MPI_Finalize(); }

 protected:
  std::vector<std::string> gather(const std::string& mine) override {
    const unsigned long long bytes = mine.size();
    std::vector<unsigned long long> sizes(first() ? as_size(size()) : 0);
    MPI_Gather(&bytes, 1, MPI_UNSIGNED_LONG_LONG, sizes.data(), 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    if (!first()) {
      in_pieces(bytes, [&](std::size_t at, int n) { MPI_Send(mine.data() + at, n, MPI_BYTE, 0, tag, MPI_COMM_WORLD); });
      return {};
    }
    std::vector<std::string> all = {mine};
    for (std::size_t r = 1; r < sizes.size(); ++r) {
      all.emplace_back(sizes[r], '\0');
      in_pieces(sizes[r], [&](std::size_t at, int n) {
        MPI_Recv(all[r].data() + at, n, MPI_BYTE, static_cast<int>(r), tag, MPI_COMM_WORLD, MPI_STATUS_IGNORE);
      });
    }
    return all;
  }

  std::string from_first(const std::string& said) override {
    unsigned long long bytes = said.size();
    MPI_Bcast(&bytes, 1, MPI_UNSIGNED_LONG_LONG, 0, MPI_COMM_WORLD);
    std::string out = first() ? said : std::string(bytes, '\0');
    in_pieces(bytes, [&](std::size_t at, int n) { MPI_Bcast(out.data() + at, n, MPI_BYTE, 0, MPI_COMM_WORLD); });
    return out;
  }
};

std::unique_ptr<Ranks> start(std::string& failure) noexcept try {
  int given = 0, rank = 0, size = 1;
  if (MPI_Init_thread(nullptr, nullptr, MPI_THREAD_FUNNELED, &given) != MPI_SUCCESS || given < MPI_THREAD_FUNNELED) {
    failure = "it does not allow threads";
    return nullptr;
  }
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return std::make_unique<MpiRanks>(rank, size, processors());
} catch (const std::exception& e) {
  failure = e.what();
  return nullptr;
}

std::string library() noexcept {
  char text[MPI_MAX_LIBRARY_VERSION_STRING];
  int length = 0;
  MPI_Get_library_version(text, &length);
  const std::string all(text, as_size(length));
  return all.substr(0, all.find_first_of(",\n"));
}

constexpr Module table = {{module_kind.interface, DEFLECT_VERSION}, start, library};

}  // namespace
}  // namespace deflect::parallel::mpi

extern "C" __attribute__((visibility("default"))) const deflect::ModuleHead* deflect_mpi_module() {
  return &deflect::parallel::mpi::table;
}
