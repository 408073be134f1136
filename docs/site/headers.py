# SPDX-License-Identifier: BSD-3-Clause
"""Pages of the C++ and C headers, as Markdown for Sphinx: from Doxygen's XML what is declared and where, and from the header the
comment as it stands there, with its formulas."""

from __future__ import annotations

import re
import subprocess
import xml.etree.ElementTree as xml
from pathlib import Path

KINDS = {
    "function": "function",
    "variable": "var",
    "typedef": "type",
    "enum": "enum",
    "struct": "struct",
    "class": "class",
}


def doxygen(include: Path, folder: Path) -> Path:
    """Runs Doxygen on the headers; the folder of its XML. RuntimeError with what it printed if it fails."""
    folder.mkdir(parents=True, exist_ok=True)
    settings = f"""
INPUT = {include}
RECURSIVE = YES
FILE_PATTERNS = *.hpp *.h
STRIP_FROM_PATH = {include}
OUTPUT_DIRECTORY = {folder}
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
XML_PROGRAMLISTING = NO
MARKDOWN_SUPPORT = NO
EXTRACT_ALL = YES
QUIET = YES
WARNINGS = NO
"""
    done = subprocess.run(["doxygen", "-"], input=settings, text=True, capture_output=True)
    if done.returncode:
        raise RuntimeError(f"doxygen: {done.stdout}{done.stderr}")
    return folder / "xml"


def text_of(node: xml.Element | None) -> str:
    text = " ".join("".join(node.itertext()).split()) if node is not None else ""
    return re.sub(r"(?<=\w)< (.*?) >", r"<\1>", re.sub(r"(?<=\w)< (.*?) >", r"<\1>", text))


def parameters(template: xml.Element | None) -> str:
    """Of a template, with what separates them from the declaration."""
    if template is None:
        return ""
    names = [f"{text_of(p.find('type'))} {text_of(p.find('declname'))}".strip() for p in template]
    return f"template<{', '.join(names)}> "


def line_in_file(thing: xml.Element) -> int:
    return int(thing.find("location").get("line"))


class Header:
    """The lines of a header, and the comments in them."""

    def __init__(self, path: Path):
        self.lines = path.read_text(encoding="utf-8").splitlines()

    def first(self) -> str:
        """The comment that begins the file."""
        start = next(k for k, line in enumerate(self.lines) if line.startswith("///"))
        end = next(k for k in range(start, len(self.lines)) if not self.lines[k].startswith("///"))
        return self.plain(self.lines[start:end])

    def comment(self, line: int) -> str:
        """That above a declaration, or behind it. `line` counts from 1."""
        index = line - 1
        while index > 0 and self.lines[index - 1].lstrip().startswith("template"):
            index -= 1
        above, indent = index, len(self.lines[index]) - len(self.lines[index].lstrip())
        while above > 0 and re.match(rf" {{{indent}}}///(?!<)", self.lines[above - 1]):
            above -= 1
        if above < index:
            return self.plain(self.lines[above:index])
        if found := re.search(r"///<\s*(.*)$", self.lines[index]):
            text, indent = [found[1]], found.start()
            for later in self.lines[index + 1 :]:
                if not (more := re.match(r"\s*///<?\s*(.*)$", later)) or later.index("///") != indent:
                    break
                text.append(more[1])
            return "\n".join(text)
        return ""

    def line_of(self, enumerator: str, start: int) -> int:
        """Where an enumerator is declared, at this line or below."""
        is_it = re.compile(rf"\s*(.*[{{,]\s*)?{enumerator}\b")
        return next((k + 1 for k in range(start - 1, len(self.lines)) if is_it.match(self.lines[k])), start)

    @staticmethod
    def plain(lines: list[str]) -> str:
        return "\n".join(re.sub(r"^\s*/// ?", "", line) for line in lines).strip("\n")


def markdown(comment: str) -> str:
    """A comment as it was laid out: lines that are indented stay as they are, and nothing is taken for HTML."""
    result: list[str] = []
    is_code = False
    for line in comment.splitlines():
        indented = line.startswith("  ") and line.strip() and not line.lstrip().startswith("- ")
        if indented and not is_code:
            result += ["", "~~~text"]
        elif is_code and not indented:
            result += ["~~~", ""]
        is_code = bool(indented)
        result.append(line if is_code else re.sub(r"([<\[|])", r"\\\1", line))
    return "\n".join(result + ["~~~"] * is_code)


def signature(member: xml.Element) -> str:
    """The declaration as Sphinx reads it."""
    kind = member.get("kind")
    before = parameters(member.find("templateparamlist"))
    name = text_of(member.find("name"))
    type_ = re.sub(r"\binline\b\s*", "", text_of(member.find("type")))
    if kind == "function":
        arguments = re.sub(r"\s*=\s*(default|delete|0)$", "", text_of(member.find("argsstring")))
        explicit = "explicit " if member.get("explicit") == "yes" else ""
        static = "static " if member.get("static") == "yes" else ""
        return f"{before}{static}{explicit}{type_} {name}{arguments}".replace("  ", " ").strip()
    if kind == "typedef":
        return f"{before}{name} = {type_}" if "using" in text_of(member.find("definition")) else f"{name}"
    if kind == "enum":
        return name
    value = text_of(member.find("initializer"))
    value = f" {value}" if re.match(r"= [-\w.:]{1,40}$", value) else ""
    return f"{before}{type_} {name}{text_of(member.find('argsstring'))}{value}"


