#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Small valid inputs of each target, made by the program: seeds.py PROGRAM FOLDER writes FOLDER/TARGET/*."""
import pathlib
import subprocess
import sys

GRAMMARS = [
    "0:45",
    "45a:0",
    "8:d-cone(8,180,4)",
    "annulus(0,0,1,2):ring(10,20)",
    "-60:60:5",
    "45,180",
    "30",
    "scale=0.3%,source=0.5deg",
    "dhr:0,45",
    "f:0:45:90",
    "random:20",
    "germer2017",
    "1,2.5,1e3",
    "plaque:scale=0.3%,dof=12",
    "theta_r=0.02deg",
    "theta_r=-75:75:1",
    "8:443:0.990+-0.004,8:532:0.99",
    "wavelength_nm,reflectance,u_reflectance,theta_i_deg\n443,0.99,0.004,8\n532,0.985,0.004,8\n",
]


def main():
    program, folder = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(sys.argv[2])

    def seeds(target):
        (folder / target).mkdir(parents=True, exist_ok=True)
        return folder / target

    def run(*arguments):
        subprocess.run([program, *map(str, arguments)], check=True, capture_output=True)

    data = seeds("samples") / "random.csv"
    run("simulate", "ptfe-532", "--grid", "random:40", "--noise", "speckle:0.01", "-o", data)
    for name, options in {
        "noise": ["--uncertainty", "noise", "--orders", "1,1"],
        "sample": ["--orders", "1,1"],
        "published": ["--uncertainty", "noise", "--basis", "germer2017", "--orders", "1,1"],
    }.items():
        run("fit", data, *options, "-o", seeds("model") / f"{name}.json")
    run("convert", seeds("model") / "noise.json", seeds("coefficients") / "one.csv")
    raw = folder / "raw"
    run("simulate", "ptfe-532", "--grid", "random:3", "--raw", raw)
    for kind, name in enumerate(["references.csv", "raw.csv"]):
        (seeds("readings") / name).write_bytes(bytes([kind]) + (raw / name).read_bytes())
    run("calibrate", raw / "references.csv", "--film", "1.4607,1.0,4.15,0.044", "-o", seeds("instrument") / "one.json")
    lines = data.read_text().splitlines()
    header, rows = lines[0].split(",")[:5], [line.split(",")[:5] for line in lines[1:6]]
    (seeds("geometries") / "one.csv").write_text("\n".join(",".join(row) for row in [header, *rows]) + "\n")
    for number, text in enumerate(GRAMMARS):
        for kind in range(11):
            (seeds("grammars") / f"{number}-{kind}").write_bytes(bytes([kind]) + text.encode())


if __name__ == "__main__":
    main()
