// CHOLMOD alone on the matrix of a frame: what a frame program cannot be much faster than, if it factorises.
//
//   bare_cholmod write FRAME.yaml MATRIX   the reduced stiffness and the reduced first load, in binary
//   bare_cholmod solve MATRIX [THREADS]    analyse, factorise, solve; seconds of each and the peak memory as JSON
#include <cholmod.h>
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "msa/frame/file/frame_build.h"
#include "msa/frame/file/frame_file.h"
#include "msa/frame/structure/assembly.h"

extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace {

using namespace deflect;

template <class T>
void write(std::ofstream& out, const T* data, std::size_t n) {
  out.write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(n * sizeof(T)));
}

template <class T>
void read(std::ifstream& in, T* data, std::size_t n) {
  in.read(reinterpret_cast<char*>(data), static_cast<std::streamsize>(n * sizeof(T)));
}

void write_matrix(const char* frame_file, const char* matrix_file) {
  const frame::FrameDescription f = frame::read_frame(frame_file);
  const frame::FrameModel m = frame::build_frame(f);
  const frame::Elimination e = frame::eliminate(m.model);
  const frame::Assembly assembly(m.model, e);
  const frame::SparsePattern& p = assembly.pattern();
  const std::vector<double> values = assembly.values(VectorX::Zero(0));
  const VectorX load = e.reduce(frame::load_of(f, m, f.loads.front().first, f.loads.front().second).forces);
  std::ofstream out(matrix_file, std::ios::binary);
  const int sizes[] = {p.n, static_cast<int>(p.row.size())};
  write(out, sizes, 2);
  write(out, p.column_start.data(), p.column_start.size());
  write(out, p.row.data(), p.row.size());
  write(out, values.data(), values.size());
  write(out, load.data(), static_cast<std::size_t>(load.size()));
}

double now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void solve(const char* matrix_file, int threads) {
  if (openblas_set_num_threads && threads > 0) openblas_set_num_threads(threads);
  std::ifstream in(matrix_file, std::ios::binary);
  int sizes[2] = {0, 0};
  read(in, sizes, 2);
  const auto n = static_cast<std::size_t>(sizes[0]), entries = static_cast<std::size_t>(sizes[1]);
  cholmod_common c;
  cholmod_start(&c);
  cholmod_sparse* A = cholmod_allocate_sparse(n, n, entries, true, true, -1, CHOLMOD_REAL, &c);
  cholmod_dense* b = cholmod_allocate_dense(n, 1, n, CHOLMOD_REAL, &c);
  read(in, static_cast<int*>(A->p), n + 1);
  read(in, static_cast<int*>(A->i), entries);
  read(in, static_cast<double*>(A->x), entries);
  read(in, static_cast<double*>(b->x), n);
  if (!in || n == 0) throw std::runtime_error("not a matrix");
  const double start = now();
  cholmod_factor* L = cholmod_analyze(A, &c);
  const double analysed = now();
  cholmod_factorize(A, L, &c);
  const double factored = now();
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, L, b, &c);
  const double solved = now();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf(
      "{\"analyse_s\": %.4f, \"factor_s\": %.4f, \"solve_s\": %.4f, \"total_s\": %.4f, \"peak_MB\": %.1f, "
      "\"factor_MB\": %.1f, \"ordering\": %d}\n",
      analysed - start, factored - analysed, solved - factored, solved - start,
      static_cast<double>(usage.ru_maxrss) / 1024, 8e-6 * c.lnz, c.method[c.selected].ordering);
  cholmod_free_dense(&x, &c);
  cholmod_free_dense(&b, &c);
  cholmod_free_factor(&L, &c);
  cholmod_free_sparse(&A, &c);
  cholmod_finish(&c);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string what = argc > 1 ? argv[1] : "";
  try {
    if (what == "write" && argc == 4)
      write_matrix(argv[2], argv[3]);
    else if (what == "solve" && argc >= 3)
      solve(argv[2], argc > 3 ? std::atoi(argv[3]) : 0);
    else
      throw std::runtime_error("bare_cholmod write FRAME MATRIX | bare_cholmod solve MATRIX [THREADS]");
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
}
