#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""ccache gives no source that was compiled with another header: check_cache.py ROOT COMPILER. Without ccache or ninja skipped (77).

The header is of a package that the compiler has in its own folders, too, and is precompiled as precompile() of cmake/cache.cmake does.
"""
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

PROJECT = """
cmake_minimum_required(VERSION 3.25)
project(small CXX)
include({root}/cmake/cache.cmake)
add_library(other INTERFACE IMPORTED)
set_target_properties(other PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${{PROJECT_SOURCE_DIR}}/other)
add_executable(small small.cpp)
target_link_libraries(small PRIVATE other)
precompile(small <nlohmann/number.hpp>)
"""


def built(folder, build):
    subprocess.run(["cmake", "--build", build], cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return subprocess.run([folder / build / "small"]).returncode


def configured(folder, build, compiler):
    command = ["cmake", "-G", "Ninja", f"-DCMAKE_CXX_COMPILER={compiler}", "-S", ".", "-B", build]
    subprocess.run(command, cwd=folder, check=True, stdout=subprocess.DEVNULL)
    return built(folder, build)


def main(root, compiler):
    if not shutil.which("ccache") or not shutil.which("ninja"):
        return 77
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        os.environ["CCACHE_DIR"] = str(folder / "cache")
        os.environ.pop("CMAKE_CXX_COMPILER_LAUNCHER", None)  # else the project's own is not used
        header = folder / "other/nlohmann/number.hpp"
        header.parent.mkdir(parents=True)
        (folder / "cmake").mkdir()
        (folder / "cmake/sanitizers.txt").touch()
        (folder / "CMakeLists.txt").write_text(PROJECT.format(root=root))
        (folder / "small.cpp").write_text("int main() { return number(); }\n")
        found = []
        for number, build in ((1, "first"), (2, "second")):
            header.write_text(f"inline int number() {{ return {number}; }}\n")
            found.append(configured(folder, build, compiler))
        header.write_text("inline int number() { return 3; }\n")
        found.append(built(folder, "second"))
    if found != [1, 2, 3]:
        print(f"programs of headers 1, 2 and 3 say {found}")
    return int(found != [1, 2, 3])


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1]).resolve(), sys.argv[2]))
