#!/usr/bin/python3
# SPDX-License-Identifier: BSD-3-Clause
"""Interfaces as their users have them: built by their own tools from an installed prefix.

    run.py install BUILD PREFIX             installs what is built into an empty folder
    run.py LANGUAGE BUILD PREFIX SOURCE     c, fortran, r or octave; exit status 77 where there is no toolchain

R and Octave are built by the page's own command, which must leave the prefix as it is. Of each language the example of
docs/interfaces.md is run, and must print what the page says; then test.* beside this file,
which prints numbers with 17 digits: those of expected.cpp, which asks the C++ library the same.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

SKIPPED = 77
HERE = Path(__file__).resolve().parent


def run(*command, env=None, folder=None):
    done = subprocess.run(command, capture_output=True, text=True, env=env, cwd=folder)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout


def need(*tools):
    for tool in tools:
        if not shutil.which(tool):
            print(f"skipped: no {tool} (./dev packages c, fortran, r or octave installs what is needed)")
            sys.exit(SKIPPED)


def flags(which, env):
    return run("pkg-config", which, "mmbrdf", env=env).split()


def c(program, folder, prefix, env):
    options = ["-std=c99", "-Wall", "-Wextra", "-Wpedantic", "-Werror"]
    run(
        "cc",
        *options,
        *flags("--cflags", env),
        program,
        "-o",
        folder / "program",
        *flags("--libs", env),
        "-lm",
        env=env,
    )
    return [folder / "program"]


def fortran(program, folder, prefix, env):
    options = ["-std=f2018", "-Wall", "-Wextra", "-Werror", f"-J{folder}"]
    module = prefix / "share/mmbrdf/fortran/mmbrdf.f90"
    run("gfortran", *options, module, program, "-o", folder / "program", *flags("--libs", env), env=env)
    return [folder / "program"]


def r(program, folder, prefix, env):
    return ["Rscript", program]


def octave(program, folder, prefix, env):
    return ["octave-cli", "--quiet", "--no-init-file", "--path", env["OCTAVE_FOLDER"], program]


def as_the_page_says(source, heading, prefix, folder, env):
    """The first command of a section, for one who may not write into the prefix."""
    before = sorted(prefix.rglob("*"))
    command = re.search(r"^ {4}(.*)", section(source / "docs/interfaces.md", heading), re.MULTILINE)[1]
    run("sh", "-c", command.replace("INTERFACES", str(prefix / "share/mmbrdf")), env=env, folder=folder)
    if sorted(prefix.rglob("*")) != before:
        sys.exit(f"{command}: writes into the prefix")


def header_alone(prefix, folder, env, source):
    """In C and C++ of any age: no comma at the end of a list, and the like."""
    pedantic = ["-Wall", "-Wextra", "-Wpedantic", "-Werror", "-fsyntax-only"]
    for compiler in ("cc -std=c90 -xc", "c++ -std=c++98 -xc++"):
        run(*compiler.split(), *pedantic, "-include", prefix / "include/mmbrdf.h", "/dev/null", env=env)


def build_r(prefix, folder, env, source):
    """The package in a library of its own, and R CMD check without a complaint."""
    profile = folder / "profile.R"  # the network has no part in this
    (folder / "none/src/contrib").mkdir(parents=True)
    (folder / "none/src/contrib/PACKAGES").touch()
    profile.write_text(f'options(repos = c(CRAN = "file://{folder}/none"))\n')
    env.update(R_PROFILE=str(profile), R_LIBS=str(folder / "library"), _R_CHECK_FORCE_SUGGESTS_="false")
    (folder / "library").mkdir()
    as_the_page_says(source, "R", prefix, folder, env)
    (archive,) = folder.glob("mmbrdf_*.tar.gz")
    said = run("R", "CMD", "check", "--no-manual", archive, env=env, folder=folder)
    complaints = [line for line in said.splitlines() if re.search(r"\b(ERROR|WARNING|NOTE)s?$", line)]
    if complaints or "Status: OK" not in said:
        sys.exit(f"R CMD check: {said}")


def build_octave(prefix, folder, env, source):
    as_the_page_says(source, "Octave", prefix, folder, env)
    env["OCTAVE_FOLDER"] = str(folder / "octave")


LANGUAGES = {  # program of a page or a test to a command, what is built before, ending, name in the page, tools
    "c": (c, header_alone, "c", "C", ["cc", "c++", "pkg-config"]),
    "fortran": (fortran, None, "f90", "Fortran", ["gfortran", "pkg-config"]),
    "r": (r, build_r, "R", "R", ["R", "cc", "pkg-config"]),
    "octave": (octave, build_octave, "m", "Octave", ["octave-cli", "mkoctfile", "pkg-config"]),
}


def section(page, heading):
    text = page.read_text(encoding="utf-8")
    return re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", text, re.MULTILINE | re.DOTALL)[1]


def example(page, heading):
    """The program, and what it prints: the last two blocks of code of a section."""
    blocks = re.findall(r"^```\w*\n(.*?)^```$", section(page, heading), re.MULTILINE | re.DOTALL)
    return blocks[-2], blocks[-1]


def numbers(text):
    return [
        [line.split()[0], *map(float, line.replace("NA", "nan").split()[1:])]
        for line in text.splitlines()
        if line.strip()
    ]


def test(language, build, prefix, source):
    to_command, prepare, ending, heading, tools = LANGUAGES[language]
    need(*tools)
    env = dict(os.environ)
    (pc,) = prefix.glob("lib*/**/mmbrdf.pc")
    env["PKG_CONFIG_PATH"] = str(pc.parent)
    env["LD_LIBRARY_PATH"] = str(pc.parent.parent)  # where the library is a shared one
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        if prepare:
            prepare(prefix, folder, env, source)
        program, printed = example(source / "docs/interfaces.md", heading)
        (folder / f"page_example.{ending}").write_text(program)
        told = run(*to_command(folder / f"page_example.{ending}", folder, prefix, env), env=env, folder=folder)
        if told.split() != printed.split():
            sys.exit(f"docs/interfaces.md says of {heading}:\n{printed}\nbut it prints:\n{told}")
        told = run(*to_command(HERE / f"test.{ending}", folder, prefix, env), env=env, folder=folder)
        expected = run(build / "tests/interface_numbers")
        if repr(numbers(told)) != repr(numbers(expected)):
            sys.exit(f"test.{ending} gives\n{told}\nand the C++ library\n{expected}")
        print(f"{heading}: the example of the page, and {sum(map(len, numbers(told)))} numbers of the library")


def main():
    what, build, prefix = sys.argv[1], Path(sys.argv[2]).resolve(), Path(sys.argv[3]).resolve()
    if what == "install":
        shutil.rmtree(prefix, ignore_errors=True)
        run("cmake", "--install", build, "--prefix", prefix)
    else:
        test(what, build, prefix, Path(sys.argv[4]).resolve())


if __name__ == "__main__":
    main()
