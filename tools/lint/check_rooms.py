#!/usr/bin/env python3
"""Fails when a file reaches into a room that it may not use.

Native rooms and their rights are in cmake/rooms.txt; the rooms of Godot's side are below. Exit code 1 with one
`file:line: error: …` a violation, so that editors jump to it. Runs in every native build (--native).
"""

from __future__ import annotations

import argparse
import re
import sys
from dataclasses import dataclass
from pathlib import Path

# what CMake knows by the same name, and what each word lets a file include
LIBRARY_INCLUDES = {
    "eigen": re.compile(r"(unsupported/)?Eigen/"),
    "hidapi": re.compile(r"hidapi(/|\.h|_)"),
    "doctest": re.compile(r"doctest(/|\.h)"),
    "benchmark": re.compile(r"benchmark/"),
    "mujoco": re.compile(r"mujoco/"),
    "pinocchio": re.compile(r"(pinocchio|boost)/"),
    "box2d": re.compile(r"box2d/"),
    "engine": re.compile(r"gdextension_interface\.h$"),
    "protocol": re.compile(r"haptics_firmware/protocol\.h$"),
    "firmware": re.compile(r"haptics_firmware/"),
    "simd": re.compile(r"(imm|xmm|emm|smm|tmm|nmm|pmm|avx\w*|x86)intrin\.h$|arm_neon\.h$"),
}
# gdextension_interface.h has one reader
ONLY_IN = {"engine": "native/godot/binder"}
ENGINE_WORDS = re.compile(r"(?i:godot|gdextension)|\b(Variant|StringName|Node2D|RefCounted|GDCLASS|ClassDB)\b")
DOMAIN_WORDS = re.compile(r"(?i:pantograph|stiffness|penetration|friction)|\bhaptic_|\bHaptic[A-Z]")
INCLUDE = re.compile(r'^\s*#\s*(?:include|include_next|import)\s*([<"])([^>"]+)[>"]')
SOURCES = {".hpp", ".cpp", ".h", ".hh", ".cc", ".cxx", ".inl", ".ipp", ".c"}
# what the device's side may include: it has no operating system, and hardly a C library
FIRMWARE_INCLUDES = re.compile(r"(stddef|stdint|stdbool|limits|string)\.h$|haptics_firmware/")

# Godot's side: files below a folder may not name a path that starts with one of these
ADDON = "res://addons/haptics/"
SCENE_RULES = [
    ("addons/haptics/editor", ["res://addons/haptics_training/", "res://scenes/", "res://tests/", "res://tools/"]),
    # wires the editor part in and out, and nothing else does
    ("addons/haptics/plugin.gd", ["res://addons/haptics_training/", "res://scenes/", "res://tests/", "res://tools/"]),
    ("addons/haptics", [ADDON + "editor/", "res://addons/haptics_training/", "res://scenes/", "res://tests/", "res://tools/"]),
    ("addons/haptics_training", [ADDON + "editor/", "res://scenes/", "res://tests/", "res://tools/"]),
    ("scenes", [ADDON + "editor/", "res://tests/", "res://tools/"]),
]
# the one folder that reads Godot's physics
PHYSICS_ROOM = "addons/haptics/environment"
PHYSICS_WORDS = re.compile(r"\b(direct_space_state|PhysicsDirectSpaceState2D|PhysicsShapeQueryParameters2D|intersect_shape)\b")
SCENE_SOURCES = {".gd", ".tscn", ".tres", ".gdshader"}


@dataclass(frozen=True)
class Room:
    folder: str
    headers: str
    uses: frozenset[str]


def read_rooms(table: Path) -> list[Room]:
    """The rows of the table, deepest folder first."""
    rooms = []
    for number, line in enumerate(table.read_text().splitlines(), 1):
        if not line.strip() or line.startswith("#"):
            continue
        cells = [cell.strip() for cell in line.split("|")]
        if len(cells) != 4:
            sys.exit(f"{table}:{number}: error: a row has four cells: folder | target | headers | may use")
        rooms.append(Room(cells[0], cells[2], frozenset(cells[3].split())))
    return sorted(rooms, key=lambda room: -len(room.folder))


def home(path: str) -> str:
    """Where a file counts: public headers count as lying beside the sources of their room or part."""
    return re.sub(r"/include/haptics/[^/]+/", "/", path)


def room_of(rooms: list[Room], path: str) -> Room | None:
    place = home(path)
    return next((room for room in rooms if place.startswith(room.folder + "/")), None)


def top_folder(rooms: list[Room], room: Room) -> str:
    """The folder of the target that a room, or a part of one, is compiled in."""
    parents = [other.folder for other in rooms if room.folder.startswith(other.folder + "/") and other.headers != "-"]
    return min(parents, key=len) if parents else room.folder


def without_comments(text: str) -> str:
    """The text with comments blanked, its lines kept; strings stay."""
    pattern = re.compile(r'R"\((?s:.*?)\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])*\'|//[^\n]*|/\*(?s:.*?)\*/')

    def blank(match: re.Match[str]) -> str:
        piece = match.group(0)
        return piece if piece[0] in "R\"'" else re.sub(r"[^\n]", " ", piece)

    return pattern.sub(blank, text)


