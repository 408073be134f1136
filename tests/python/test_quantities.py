# SPDX-License-Identifier: BSD-3-Clause
"""The derived quantities are said once: what shows them shows the same."""

import json
from pathlib import Path

import mmbrdf

QUESTION = ("ptfe", "-w", 532, "-i", "45,0", "-r", "30,180", "--stokes", "1,0,0,-1", "--format")
FORMATS = Path(__file__).parents[2] / "docs/formats.md"


def test_the_documentation_has_their_table():
    lines = [line.strip("|").split("|") for line in FORMATS.read_text(encoding="utf-8").splitlines()]
    start = lines.index([" quantity ", " unit ", " what it is "]) + 2
    shown = [tuple(cell.strip(" `") for cell in row) for row in lines[start : lines.index([""], start)]]
    with_light = [", with `--stokes" if q.takes_light else "" for q in mmbrdf.quantities()]
    assert shown == [(q.name, q.unit, q.meaning + light) for q, light in zip(mmbrdf.quantities(), with_light)]


def test_the_program_has_their_columns_keys_and_lines(program, ptfe):
    names = [q.name for q in mmbrdf.quantities()]
    header, row = program("analyze", *QUESTION, "csv").splitlines()
    columns = dict(zip(header.split(","), row.split(",")))
    behind = header.split(",")[header.split(",").index("u_f44") + 1 :]
    assert behind == [column for name in names for column in (name, "u_" + name)] + ["realizable", "estimable"]
    keys = json.loads(program("analyze", *QUESTION, "json"))["quantities"]
    assert list(keys) == names
    for name, analyzed in ptfe.analyze(532, 45, 0, 30, 180, stokes=[1, 0, 0, -1]).items():
        assert float(columns[name]) == keys[name]["value"] == analyzed.value
        assert float(columns["u_" + name]) == keys[name]["uncertainty"] == analyzed.u


def test_the_program_explains_them(program):
    text, page = program("analyze", "--help"), program("analyze", *QUESTION, "text")
    for q in mmbrdf.quantities():
        unit, light = f", in {q.unit}" if q.unit else "", " (with --stokes)" if q.takes_light else ""
        assert f"  {q.name:24}{q.meaning}{unit}{light}\n" in text
        line = next(line for line in page.splitlines() if line.startswith(q.name + " "))
        assert line.endswith(" " + q.unit if q.unit else line.split()[-1]), line
