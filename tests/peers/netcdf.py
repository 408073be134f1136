# SPDX-License-Identifier: BSD-3-Clause
"""Readers of NetCDF on a self-describing file: values and angles that each has at random places of brdf, as it counts axes."""
import os
import pathlib
import re
import subprocess
import tempfile

import numpy as np
import peer

import mmbrdf

ROUNDING = 1e-12  # the same doubles; the model is asked at angles that were read

# Each prints, for indices from 0 of wavelength, theta_i, theta_r, phi_r, row and column on a line, the angles and the value.
XARRAY = """
import sys, xarray
d = xarray.open_dataset("NAME")
for line in sys.stdin:
    w, i, r, p, a, b = map(int, line.split())
    values = d.wavelength_nm[w], d.theta_i_deg[i], d.theta_r_deg[r], d.phi_r_deg[p], d.brdf[w, i, r, p, a, b]
    print(*(repr(float(v)) for v in values))
"""
R = """
library(LIBRARY)
nc <- OPEN("NAME")
get <- function(name) GET(nc, name)
f <- get("brdf")
if (length(dim(f)) == 5) dim(f) <- c(dim(f), 1)  # axes come reversed, and one of length 1 is dropped
w <- get("wavelength_nm"); i <- get("theta_i_deg"); r <- get("theta_r_deg"); p <- get("phi_r_deg")
x <- as.matrix(read.table(file("stdin"))) + 1
for (n in seq_len(nrow(x)))
  cat(sprintf("%.17g", c(w[x[n, 1]], i[x[n, 2]], r[x[n, 3]], p[x[n, 4]], f[x[n, 6], x[n, 5], x[n, 4], x[n, 3], x[n, 2], x[n, 1]])), "\\n")
"""
OCTAVE = """
pkg load netcdf
name = "NAME";
f = ncread(name, "brdf");  % axes come reversed
w = ncread(name, "wavelength_nm"); i = ncread(name, "theta_i_deg"); r = ncread(name, "theta_r_deg"); p = ncread(name, "phi_r_deg");
x = fscanf(stdin, "%d", [6, Inf])' + 1;
for n = 1:rows(x)
  printf("%.17g ", w(x(n, 1)), i(x(n, 2)), r(x(n, 3)), p(x(n, 4)), f(x(n, 6), x(n, 5), x(n, 4), x(n, 3), x(n, 2), x(n, 1)));
  printf("\\n");
end
"""
GDL = " & ".join("""
id = ncdf_open("NAME")
ncdf_varget, id, "brdf", f
ncdf_varget, id, "wavelength_nm", w
ncdf_varget, id, "theta_i_deg", i
ncdf_varget, id, "theta_r_deg", r
ncdf_varget, id, "phi_r_deg", p
x = lonarr(6, 1000)
openr, unit, "NAME.txt", /get_lun
readf, unit, x
y = dblarr(5, 1000)
for n = 0, 999 do y[*, n] = [w[x[0, n]], i[x[1, n]], r[x[2, n]], p[x[3, n]], f[x[5, n], x[4, n], x[3, n], x[2, n], x[1, n], x[0, n]]]
print, y, format = "(5(e25.16))"
""".strip().splitlines())


def r_script(library, opened, got):
    return R.replace("LIBRARY", library).replace("OPEN", opened).replace("GET", got)


def check(name, variable, option, script, version, model, file, places):
    if not os.environ.get(variable):
        print(f"skipped: set {variable} to the program that runs {name}")
        return
    program = peer.command(variable, name)
    there = subprocess.run(program + [option, version], text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    if there.returncode:
        print(f"skipped: {program[0]} does not have {name}")
        return
    answers = peer.ask(program + [option, script.replace("NAME", str(file))], places)
    nm, theta_i, theta_r, phi_r, value = answers.T
    m = model.evaluate(nm, theta_i, 0, theta_r, phi_r, frame="sp")
    row, column = places[:, 4:].T
    deviations = (value - m[np.arange(len(m)), row, column]) / m[:, 0, 0]
    peer.judge(f"{name} {there.stdout.strip()}", "NetCDF, 16 elements", deviations, ROUNDING, ROUNDING)


def main():
    model = mmbrdf.material("ptfe")
    with tempfile.TemporaryDirectory() as folder:
        file = pathlib.Path(folder) / "ptfe.nc"
        note = model.export(file, wavelength_nm=[450, 532])
        step = float(re.search(r"in steps of ([\d.]+)", note).group(1))
        random = np.random.default_rng(1)
        shape = [2, round(90 / step) + 1, round(90 / step) + 1, round(360 / step) + 1, 4, 4]
        places = np.column_stack([random.integers(0, n, 1000) for n in shape])
        np.savetxt(f"{file}.txt", places, "%d")  # for GDL, which does not read a pipe
        version = 'cat(format(packageVersion("{}")))'.format
        for name, variable, option, script, asked in [
            ("xarray", "MMBRDF_PEER_XARRAY", "-c", XARRAY, "import xarray; print(xarray.__version__)"),
            ("ncdf4", "MMBRDF_PEER_R", "-e", r_script("ncdf4", "nc_open", "ncvar_get"), version("ncdf4")),
            ("RNetCDF", "MMBRDF_PEER_R", "-e", r_script("RNetCDF", "open.nc", "var.get.nc"), version("RNetCDF")),
            ("octave-netcdf", "MMBRDF_PEER_OCTAVE", "--eval", OCTAVE, "disp(pkg('list', 'netcdf'){1}.version)"),
            ("GDL", "MMBRDF_PEER_GDL", "-e", GDL, "print, !gdl.release"),
        ]:
            check(name, variable, option, script, asked, model, file, places)


main()
