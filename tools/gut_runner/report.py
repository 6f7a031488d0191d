#!/usr/bin/env python3
"""Reads what the parts of a run left behind, says what failed and why, and exits with the verdict.

A part is a folder with exit_code, stdout.log, stderr.log and (but for the import) results.json.
"""
import argparse
import json
import pathlib
import re
import sys
import xml.etree.ElementTree as xml

ERROR = re.compile(r"^(?:\x1b\[[0-9;]*m)*(?:USER )?(?:SCRIPT )?ERROR: ")
BEGIN, END = "[gut_runner] begin", "[gut_runner] end"
RUNNERS = {"ours": "ours", "gut": "GUT "}


class Report:
    """The tests that ran, and what went wrong beside them."""

    def __init__(self) -> None:
        self.runners: list[str] = []
        self.suites: list[dict] = []
        self.failures: list[str] = []

    def count(self, *states: str) -> int:
        return sum(test["status"] in states for suite in self.suites for test in suite["tests"])


def noise_patterns(path: pathlib.Path) -> list[re.Pattern]:
    lines = (line.strip() for line in path.read_text(encoding="utf-8").splitlines())
    return [re.compile(line) for line in lines if line and not line.startswith("#")]


def errors_outside(log: str, noise: list[re.Pattern]) -> list[str]:
    """Error lines, with the place that follows, from before the first test and after the last."""
    found, inside, lines = [], False, log.splitlines()
    for number, line in enumerate(lines):
        if line.startswith((BEGIN, END)):
            inside = line.startswith(BEGIN)
        elif not inside and ERROR.match(line) and not any(pattern.search(line) for pattern in noise):
            place = lines[number + 1].strip() if number + 1 < len(lines) else ""
            found.append(f"{line} [{place}]")
    return found


def last_started(folder: pathlib.Path) -> str:
    lines = (folder / "stdout.log").read_text(encoding="utf-8", errors="replace").split("\n")
    return " ".join(line.strip() for line in lines[-4:] if line.strip())


def read_part(folder: pathlib.Path, kind: str, noise: list[re.Pattern], report: Report) -> None:
    name = folder.name
    code = int((folder / "exit_code").read_text(encoding="utf-8"))
    log = (folder / "stderr.log").read_text(encoding="utf-8", errors="replace")
    results = folder / "results.json"
    report.failures += [f"{name}: {error}" for error in errors_outside(log, noise)]
    if code in (124, 137):
        report.failures.append(f"{name}: took too long and was stopped; its last output: {last_started(folder)}")
    elif code != 0 and not (kind == "gut" and code == 1 and results.exists()):  # GUT's own word for failing tests
        report.failures.append(
            f"{name}: Godot ended with exit code {code}; its last output: {last_started(folder)}; see {folder}/stderr.log"
        )
    if results.exists():
        data = json.loads(results.read_text(encoding="utf-8"))
        report.runners.append(data["runner"])
        report.suites += data["suites"]
        report.failures += [f"{name}: {failure}" for failure in data["failures"]]
    elif name != "import" and code == 0:
        report.failures.append(f"{name}: ended without results")


def suite_title(suite: dict) -> str:
    return suite["path"] + (f":{suite['inner']}" if suite["inner"] else "")


def settle_skipped(report: Report) -> None:
    for suite in report.suites:
        if suite["skipped"]:
            for test in suite["tests"]:
                test["status"], test["messages"] = "pending", [suite["skipped"]]
        report.failures += [f"{suite_title(suite)}: {failure}" for failure in suite["failures"]]


def missing_files(project: pathlib.Path, report: Report) -> list[str]:
    """Files that should hold tests and are nowhere in the results."""
    known = {suite["path"] for suite in report.suites if suite["tests"]}
    missing = []
    for room in ("unit", "integration", "editor"):
        for path in sorted((project / "tests" / room).rglob("test_*.gd")):
            name = path.relative_to(project).as_posix()
            if name not in known and not any(name in failure for failure in report.failures):
                missing.append(f"{name} yielded no test")
    return missing


def check_runner(kind: str, report: Report) -> None:
    for runner in report.runners:
        if not runner.startswith(RUNNERS[kind]):
            report.failures.append(f"asked for the runner '{kind}', but '{runner}' ran")


def print_suites(report: Report) -> None:
    print("\n---- suites")
    for suite in report.suites:
        states = [test["status"] for test in suite["tests"]]
        asserts = sum(test["asserts"] for test in suite["tests"])
        orphans = sum(test["orphans"] for test in suite["tests"])
        counts = f"{states.count('passed')} passed, {states.count('failed')} failed"
        counts += f", {states.count('pending')} skipped" if "pending" in states else ""
        counts += f", {orphans} orphans" if orphans else ""
        print(f"{suite_title(suite)}: {counts}, {asserts} asserts")


def print_failures(report: Report) -> None:
    for suite in report.suites:
        for test in suite["tests"]:
            if test["status"] == "pending":
                print(f"skipped: {suite_title(suite)}:{test['name']}: {' '.join(test['messages'])}")
            elif test["status"] == "failed":
                print(f"FAILED: {suite_title(suite)}:{test['name']}")
                for message in test["messages"]:
                    print("    " + message.replace("\n", "\n    "))
    for failure in report.failures:
        print("FAILED: " + failure.replace("\n", "\n    "))


def write_junit(path: pathlib.Path, report: Report) -> None:
    top = xml.Element("testsuites")
    for suite in report.suites:
        node = xml.SubElement(top, "testsuite", name=suite_title(suite), tests=str(len(suite["tests"])))
        for test in suite["tests"]:
            seconds = f"{test['seconds']:.6f}"
            case = xml.SubElement(node, "testcase", name=test["name"], classname=suite_title(suite), time=seconds)
            if test["status"] != "passed":
                tag = "skipped" if test["status"] == "pending" else "failure"
                xml.SubElement(case, tag, message=" ".join(test["messages"][:1])).text = "\n".join(test["messages"])
    if report.failures:
        node = xml.SubElement(top, "testsuite", name="the run", tests=str(len(report.failures)))
        for failure in report.failures:
            case = xml.SubElement(node, "testcase", name=failure.split("\n")[0], classname="the run")
            xml.SubElement(case, "failure", message=failure.split("\n")[0]).text = failure
    path.parent.mkdir(parents=True, exist_ok=True)
    xml.ElementTree(top).write(path, encoding="utf-8", xml_declaration=True)


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kind", choices=sorted(RUNNERS), required=True)
    for option in ("--reports", "--project", "--noise"):
        parser.add_argument(option, type=pathlib.Path, required=True)
    parser.add_argument("--filter", default="")
    parser.add_argument("--junit", type=pathlib.Path)
    arguments = parser.parse_args()

    report = Report()
    noise = noise_patterns(arguments.noise)
    for name in ("import", "game", "editor"):
        if (arguments.reports / name).is_dir():
            read_part(arguments.reports / name, arguments.kind, noise, report)
    settle_skipped(report)
    check_runner(arguments.kind, report)
    if not arguments.filter:
        report.failures += missing_files(arguments.project, report)
    if report.count("passed", "failed") == 0 and not report.failures:
        report.failures.append(f"no test ran{f' that matches {arguments.filter!r}' if arguments.filter else ''}")

    print_suites(report)
    print_failures(report)
    if arguments.junit:
        write_junit(arguments.junit, report)
    failed = report.count("failed") + len(report.failures)
    skipped = report.count("pending")
    print(f"\nrunner: {', '.join(sorted(set(report.runners))) or 'none'}")
    print(f"{report.count('passed')} passed, {failed} failed" + (f", {skipped} skipped" if skipped else ""))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
