#!/usr/bin/env python3
"""The documentation's tables of figures come from the kept report. A comment before a table names its file:

    <!-- report/handle_stiffness.csv -->
    | a | b |

docs_tables.py --take FOLDER        makes CSV files of the Markdown tables in FOLDER
docs_tables.py --write DOCS         writes the tables of DOCS/*.md anew from DOCS/report/
docs_tables.py --check DOCS         says which of them differ, and which file of that kind no document shows
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path

NAMED = re.compile(r"^<!-- (report/[\w.]+\.csv) -->$")
# what tests write for the documents: the page of the report shows them too
TABLES = {
    "collision_methods": "Collision methods on the same random states (docs/physics.md)",
    "experiment1_settling": "Where the contact models of experiment 1 differ (docs/experiment1.md)",
    "experiment2_devices": "Experiment 2 with known and observed devices (docs/experiment2.md)",
    "handle_stiffness": "Stiffness of the handle against a hard wall (docs/control.md)",
    "late_geometry": "Late geometry against the truth (docs/late-geometry.md)",
}


def cells(line: str) -> list[str]:
    return [cell.strip() for cell in line.strip().strip("|").split("|")]


def take(folder: Path) -> None:
    for name in TABLES:
        source = folder / f"{name}.md"
        rows = [cells(line) for line in source.read_text(encoding="utf-8").splitlines() if line.startswith("|")]
        with open(folder / f"{name}.csv", "w", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerows(row for k, row in enumerate(rows) if k != 1)
        source.unlink()


def markdown(table: Path) -> list[str]:
    with open(table, newline="", encoding="utf-8") as file:
        rows = list(csv.reader(file))
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|" + "---|" * len(rows[0]))
    return [re.sub(r" {2,}", " ", line) for line in lines]


def renewed(document: Path, shown: set[str], problems: list[str]) -> str:
    """The document with its named tables as the report has them."""
    lines = document.read_text(encoding="utf-8").split("\n")
    out: list[str] = []
    k = 0
    while k < len(lines):
        out.append(lines[k])
        named = NAMED.match(lines[k])
        k += 1
        if not named:
            continue
        table = document.parent / named[1]
        if not table.exists():
            problems.append(f"{document.name}: there is no {named[1]}; make report KEEP=1 writes it")
            continue
        shown.add(table.stem)
        first = k
        while k < len(lines) and lines[k].startswith("|"):
            k += 1
        now = markdown(table)
        if lines[first:k] != now:
            problems.append(f"{document.name}: its table is not {named[1]}; tools/report/docs_tables.py --write {document.parent} writes it anew")
        out += now
    return "\n".join(out)


def main(what: str, folder: Path) -> int:
    if what == "--take":
        take(folder)
        return 0
    problems: list[str] = []
    shown: set[str] = set()
    for document in sorted(folder.glob("*.md")):
        text = renewed(document, shown, problems)
        if what == "--write":
            document.write_text(text, encoding="utf-8")
    problems = [p for p in problems if what == "--check" or "there is no" in p]
    problems += [f"no document shows report/{name}.csv" for name in TABLES if name not in shown]
    for problem in problems:
        print(problem)
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) != 3 or sys.argv[1] not in ("--take", "--write", "--check"):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], Path(sys.argv[2])))