def directive(kind: str, text: str, body: str, depth: int) -> str:
    fence = ":" * max(3, 8 - depth)
    return f"{fence}{{cpp:{kind}}} {text}\n{body}\n{fence}\n"


class Pages:
    """All headers of a folder."""

    def __init__(self, include: Path, doxygen_xml: Path):
        self.include, self.xml = include, doxygen_xml
        self.compounds = {
            ref.get("refid"): xml.parse(doxygen_xml / f"{ref.get('refid')}.xml").getroot().find("compounddef")
            for ref in xml.parse(doxygen_xml / "index.xml").getroot()
            if ref.get("kind") in ("class", "struct", "namespace", "file")
        }

    def member(self, header: Header, member: xml.Element, depth: int) -> str:
        kind, location = member.get("kind"), member.find("location")
        if kind not in KINDS or text_of(member.find("name")).startswith("@"):
            return ""
        body = markdown(header.comment(int(location.get("line"))))
        if kind == "enum":
            kind = "enum-class" if member.get("strong") == "yes" else "enum"
            for value in member.findall("enumvalue"):
                name = text_of(value.find("name"))
                comment = header.comment(header.line_of(name, int(location.get("bodystart"))))
                body += "\n\n" + directive("enumerator", name, markdown(comment), depth + 1)
        return directive(KINDS.get(kind, kind), signature(member), "\n" + body, depth)

    def compound(self, header: Header, compound: xml.Element, depth: int) -> str:
        kind = compound.get("kind")
        name = text_of(compound.find("compoundname")).removeprefix("mmbrdf::")
        before = parameters(compound.find("templateparamlist"))
        body = markdown(header.comment(int(compound.find("location").get("line")))) + "\n\n"
        inner = [
            self.compounds[ref.get("refid")] for ref in compound.findall("innerclass") if ref.get("prot") == "public"
        ]
        for one in inner:
            body += self.compound(header, one, depth + 1).replace(f" {name}::", " ", 1) + "\n"
        sections = [s for s in compound.findall("sectiondef") if s.get("kind", "").startswith("public")]
        for one in sorted((m for s in sections for m in s.findall("memberdef")), key=line_in_file):
            body += self.member(header, one, depth + 1) + "\n"
        return directive(kind, before + name, "\n" + body, depth)

    def things(self, path: str) -> list[xml.Element]:
        """What a header declares, in its order."""
        file = next(c for c in self.compounds.values() if c.get("kind") == "file" and self.is_in(c, path))
        found: dict[str, xml.Element] = {}
        for ref in file.findall("innerclass"):
            compound = self.compounds[ref.get("refid")]
            if "::" not in text_of(compound.find("compoundname")).removeprefix("mmbrdf::"):
                found[ref.get("refid")] = compound
        for holder in [file, *(c for c in self.compounds.values() if c.get("kind") == "namespace")]:
            for member in holder.findall("sectiondef/memberdef"):
                if self.is_in(member, path):
                    found[member.get("id")] = member
        return sorted(found.values(), key=line_in_file)

    def is_in(self, thing: xml.Element, path: str) -> bool:
        return thing.find("location").get("file") in (path, str(self.include / path))

    def page(self, path: str) -> str:
        """Of the header with this path within the folder."""
        header = Header(self.include / path)
        if path.endswith(".h"):
            return f"# {path}\n\n```c\n" + "\n".join(header.lines) + "\n```\n"
        text = f"# {path.removeprefix('mmbrdf/')}\n\n```cpp\n#include <{path}>\n```\n\n{markdown(header.first())}\n\n"
        text += "::::{cpp:namespace} mmbrdf\n::::\n\n"
        for thing in self.things(path):
            is_class = thing.tag == "compounddef"
            text += (self.compound(header, thing, 1) if is_class else self.member(header, thing, 1)) + "\n"
        return text

    def write(self, folder: Path) -> None:
        """A page for each header, and an index of them by room, in the order of what includes what."""
        rooms: dict[str, list[str]] = {}
        for path in sorted(self.include.rglob("*.h*")):
            name = path.relative_to(self.include).as_posix()
            target = folder / (re.sub(r"\.h(pp)?$", "", name.removeprefix("mmbrdf/")) + ".md")
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_text(self.page(name), encoding="utf-8")
            room = name.split("/")[1] if "/" in name else "c"
            rooms.setdefault(room, []).append(target.relative_to(folder).with_suffix("").as_posix())
        text = "# C++ headers\n\nEvery public header, as it documents itself. [Which one for what](../cpp.md).\n\n"
        for room, names in rooms.items():
            title = "C" if room == "c" else room
            text += f"```{{toctree}}\n:caption: {title}\n:maxdepth: 1\n\n" + "\n".join(names) + "\n```\n\n"
        (folder / "index.md").write_text(text, encoding="utf-8")