def judge_include(rooms: list[Room], room: Room, root: Path, path: str, quote: str, target: str) -> str | None:
    """What is wrong with an include, or nothing."""
    allowed = "may use " + (", ".join(sorted(room.uses)) or "nothing but std")
    if target.startswith("../") or "/../" in target:
        return f"'{target}' climbs out of its folder; write the path from the room's folder or <haptics/…>"
    if target.startswith("haptics/"):
        inside = target.removeprefix("haptics/")
        owners = [other for other in rooms if other.headers != "-" and inside.startswith(other.headers + "/")]
        if not owners:
            return f"<{target}> belongs to no room; rooms are in cmake/rooms.txt"
        owner = max(owners, key=lambda other: len(other.headers))
        if top_folder(rooms, owner) == top_folder(rooms, room):
            # a part may be used by its whole only where the table says so; the whole is open to its parts
            if owner.folder == room.folder or room.folder.startswith(owner.folder + "/") or owner.headers in room.uses:
                return None
            return None if owner.folder.startswith(room.folder + "/") else f"<{target}> is not open to {room.folder}, which {allowed}"
        return None if owner.headers in room.uses else f"<{target}> is in {owner.folder}; {room.folder} {allowed}"
    for word, pattern in LIBRARY_INCLUDES.items():
        if pattern.match(target):
            if word in ONLY_IN and not home(path).startswith(ONLY_IN[word] + "/"):
                return f"<{target}> is for {ONLY_IN[word]} only; {room.folder} {allowed}"
            return None if word in room.uses else f"<{target}> ({word}) is not open to {room.folder}, which {allowed}"
    if quote == '"':
        places = [(root / path).parent / target, root / top_folder(rooms, room) / target, root / room.folder / target]
        found = next((place for place in places if place.is_file()), None)
        if found is None:
            return f'"{target}" is not in this room; another room\'s headers are included as <haptics/…>'
        owner = room_of(rooms, found.resolve().relative_to(root.resolve()).as_posix())
        if owner is None or top_folder(rooms, owner) != top_folder(rooms, room):
            return f'"{target}" belongs to another room; include its public headers as <haptics/…>'
        return None
    if "/" in target or target.endswith(".h"):
        return None if "posix" in room.uses else f"<{target}> (posix) is not open to {room.folder}, which {allowed}"
    return None


def check_native(root: Path) -> tuple[list[str], int]:
    rooms = read_rooms(root / "cmake" / "rooms.txt")
    found = []
    files = sorted(path for path in (root / "native").rglob("*") if path.suffix in SOURCES)
    for file in files:
        path = file.relative_to(root).as_posix()
        room = room_of(rooms, path)
        if room is None:
            found.append(f"{path}:1: error: no room of cmake/rooms.txt has this folder")
            continue
        text = file.read_text(encoding="utf-8")
        for number, line in enumerate(without_comments(text).splitlines(), 1):
            include = INCLUDE.match(line)
            if include:
                problem = judge_include(rooms, room, root, path, include.group(1), include.group(2))
                if problem:
                    found.append(f"{path}:{number}: error: {problem}")
                continue
            engine_words_allowed = "engine" in room.uses or room.folder in ("native/tests", "native/bench")
            word = None if engine_words_allowed else ENGINE_WORDS.search(line)
            if word:
                found.append(f"{path}:{number}: error: '{word.group(0)}' is a word of the engine; {room.folder} knows none")
            word = None if "domain" in room.uses else DOMAIN_WORDS.search(line)
            if word:
                found.append(f"{path}:{number}: error: '{word.group(0)}' is a word of haptics; {room.folder} is generic")
    return found, len(files)


def check_firmware(root: Path) -> tuple[list[str], int]:
    found = []
    files = sorted(path for path in (root / "firmware").rglob("*") if path.suffix in SOURCES)
    for file in files:
        path = file.relative_to(root).as_posix()
        for number, line in enumerate(without_comments(file.read_text(encoding="utf-8")).splitlines(), 1):
            include = INCLUDE.match(line)
            if include is None:
                continue
            quote, target = include.groups()
            if target.startswith("../") or "/../" in target:
                found.append(f"{path}:{number}: error: '{target}' climbs out of its folder")
            elif quote == '"':
                if not (file.parent / target).is_file():
                    found.append(f'{path}:{number}: error: "{target}" is not in this folder')
            elif not FIRMWARE_INCLUDES.match(target):
                found.append(f"{path}:{number}: error: <{target}> is not open to firmware, which runs without an operating system")
    return found, len(files)


def check_scenes(root: Path) -> tuple[list[str], int]:
    found = []
    count = 0
    for top in ("addons/haptics", "addons/haptics_training", "scenes"):
        for file in sorted(path for path in (root / top).rglob("*") if path.suffix in SCENE_SOURCES):
            count += 1
            path = file.relative_to(root).as_posix()
            forbidden = next(rule[1] for rule in SCENE_RULES if path == rule[0] or path.startswith(rule[0] + "/"))
            for number, line in enumerate(file.read_text(encoding="utf-8").splitlines(), 1):
                if file.suffix == ".gd":
                    line = line.split("#", 1)[0] if line.lstrip().startswith("#") else line
                for place in forbidden:
                    if place in line:
                        found.append(f"{path}:{number}: error: {place} is not open to {path.rsplit('/', 1)[0]}")
                physics = PHYSICS_WORDS.search(line) if path.startswith("addons/") else None
                if physics and not path.startswith(PHYSICS_ROOM + "/"):
                    found.append(f"{path}:{number}: error: '{physics.group(0)}' reads Godot's physics; only {PHYSICS_ROOM} does")
    return found, count


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--root", type=Path, default=Path(__file__).resolve().parents[2])
    parser.add_argument("--native", action="store_true", help="only native/ and firmware/")
    parser.add_argument("--quiet", action="store_true", help="say nothing when all is well")
    options = parser.parse_args()
    found, count = check_native(options.root)
    more, files = check_firmware(options.root)
    found += more
    count += files
    if not options.native:
        more, files = check_scenes(options.root)
        found += more
        count += files
    for problem in found:
        print(problem, file=sys.stderr)
    if not options.quiet and not found:
        print(f"{count} files keep to their rooms")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
