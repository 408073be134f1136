#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""What a call from C, Fortran, R and Octave costs beside the same call of the C++ library, in one run.

    tests/interfaces/run.py install build/release build/release/installed
    apps/bench/interfaces.py build/release/installed

Each evaluates 1 048 576 geometries, on one thread; of all rounds in turn the shortest time of the processor counts. "there"
is memory that has been used before, "new" is memory of the call, which the system has to find and to clear: R and Octave
have no other.
"""
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROUNDS = 5
POINTS = 1 << 20

CPP = r"""
#include <mmbrdf.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <memory>
#include <vector>

#include <mmbrdf/files/materials.hpp>
#include <mmbrdf/model/batch.hpp>

int main(int, char** what) {
  using namespace mmbrdf;
  constexpr std::size_t n = 1 << 20;
  std::vector<Geometry> geometries;
  for (std::size_t q = 0; q < n; ++q)
    geometries.push_back({{1.3 * double(q % 997) / 997, 0.01 * double(q % 628)}, {1.3 * double(q % 991) / 991, 0.01 * double(q % 619)}});
  const PreparedModel prepared = prepare(material("ptfe"), 0.532);
  mmbrdf_model* model;
  mmbrdf_prepared* at;
  if (mmbrdf_material("ptfe", &model, nullptr) || mmbrdf_prepare(model, 0.532, &at, nullptr)) return 1;
  const bool is_c = what[1][0] == 'c', is_new = !std::strcmp(what[2], "new");
  const mmbrdf_layout layout{0, std::strstr(what[1], "signs") ? 3 : 0, std::strstr(what[1], "column") ? 1 : 0};
  std::vector<Mueller> there(n);
  double best = 1e9;
  for (int round = 0; round < 7; ++round) {
    timespec begin, end;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &begin);
    std::unique_ptr<Mueller[]> fresh;
    if (is_new) fresh = std::make_unique_for_overwrite<Mueller[]>(n);
    Mueller* out = is_new ? fresh.get() : there.data();
    if (is_c)
      mmbrdf_evaluate(at, n, &geometries[0].incident.theta, &layout, 1, out->elements.data(), nullptr);
    else
      evaluate(prepared, geometries, std::span(out, n), {});
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &end);
    best = std::min(best, double(end.tv_sec - begin.tv_sec) * 1e9 + double(end.tv_nsec - begin.tv_nsec));
  }
  std::printf("%g\n", best / n);
}
"""

FORTRAN = """
program bench
   use mmbrdf
   implicit none
   integer, parameter :: dp = mmbrdf_real, n = 2**20
   type(mmbrdf_model) :: model
   type(mmbrdf_prepared) :: at
   real(dp), allocatable :: g(:, :), m(:, :, :)
   real :: first, last, best
   integer :: q
   allocate (g(4, n), m(4, 4, n))
   do q = 0, n - 1
      g(:, q + 1) = [1.3_dp * mod(q, 997) / 997, 0.01_dp * mod(q, 628), 1.3_dp * mod(q, 991) / 991, 0.01_dp * mod(q, 619)]
   end do
   call mmbrdf_material("ptfe", model)
   call mmbrdf_prepare(model, 0.532_dp, at)
   best = 1e9
   do q = 1, 7
      call cpu_time(first)
      call mmbrdf_evaluate(at, g, m)
      call cpu_time(last)
      best = min(best, last - first)
   end do
   print *, best / n * 1e9
end program
"""

R = """
library(mmbrdf)
q <- 0:(2^20 - 1)
ti <- 74 * (q %% 997) / 997; pi <- 0.57 * (q %% 628); tr <- 74 * (q %% 991) / 991; pr <- 0.57 * (q %% 619)
ptfe <- material("ptfe")
best <- min(sapply(1:7, function(round) { gc(); sum(system.time(evaluate(ptfe, 532, ti, pi, tr, pr, threads = 1))[1:2]) }))
cat(best / 2^20 * 1e9, "\\n")
"""

OCTAVE = """
q = 0:(2^20 - 1);
ti = 74 * mod (q, 997) / 997; ph = 0.57 * mod (q, 628); tr = 74 * mod (q, 991) / 991; pr = 0.57 * mod (q, 619);
ptfe = mmbrdf_material ("ptfe");
best = Inf;
for round = 1:7
  begin = cputime (); m = mmbrdf_evaluate (ptfe, 532, ti, ph, tr, pr, "xy", "germer2017", 1);
  best = min (best, cputime () - begin); clear m;
endfor
printf ("%g\\n", best / 2^20 * 1e9);
"""


def main():
    prefix = Path(sys.argv[1]).resolve()
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "tests/interfaces"))
    import run as interfaces

    env = dict(os.environ)
    (pc,) = prefix.glob("lib*/**/mmbrdf.pc")
    env.update(PKG_CONFIG_PATH=str(pc.parent), LD_LIBRARY_PATH=str(pc.parent.parent))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for file, text in {"bench.cpp": CPP, "bench.f90": FORTRAN, "bench.R": R, "bench_octave.m": OCTAVE}.items():
            (folder / file).write_text(text)
        flags = lambda which: interfaces.flags(which, env)
        interfaces.run(
            "g++", "-std=c++20", "-O2", *flags("--cflags"), folder / "bench.cpp", "-o", folder / "cpp", *flags("--libs")
        )
        (folder / "module").mkdir()
        module = prefix / "share/mmbrdf/fortran/mmbrdf.f90"
        interfaces.run(
            "gfortran",
            "-O2",
            f"-J{folder}/module",
            module,
            folder / "bench.f90",
            "-o",
            folder / "f90",
            *flags("--libs"),
        )
        interfaces.build_r(prefix, folder, env)
        interfaces.build_octave(prefix, folder, env)
        asked = {
            "C++, there": [folder / "cpp", "library", "there"],
            "C, row by row, there": [folder / "cpp", "c", "there"],
            "C, column by column, there": [folder / "cpp", "c-column", "there"],
            "C, another convention, there": [folder / "cpp", "c-signs", "there"],
            "Fortran, there": [folder / "f90"],
            "C++, new": [folder / "cpp", "library", "new"],
            "R, new": ["Rscript", folder / "bench.R"],
            "Octave, new": interfaces.octave(folder / "bench_octave.m", folder, prefix, env),
        }
        times = {name: [] for name in asked}
        for _ in range(ROUNDS):
            for name, command in asked.items():
                times[name].append(float(interfaces.run(*command, env=env)))
        for name, several in times.items():
            library = "C++, new" if name.endswith("new") else "C++, there"
            print(f"{name:30s} {min(several):7.1f} ns  {min(several) / min(times[library]):5.2f}")


if __name__ == "__main__":
    main()
