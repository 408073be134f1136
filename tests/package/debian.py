#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Debian packages, and the archive, in a Debian with nothing else in it: ./dev package

    debian.py FOLDER        FOLDER: where the packages and the archive are

Needs root and mmdebstrap. The program comes first and alone, then all else with the compilers that use it. What is run is what
README.md and docs/interfaces.md say, and each must print what they say.
"""
import os
import re
import subprocess
import sys
import tempfile
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(SOURCE / "tests/interfaces"))
from run import example  # noqa: E402


def call(*command):
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


class Debian:
    def __init__(self, root, folder):
        call("mmdebstrap", "--variant=apt", "--skip=cleanup/apt/lists", "bookworm", root)
        self.root = root
        self.home = root / "srv"  # which every Debian has, empty
        for file in folder.iterdir():
            if file.suffix in (".deb", ".gz"):
                (self.home / file.name).write_bytes(file.read_bytes())
        (root / "etc/resolv.conf").write_text(Path("/etc/resolv.conf").read_text())
        call("mount", "-t", "proc", "proc", root / "proc")  # where a program learns in which folder it is

    def __enter__(self):
        return self

    def __exit__(self, *_):
        call("umount", "-l", self.root / "proc")  # whatever still runs there

    def __call__(self, command):
        kept = [f"{name}={value}" for name, value in os.environ.items() if name.lower().endswith("_proxy")]
        path = "PATH=/usr/sbin:/usr/bin:/sbin:/bin"
        clean = ["env", "-i", path, "HOME=/srv", "DEBIAN_FRONTEND=noninteractive", *kept]
        return call("chroot", self.root, *clean, "sh", "-ec", f"cd /srv; {command}")

    def install(self, *packages):
        self(f"apt-get install -y --no-install-recommends {' '.join(packages)}")

    def holds(self, what, command, expected):
        told = self(command)
        if told.split() != expected.split():
            sys.exit(f"{what}: expected\n{expected}\nbut got\n{told}")
        print(f"  {what}")


def first_result():
    """Of the README: the command, and what it prints."""
    return re.search(
        r"^\$ (mmbrdf evaluate .*)\n((?:.*\n)*?)```", (SOURCE / "README.md").read_text(), re.MULTILINE
    ).groups()


def checked_program(debian):
    debian.install("./mmbrdf_*.deb", "./libmmbrdf0*.deb")
    debian.holds("mmbrdf: the README's first result", *first_result())
    debian("mmbrdf simulate ptfe-532 --grid germer2017 --seed 1 -o data.csv && mmbrdf fit data.csv -o fitted.json")
    debian("apt-get install -y --no-install-recommends libnetcdf19")
    debian("mmbrdf export fitted.json fitted.nc --error 1 && mmbrdf convert fitted.nc again.csv")


def checked_languages(debian):
    debian.install("./*.deb", "g++ cmake make pkgconf gfortran")
    page = SOURCE / "docs/interfaces.md"
    compilers = {
        "C": ("c", "cc example.c $(pkg-config --cflags --libs mmbrdf) && ./a.out"),
        "Fortran": (
            "f90",
            "gfortran $(pkg-config --variable=interfaces mmbrdf)/fortran/mmbrdf.f90 example.f90 "
            "$(pkg-config --libs mmbrdf) && ./a.out",
        ),
        "R": ("R", "Rscript example.R"),
    }
    for language, (ending, command) in compilers.items():
        program, printed = example(page, language)
        (debian.home / f"example.{ending}").write_text(program)
        debian.holds(f"{language}: the example of the page", command, printed)
    for name in ("CMakeLists.txt", "main.cpp"):
        (debian.home / name).write_text((SOURCE / "tests/package" / name).read_text())
    debian.holds("C++: find_package", "(cmake -S . -B b && cmake --build b) >log && b/consumer", "")
    evaluated = "mmbrdf.material('ptfe').evaluate(532, 45, 0, 30, 180)[0, 0]"
    debian.holds("Python", f'python3 -c "import mmbrdf; print(round(float({evaluated}), 10))"', "0.3282394121")


def checked_archive(debian):
    """In a folder of any name, with no package of ours."""
    debian(
        "apt-get purge -y '*mmbrdf*' && mkdir 'any where' && tar -xzf mmbrdf-*.tar.gz -C 'any where' --strip-components 1"
    )
    command, printed = first_result()
    debian.holds("the archive", f"'any where/bin/'{command}", printed)
    debian("mv 'any where' anywhere")
    find = "PKG_CONFIG_PATH=$(dirname $(find $PWD/anywhere -name mmbrdf.pc)); export PKG_CONFIG_PATH"
    found = "LD_LIBRARY_PATH=$(dirname $PKG_CONFIG_PATH) ./a.out"
    debian.holds(
        "C from the archive, moved",
        f"{find}; cc example.c $(pkg-config --cflags --libs mmbrdf) && {found}",
        example(SOURCE / "docs/interfaces.md", "C")[1],
    )


def main():
    folder = Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as name:
        with Debian(Path(name) / "root", folder) as debian:
            checked_program(debian)
            checked_languages(debian)
            checked_archive(debian)


if __name__ == "__main__":
    main()
