#!/usr/bin/env python3
"""Copies project.godot for a staging project: enables our editor host, has our runner checked like our other scripts."""
import pathlib
import re
import sys

HOST = '"res://addons/gut_host/plugin.cfg"'


def enable_host(text: str) -> str:
    enabled = re.compile(r"^enabled=PackedStringArray\((.*)\)$", re.MULTILINE)
    if enabled.search(text):
        listed = ", ".join(filter(None, [enabled.search(text)[1], HOST]))
        return enabled.sub(f"enabled=PackedStringArray({listed})", text)
    return f"{text.rstrip()}\n\n[editor_plugins]\n\nenabled=PackedStringArray({HOST})\n"


def check_runner(text: str, kind: str) -> str:
    folders = {"res://addons/gut_host": 1, "res://addons/gut": 1 if kind == "ours" else 0}
    rules = "".join(f'"{folder}": {decision},\n' for folder, decision in folders.items())
    return text.replace("warnings/directory_rules={\n", "warnings/directory_rules={\n" + rules)


def drop_missing_main_scene(text: str, folder: pathlib.Path) -> str:
    """A staging project without our scenes (the self tests') would fail to load it."""
    main_scene = re.compile(r'^run/main_scene="res://(.*)"\n', re.MULTILINE)
    named = main_scene.search(text)
    return main_scene.sub("", text) if named and not (folder / named[1]).exists() else text


def main() -> None:
    kind, source, target = sys.argv[1:]
    path = pathlib.Path(target)
    text = check_runner(enable_host(pathlib.Path(source).read_text(encoding="utf-8")), kind)
    text = drop_missing_main_scene(text, path.parent)
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    main()
