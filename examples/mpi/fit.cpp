// SPDX-License-Identifier: BSD-3-Clause
// One fit of many files by the ranks of an MPI job: what `mmbrdf fit` finds of all their samples together.
//
//   mpirun -n 4 example_mpi_fit [--noise-alone] MODEL.json FILE.csv...
//
// The uncertainty of the sample takes up to four rounds over all files (fitting/sample_fit.hpp). In each of them every
// rank adds up its share of the files, MPI_Reduce merges the sums, and rank 0 ends the round and sends all ranks what
// they begin the next one with. --noise-alone is least squares with weights of 1, in one round.
//
// Sums travel as what state() gives: some numbers, whatever the number of samples. Files are shared out in runs of their
// order, and MPI_Reduce merges in the order of ranks, so that the number of ranks hardly shows in the result
// (docs/scale.md). An error on one rank, such as a file that is broken, ends them all, and no model is written.
#include <mpi.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <iostream>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "mmbrdf/files/model_file.hpp"
#include "mmbrdf/files/samples_file.hpp"
#include "mmbrdf/fitting/fit.hpp"
#include "mmbrdf/fitting/sample_fit.hpp"

namespace {

using mmbrdf::FitAccumulator, mmbrdf::Sample, mmbrdf::SampleFitAccumulator;

const mmbrdf::Basis basis{};  // isotropic, orders 7 and 4

// ---- `Sums` below are either of these: what differs between them ----

void set(SampleFitAccumulator& sums, std::span<const double> state) {
  sums = SampleFitAccumulator::from_state(basis, mmbrdf::Weights::speckle, state);
}
void set(FitAccumulator& sums, std::span<const double> state) { sums = FitAccumulator::from_state(basis, state); }

void add(SampleFitAccumulator& sums, std::span<const Sample> samples) { sums.add(samples, 1); }  // other ranks have the
void add(FitAccumulator& sums, std::span<const Sample> samples) { sums.add(samples); }           // other cores

bool next_round(SampleFitAccumulator& sums) { return sums.next_round(); }
bool next_round(FitAccumulator&) { return false; }

// ---- what is sent ----

/// The other ranks wait for this one: ends them, too.
void give_up(const std::exception& error) {
  std::cerr << "example_mpi_fit: " << error.what() << std::endl;
  MPI_Abort(MPI_COMM_WORLD, 1);
}

/// How a state travels: how many numbers it has, then these, then room. Only its length where there is too little room.
template <class Sums>
void pack(const Sums& sums, std::span<double> to) {
  const std::vector<double> state = sums.state();
  to[0] = static_cast<double>(state.size());
  if (state.size() < to.size()) std::ranges::copy(state, to.begin() + 1);
}

bool is_whole(std::span<const double> packed) { return packed[0] < static_cast<double>(packed.size()); }

template <class Sums>
Sums unpacked(std::span<const double> from) {
  Sums result(basis);
  set(result, from.subspan(1, static_cast<std::size_t>(from[0])));
  return result;
}

/// MPI calls this with two packed states, each of which is one item of the type: `later` becomes what both are together.
template <class Sums>
void merge(void* earlier, void* later, int*, MPI_Datatype* type) try {
  int bytes = 0;
  MPI_Type_size(*type, &bytes);
  const std::size_t size = static_cast<std::size_t>(bytes) / sizeof(double);
  const std::span first(static_cast<double*>(earlier), size), second(static_cast<double*>(later), size);
  if (!is_whole(first)) second[0] = first[0];
  if (!is_whole(second)) return;
  Sums sums = unpacked<Sums>(first);
  sums.merge(unpacked<Sums>(second));
  pack(sums, second);
} catch (const std::exception& error) {
  give_up(error);  // not through MPI, which is C
}

/// Of all ranks, on rank 0. Those who have seen other wavelengths or directions may need more room together: then once
/// more.
template <class Sums>
Sums reduced(const Sums& own, int rank) {
  unsigned long room = own.state().size() + 1;
  MPI_Allreduce(MPI_IN_PLACE, &room, 1, MPI_UNSIGNED_LONG, MPI_MAX, MPI_COMM_WORLD);
  for (;; room *= 2) {
    MPI_Datatype type;
    MPI_Op op;
    MPI_Type_contiguous(static_cast<int>(room), MPI_DOUBLE, &type);
    MPI_Type_commit(&type);
    MPI_Op_create(&merge<Sums>, 0, &op);
    std::vector<double> packed(room), all(room);
    pack(own, packed);
    MPI_Reduce(packed.data(), all.data(), 1, type, op, 0, MPI_COMM_WORLD);
    MPI_Op_free(&op);
    MPI_Type_free(&type);
    int done = is_whole(all) ? 1 : 0;
    MPI_Bcast(&done, 1, MPI_INT, 0, MPI_COMM_WORLD);
    if (done != 0) return rank == 0 ? unpacked<Sums>(all) : own;
  }
}

/// Whether there is another round, and what it begins with: as rank 0 says, since ranks merge what began with the same
/// bits alone, and on other processors they might find others.
template <class Sums>
bool next_round_of_all(Sums& sums, int rank) {
  std::vector<double> begun;  // empty: that was the last
  if (rank == 0 && next_round(sums)) begun = sums.state();
  unsigned long size = begun.size();
  MPI_Bcast(&size, 1, MPI_UNSIGNED_LONG, 0, MPI_COMM_WORLD);
  begun.resize(size);
  MPI_Bcast(begun.data(), static_cast<int>(size), MPI_DOUBLE, 0, MPI_COMM_WORLD);
  if (size > 0) set(sums, begun);
  return size > 0;
}

// ---- the fit ----

/// Before hours of work.
void require_writable(const std::string& model) {
  const std::filesystem::path folder = std::filesystem::absolute(model).parent_path();
  if (!std::filesystem::is_directory(folder))
    throw std::runtime_error(model + ": cannot be written: there is no folder " + folder.string());
  if (std::filesystem::exists(model) && mmbrdf::holds_samples(model))
    throw std::runtime_error(model + ": has samples, and would be overwritten: the model is named before the files");
}

template <class Sums>
void add_file(Sums& sums, const std::string& file) {
  const std::vector<Sample> samples = mmbrdf::read_samples(file);
  try {
    add(sums, samples);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(file + ": " + error.what());
  }
}

template <class Sums>
void fit(const std::string& model, std::span<const std::string> files, int rank, int ranks) {
  if (rank == 0) require_writable(model);
  const std::size_t r = static_cast<std::size_t>(rank), n = static_cast<std::size_t>(ranks);
  const std::size_t begin = files.size() * r / n, end = files.size() * (r + 1) / n;  // none for some, if ranks are more
  Sums sums(basis);
  do {
    for (const std::string& file : files.subspan(begin, end - begin)) add_file(sums, file);
    sums = reduced(sums, rank);
  } while (next_round_of_all(sums, rank));
  if (rank != 0) return;
  const mmbrdf::FitResult result = sums.solve();
  for (const std::string& warning : result.warnings) std::cerr << "example_mpi_fit: warning: " << warning << '\n';
  mmbrdf::save_model(model, result.model);
  std::cout << sums.samples() << " samples of " << files.size() << " files by " << ranks << " ranks\n";
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  std::vector<std::string> names(argv + 1, argv + argc);
  const bool noise_alone = !names.empty() && names[0] == "--noise-alone";
  if (noise_alone) names.erase(names.begin());
  if (names.size() < 2 || names[0].starts_with('-')) {
    if (rank == 0) std::cerr << "usage: example_mpi_fit [--noise-alone] MODEL.json FILE.csv...\n";
    MPI_Finalize();
    return 2;
  }
  try {
    (noise_alone ? fit<FitAccumulator> : fit<SampleFitAccumulator>)(names[0], std::span(names).subspan(1), rank, ranks);
  } catch (const std::exception& error) {
    give_up(error);
  }
  MPI_Finalize();
}
