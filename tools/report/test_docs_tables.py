#!/usr/bin/env python3
"""Tables of the documentation: what differs from the report, is missing from it or is shown nowhere is told, and written anew on request."""

from __future__ import annotations

import contextlib
import io
import tempfile
import unittest
from pathlib import Path

import docs_tables


class Tables(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.docs = Path(scratch.name)
        (self.docs / "report").mkdir()
        named = ""
        for name in docs_tables.TABLES:
            (self.docs / "report" / f"{name}.md").write_text('| a, m | b |\n|---|---|\n| 1 | |\n| "x", y | 2 |\n', encoding="utf-8")
            named += f"<!-- report/{name}.csv -->\n| old |\n\n"
        docs_tables.take(self.docs / "report")
        self.page = self.docs / "page.md"
        self.page.write_text(f"before\n\n{named}after\n", encoding="utf-8")

    def run_it(self, what: str) -> tuple[int, str]:
        told = io.StringIO()
        with contextlib.redirect_stdout(told):
            code = docs_tables.main(what, self.docs)
        return code, told.getvalue()

    def test_old_figures_are_told_and_written_anew(self) -> None:
        code, told = self.run_it("--check")
        self.assertEqual(code, 1)
        self.assertEqual(told.count("its table is not report/"), len(docs_tables.TABLES))
        self.assertEqual(self.run_it("--write"), (0, ""))
        self.assertEqual(self.run_it("--check"), (0, ""))
        text = self.page.read_text(encoding="utf-8")
        self.assertIn('| a, m | b |\n|---|---|\n| 1 | |\n| "x", y | 2 |\n\n', text)
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n"))
        self.assertNotIn("old", text)

    def test_a_table_that_is_not_there_and_one_that_is_not_shown_are_told(self) -> None:
        (self.docs / "report" / "late_geometry.csv").unlink()
        self.assertIn("there is no report/late_geometry.csv", self.run_it("--write")[1])
        self.page.write_text("nothing\n", encoding="utf-8")
        code, told = self.run_it("--check")
        self.assertEqual(code, 1)
        self.assertEqual(told.count("no document shows"), len(docs_tables.TABLES))


if __name__ == "__main__":
    unittest.main()
