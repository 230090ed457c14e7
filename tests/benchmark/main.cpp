// Benchmark of `diagnose`: simulated sets whose truth is known, scored, beside simpler methods.
#include <fmt/format.h>
#include <getopt.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <optional>

#include "msa/base/error.h"
#include "msa/base/files.h"
#include "msa/base/memory.h"
#include "msa/base/units.h"
#include "msa/mechanism/device_file.h"
#include "tests/benchmark/scores.h"
#include "tests/benchmark/subject_scores.h"
#include "tests/support/paths.h"
#include "validation/effects/effect_file.h"
#include "validation/parallel/journal.h"
#include "validation/parallel/progress.h"
#include "validation/result_files/sha256.h"

namespace deflect::benchmark {
namespace {

using namespace effects;
using namespace figures;
using namespace json;
using namespace parallel;

constexpr const char* usage = R"(benchmark_diagnosis [options]
  --devices A,B  machines and frames with sensors: entries and laws at places hidden alike, one row each; 'all' for
                 all of them. --sets N is then of each (default 24); --json FILE is written anew after each
  --group NAME   one group of sets: {}; with --devices {}
  --sets N       about N sets, every group thinned alike (default: all)
  --seed N       of everything drawn by lot (default 1)
  --threads N    sets side by side in a process (default 0: all cores); the scores do not depend on it
  --json FILE    write every set and the scores
  --resume FILE  keep finished sets in FILE: the same command goes on there after Ctrl-C; removed at the end
  --out DIR      draw how reliable the probabilities are
Under mpirun the processes share the sets, and the first one writes.
)";

struct Arguments {
  std::string group, json, out, resume;
  std::vector<std::string> devices;
  std::size_t sets = 0;
  std::uint64_t seed = 1;
  int threads = 0;
  bool help = false;
};

std::size_t whole(const char* option, const char* text) {
  const double value = parse_number(text);
  if (!(value >= 0 && value < 1e9) || value != static_cast<double>(static_cast<std::size_t>(value)))
    throw InputError(fmt::format("--{} '{}': a whole number is wanted", option, text));
  return static_cast<std::size_t>(value);
}

Arguments parse(int argc, char** argv) {
  const option options[] = {{"devices", required_argument, nullptr, 'd'}, {"group", required_argument, nullptr, 'g'},
                            {"sets", required_argument, nullptr, 'n'},    {"seed", required_argument, nullptr, 's'},
                            {"threads", required_argument, nullptr, 't'}, {"json", required_argument, nullptr, 'j'},
                            {"out", required_argument, nullptr, 'o'},     {"resume", required_argument, nullptr, 'r'},
                            {"help", no_argument, nullptr, 'h'},          {nullptr, 0, nullptr, 0}};
  Arguments a;
  for (int c; (c = getopt_long(argc, argv, "", options, nullptr)) != -1;) switch (c) {
      case 'd':
        for (std::string rest = optarg; !rest.empty();) {
          const std::size_t comma = std::min(rest.find(','), rest.size());
          a.devices.push_back(rest.substr(0, comma));
          rest = rest.substr(std::min(comma + 1, rest.size()));
        }
        break;
      case 'g':
        a.group = optarg;
        break;
      case 'n':
        a.sets = whole("sets", optarg);
        break;
      case 's':
        a.seed = whole("seed", optarg);
        break;
      case 't':
        a.threads = static_cast<int>(whole("threads", optarg));
        break;
      case 'j':
        a.json = optarg;
        break;
      case 'o':
        a.out = optarg;
        break;
      case 'r':
        a.resume = optarg;
        break;
      case 'h':
        a.help = true;
        break;
      default:
        throw InputError("see --help");
    }
  if (optind < argc) throw InputError(fmt::format("'{}' is no option; see --help", argv[optind]));
  const auto check_group = [&](const auto& names) {
    if (!a.group.empty() && std::find(std::begin(names), std::end(names), a.group) == std::end(names))
      throw InputError(fmt::format("--group '{}': write {}", a.group, fmt::join(names, ", ")));
  };
  if (a.devices.empty())
    check_group(group_names);
  else
    check_group(set_kind_names);
  return a;
}

/// The hash of the program's and the benchmark's own data: YAML and CSV files.
std::string hash_of_data() {
  std::vector<std::filesystem::path> files;
  for (const char* folder : {"validation", "tests/benchmark"})
    for (const auto& entry :
         std::filesystem::recursive_directory_iterator(std::filesystem::path(test::source_dir()) / folder))
      if (entry.path().extension() == ".yaml" || entry.path().extension() == ".csv") files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  std::string all;
  for (const std::filesystem::path& file : files) all += read_text(file);
  return result_files::sha256(all);
}

/// What the scores depend on.
std::string identity(const Arguments& a) {
  return fmt::format("program {}\ndata {}\ngroup '{}'\nsets {}\nseed {}\ndevices {}\n",
                     result_files::sha256(read_text("/proc/self/exe")), hash_of_data(), a.group, a.sets, a.seed,
                     fmt::join(a.devices, ","));
}

void run_subjects(const Arguments& a, Journal* journal) {
  const auto done = [&](const std::vector<SubjectRow>& rows) {
    if (!a.json.empty()) write_text(a.json, json_text(subjects_json(rows)));
    fmt::print(stderr, "{}: done\n", rows.back().name);
  };
  std::optional<SetKind> kind;
  for (std::size_t i = 0; i < std::size(set_kind_names); ++i)
    if (a.group == set_kind_names[i]) kind = static_cast<SetKind>(i);
  fmt::print("{}", subjects_report(
                       diagnose_subjects(a.devices, a.sets > 0 ? a.sets : 24, kind, a.seed, a.threads, done, journal)));
}

void run_groups(const Arguments& a, Ranks* ranks, Journal* journal) {
  const std::string data = test::source_dir() + "/validation";
  const Mechanism device = read_mechanism(data + "/devices/haptic-6psu-ideal-joints.yaml");
  const std::vector<Effect> effects = catalogue(data + "/effects/catalogue");
  const std::vector<Case> orders = cases(a.seed, a.group, a.sets);
  Plans plans(device, effects, a.seed);
  std::vector<Record> records(orders.size());
  {
    Progress progress(orders.size(), "sets", ranks && !ranks->first() ? nullptr : watched_stream());
    SharedCases sets;
    sets.count = orders.size();
    sets.work = [&](std::size_t i) { records[i] = run(orders[i], device, effects, plans); };
    sets.result = [&](std::size_t i) { return packed(records[i]); };
    sets.take = [&](std::size_t i, const std::string& bytes) { records[i] = unpacked(bytes, orders[i]); };
    for_each_case(sets, journal, 0, ranks, ranks && a.threads == 0 ? ranks->threads() : a.threads,
                  [&](std::size_t done) { progress.update(done); });
  }
  if (ranks && !ranks->first()) return;
  if (!a.json.empty()) {
    Json json = {{"device", device.name}, {"seed", a.seed}};
    json.update(report_json(records));
    write_text(a.json, json_text(json));
  }
  if (!a.out.empty()) render(reliability_figure(records), a.out);
  fmt::print("{}", report(records));
}

void run_all(const Arguments& a, Ranks* ranks) {
  std::optional<Journal> journal;
  if (!a.resume.empty()) journal.emplace(a.resume, identity(a), ranks);
  Journal* const kept = journal ? &*journal : nullptr;
  if (a.devices.empty())
    run_groups(a, ranks, kept);
  else if (!ranks || ranks->first())
    run_subjects(a, kept);
  if (journal) journal->remove();
}

}  // namespace
}  // namespace deflect::benchmark

// OpenBLAS, where it is the BLAS: one thread, since sets run side by side.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

int main(int argc, char** argv) {
  deflect::keep_freed_memory();
  using namespace deflect;
  using namespace deflect::benchmark;
  if (openblas_set_num_threads) openblas_set_num_threads(1);
  const auto work = [&](Ranks* ranks) {
    const Arguments a = parse(argc, argv);
    if (!a.help) return run_all(a, ranks);
    if (!ranks || ranks->first()) fmt::print(usage, fmt::join(group_names, ", "), fmt::join(set_kind_names, ", "));
  };
  return run_on_ranks(work, [](const Ending& end) { fmt::print(stderr, "benchmark_diagnosis: {}\n", end.message); });
}
