#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Small valid inputs of each target, made by the program: seeds.py PROGRAM FOLDER writes FOLDER/TARGET/*."""
import math
import pathlib
import struct
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

ASTM = "NUM_POINTS 2\nVARS theta_i,phi_i,theta_s,phi_s,BRDF\n0.5,0,0.25,3,0.31\n0.5,0,0.75,3,-1e-5\n"
ZEMAX = """Source Measured
Symmetry PlaneSymmetrical
SpectralContent Monochrome
ScatterType BRDF
SampleRotation 1
0
AngleOfIncidence 2
0 30
ScatterAzimuth 2
0 180
ScatterRadial 2
0 20
Monochrome
DataBegin
TIS 0.9
0.3 0.2
0.3 0.2
TIS 0.9
0.3 0.2
0.3 0.1
DataEnd
"""
ALTA = "#DIM {} 1\n#VS 1\n#PARAM_IN {}\n#PARAM_OUT INV_STERADIAN_COSINE_FACTOR\n{} 0.3 0.01\n"
BIRD = """{"metadata": {"schema": "brdf_json_schema"}, "data": {"theta_i": {"unit": "deg", "values": [10, 10]},
"phi_i": {"unit": "rad", "values": [0, 0]}, "theta_r": {"unit": "deg", "values": [20, 20]},
"phi_r": {"unit": "deg", "values": [60, 60]}, "BRDF": {"unit": "sr^-1", "values": [0.3, 0.2]},
"uBRDF": {"unit": "%", "values": [1, 1]}, "wavelength_i": {"unit": "nm", "values": [550, 550]},
"polarization_i": {"notation": "inStokes", "values": [[1, 1, 0, 0], [1, -1, 0, 0]]}}}
"""


def tensor_file(fields):
    """Of (name, type, shape, numbers): type 10 is float, 3 is unsigned short, 1 is a byte."""
    head = b"tensor_file\0\1\0" + struct.pack("<I", len(fields))
    offset = len(head) + sum(13 + len(name) + 8 * len(shape) for name, _, shape, _ in fields)
    data = b""
    for name, kind, shape, numbers in fields:
        head += struct.pack("<H", len(name)) + name.encode() + struct.pack("<HBQ", len(shape), kind, offset + len(data))
        head += struct.pack(f"<{len(shape)}Q", *shape)
        data += struct.pack(f"<{len(numbers)}{ {10: 'f', 3: 'H', 1: 'B'}[kind]}", *numbers)
    return head + data


def foreign():
    """Small files in the formats of other programs, and how many wavelengths each takes."""
    matrix = [0.3, 0.01, 0, 0, 0.01, 0.1, 0, 0, 0, 0, 0.1, 0, 0, 0, 0, 0.1]
    axes = [("phi_d", 10, (1, 2), (0, 1)), ("theta_d", 10, (1, 2), (0, 0.5)), ("theta_h", 10, (1, 2), (0, 0.5))]
    pbsdf = [*axes, ("wvls", 3, (1,), (532,)), ("M", 10, (2, 2, 2, 1, 4, 4), matrix * 8)]
    rgl = [("theta_i", 10, (1,), (0.3,)), ("phi_i", 10, (1,), (0,)), ("ndf", 10, (2, 2), (1, 1, 2, 2))]
    rgl += [("sigma", 10, (2, 2), (1, 1, 1, 1)), ("vndf", 10, (1, 1, 2, 2), (1, 2, 3, 4)), ("jacobian", 1, (1,), (1,))]
    rgl += [("rgb", 10, (1, 1, 3, 2, 2), [0.3] * 12)]
    alta = {"SPHERICAL_TL_PL_TV_PV": 4, "ISOTROPIC_TV_TL_DPHI": 3, "RUSIN_TH_PH_TD_PD": 4}
    yield 1, ASTM.encode()
    yield 1, ZEMAX.encode()
    yield 0, BIRD.encode()
    for name, count in alta.items():
        yield 1, ALTA.format(count, name, " ".join(["0.2"] * count)).encode()
    cosine = f"{math.cos(0.3)} 0 {math.sin(0.3)}"
    yield 1, ALTA.format(6, "CARTESIAN", cosine + " 0 0 1").encode()
    yield 3, struct.pack("<3i24d", 2, 2, 2, *range(24))
    yield 0, tensor_file(pbsdf)
    yield 3, tensor_file(rgl)


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
    for kind in range(16):  # formats that are written
        model = (seeds("model") / "noise.json").read_bytes()
        (seeds("exports") / f"{kind}").write_bytes(bytes([kind]) + model)
    raw = folder / "raw"
    run("simulate", "ptfe-532", "--grid", "random:3", "--raw", raw)
    for kind, name in enumerate(["references.csv", "raw.csv"]):
        (seeds("readings") / name).write_bytes(bytes([kind]) + (raw / name).read_bytes())
    run("calibrate", raw / "references.csv", "--film", "1.4607,1.0,4.15,0.044", "-o", seeds("instrument") / "one.json")
    frames = folder / "frames"
    run("simulate", "ptfe-532", "--grid", "random:3", "--retarders", "1:5,6,127", "--frames", "31", "--raw", frames)
    for kind, name in enumerate(["references.csv", "raw.csv"]):
        (seeds("readings") / f"frames_{name}").write_bytes(bytes([kind]) + (frames / name).read_bytes())
    run("calibrate", frames / "references.csv", "--film", "1.4607,1.0,4.15,0.044", "--retarders", "1:5,6,127",
        "-o", seeds("instrument") / "retarders.json")
    lines = data.read_text().splitlines()
    header, rows = lines[0].split(",")[:5], [line.split(",")[:5] for line in lines[1:6]]
    (seeds("geometries") / "one.csv").write_text("\n".join(",".join(row) for row in [header, *rows]) + "\n")
    for number, (wavelengths, content) in enumerate(foreign()):
        (seeds("foreign") / f"{number}").write_bytes(bytes([wavelengths]) + content)
    for number, text in enumerate(GRAMMARS):
        for kind in range(11):
            (seeds("grammars") / f"{number}-{kind}").write_bytes(bytes([kind]) + text.encode())


if __name__ == "__main__":
    main()
