// SPDX-License-Identifier: BSD-3-Clause
// One fit of many files by the ranks of an MPI job: each fits its share, and MPI_Reduce merges the states.
//
//   mpirun -n 4 example_mpi_fit MODEL.json FILE.csv...
//
// State is what FitAccumulator::state() gives: some numbers, whatever the number of samples. Files are shared out in
// runs of their order, and MPI_Reduce merges in the order of ranks, so that the result depends on the number of ranks in
// its last digits only. A file that is broken ends the whole job, and is named.
#include <mpi.h>

#include <algorithm>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <vector>

#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"

namespace {

const mmbrdf::Basis basis{};  // isotropic, orders 7 and 4

/// How a state travels: how many numbers it has, then these, then room. −1: there was too little room.
using Packed = std::vector<double>;
constexpr double too_long = -1;

void pack(const mmbrdf::FitAccumulator& fit, std::span<double> to) {
  const std::vector<double> state = fit.state();
  to[0] = state.size() < to.size() ? static_cast<double>(state.size()) : too_long;
  if (to[0] != too_long) std::copy(state.begin(), state.end(), to.begin() + 1);
}

mmbrdf::FitAccumulator unpacked(std::span<const double> from) {
  return mmbrdf::FitAccumulator::from_state(basis, from.subspan(1, static_cast<std::size_t>(from[0])));
}

/// MPI calls this: `later` becomes what `earlier` and it are together.
void merge(void* earlier, void* later, int* length, MPI_Datatype* type) {
  int bytes = 0;
  MPI_Type_size(*type, &bytes);
  const std::size_t size = static_cast<std::size_t>(bytes) / sizeof(double);
  for (int i = 0; i < *length; ++i) {
    const std::size_t at = static_cast<std::size_t>(i) * size;
    const std::span<double> first(static_cast<double*>(earlier) + at, size);
    const std::span<double> second(static_cast<double*>(later) + at, size);
    if (first[0] == too_long || second[0] == too_long) {
      second[0] = too_long;
      continue;
    }
    mmbrdf::FitAccumulator fit = unpacked(first);
    fit.merge(unpacked(second));
    pack(fit, second);
  }
}

/// Of all ranks, on rank 0. Those who have seen other wavelengths may need more room together: then once more.
mmbrdf::FitAccumulator reduced(const mmbrdf::FitAccumulator& own, int rank) {
  unsigned long room = own.state().size() + 1;
  MPI_Allreduce(MPI_IN_PLACE, &room, 1, MPI_UNSIGNED_LONG, MPI_MAX, MPI_COMM_WORLD);
  for (;; room *= 2) {
    MPI_Datatype type;
    MPI_Op op;
    MPI_Type_contiguous(static_cast<int>(room), MPI_DOUBLE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(&merge, 0, &op);
    Packed state(room), all(room);
    pack(own, state);
    MPI_Reduce(state.data(), all.data(), 1, type, op, 0, MPI_COMM_WORLD);
    MPI_Op_free(&op);
    MPI_Type_free(&type);
    int again = rank == 0 && all[0] == too_long ? 1 : 0;
    MPI_Bcast(&again, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (again == 0) return rank == 0 ? unpacked(all) : mmbrdf::FitAccumulator(basis);
  }
}

void fit(const std::string& model, std::span<char*> files, int rank, int ranks) {
  const std::size_t r = static_cast<std::size_t>(rank), n = static_cast<std::size_t>(ranks);
  mmbrdf::FitAccumulator own(basis);
  for (std::size_t i = files.size() * r / n; i < files.size() * (r + 1) / n; ++i) {
    mmbrdf::FitAccumulator one(basis);
    one.add(mmbrdf::read_samples(files[i]));
    own.merge(one);
  }
  const mmbrdf::FitAccumulator all = reduced(own, rank);
  if (rank != 0) return;
  mmbrdf::save_model(model, all.solve().model);
  std::cout << all.samples() << " samples of " << files.size() << " files by " << ranks << " ranks\n";
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  if (argc < 3) {
    if (rank == 0) std::cerr << "usage: example_mpi_fit MODEL.json FILE.csv...\n";
    MPI_Finalize();
    return 2;
  }
  try {
    fit(argv[1], std::span(argv + 2, static_cast<std::size_t>(argc - 2)), rank, ranks);
  } catch (const std::exception& error) {
    std::cerr << "example_mpi_fit: " << error.what() << std::endl;
    MPI_Abort(MPI_COMM_WORLD, 1);  // the other ranks wait for this one
  }
  MPI_Finalize();
}
