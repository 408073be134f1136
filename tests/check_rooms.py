#!/usr/bin/env python3
"""Every #include points to a room above its own, and no two types have one name: check_rooms.py ROOT prints those that
do not, and fails.

The library's rooms, from the top; rooms on one line do not know each other. Interfaces, programs, Python, tests and
examples include what they like of include/, and nothing includes them.
"""
import pathlib
import re
import sys

LINES = [
    ["text"],
    ["numerics"],
    ["polarization"],
    ["geometry"],
    ["basis"],
    ["mixed"],
    ["model"],
    ["samples", "uncertainty"],
    ["radiometry"],
    ["polarimetry"],
    ["fitting"],
    ["quantities"],
    ["formats"],
    ["files"],
]
LEVEL = {room: level for level, rooms in enumerate(LINES) for room in rooms}
HEADERS = 8  # public ones in a room, at most


def upward_arrows(root):
    for base in ["include/mmbrdf", "src"]:
        for file in sorted((root / base).rglob("*.?pp")):
            room = file.relative_to(root / base).parts[0]
            if room not in LEVEL:
                yield f"{file.relative_to(root)}: in no room that {pathlib.Path(__file__).name} knows"
                continue
            for line, text in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if re.match(r"\s*#\s*include\s*[<\"](mmbrdf\.h|interfaces/.*)[>\"]", text):
                    yield f"{file.relative_to(root)}:{line}: {room} includes the interface for C, which is over all rooms"
                    continue
                found = re.match(r"\s*#\s*include\s*[<\"](mmbrdf/)?(\w+|\.\.?)/", text)
                if not found or found[2] == room or (found[2] not in LEVEL and not found[1] and found[2][0] != "."):
                    continue  # a library's header: <Eigen/Core>
                if not LEVEL.get(found[2], len(LINES)) < LEVEL[room]:
                    yield f"{file.relative_to(root)}:{line}: {room} includes {found[2]}, which is not above it"


def has_header(root, source):
    """A header of its name, or one that it is a part of: fit_rows.cpp is of fit.hpp."""
    words = source.stem.split("_")
    names = ["_".join(words[: count + 1]) + ".hpp" for count in range(len(words))]
    folder = source.parent.relative_to(root / "src")
    return any((root / base / folder / name).exists() for base in ["include/mmbrdf", "src"] for name in names)


def misfits(root):
    """Rooms with too many headers, and sources without a header."""
    for room in sorted((root / "include/mmbrdf").iterdir()):
        count = len(list(room.glob("*.hpp")))
        if count > HEADERS:
            yield f"{room.relative_to(root)}: {count} headers, at most {HEADERS}"
    for source in sorted((root / "src").rglob("*.cpp")):
        if not has_header(root, source):
            yield f"{source.relative_to(root)}: no header has its name"


def twins(root):
    """Types of one name in two headers: the linker takes the functions of one for both."""
    where = {}
    for base in ["include/mmbrdf", "src"]:
        for file in sorted((root / base).rglob("*.hpp")):
            shared = re.split(r"(?m)^namespace \{", file.read_text(encoding="utf-8"))[0]  # kernels have their own
            for found in re.finditer(r"(?m)^(?:class|struct|enum class) (?:alignas\(\w+\) )?([\w:]+)[^;\n]*\{", shared):
                where.setdefault(found[1], []).append(str(file.relative_to(root)))
    for name, files in where.items():
        if len(files) > 1:
            yield f"{name}: defined in {' and in '.join(files)}"


def main():
    root = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    faults = [*upward_arrows(root), *misfits(root), *twins(root)]
    for fault in faults:
        print(fault)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
