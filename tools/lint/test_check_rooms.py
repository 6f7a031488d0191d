#!/usr/bin/env python3
"""Proves that check_rooms.py fails where it should, on small trees made for it, and that this repository passes no
violation by accident: each case plants one file into a tree that is otherwise clean."""

from __future__ import annotations

import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
CLEAN = {
    "native/core/include/haptics/core/types.hpp": "#pragma once\n#include <Eigen/Dense>\n#include <vector>\n",
    "native/core/contact/detail.hpp": "#pragma once\n",
    "native/core/contact/contact.cpp": '#include "detail.hpp"\n#include <haptics/core/types.hpp>\n// not Godot\'s contacts\n',
    "native/realtime/include/haptics/realtime/loop.hpp": "#include <haptics/core/types.hpp>\n#include <pthread.h>\n",
    "native/devices/include/haptics/devices/simulated/hand.hpp": "#include <haptics/core/types.hpp>\n",
    "native/devices/include/haptics/devices/hid/hid.hpp": "#pragma once\n",
    "native/devices/hid/hid.cpp": "#include <haptics/devices/hid/hid.hpp>\n#include <hidapi/hidapi.h>\n#include <dlfcn.h>\n",
    "native/devices/hid/codec.cpp": "#include <haptics_firmware/protocol.h>\n#include <haptics/realtime/loop.hpp>\n",
    "firmware/include/haptics_firmware/firmware.h": "#include <haptics_firmware/protocol.h>\n#include <stdint.h>\n",
    "firmware/wire.h": "#include <stddef.h>\n",
    "firmware/firmware.c": '#include <haptics_firmware/firmware.h>\n#include "wire.h"\n#include <string.h>\n',
    "native/godot/binder/include/haptics/binder/object.hpp": "#include <gdextension_interface.h>\nnamespace haptics {}\n",
    "native/godot/classes/server.cpp": "#include <haptics/binder/object.hpp>\n#include <haptics/realtime/loop.hpp>\n",
    "native/godot/classes/editor/plot.cpp": "#include <haptics/sweep/sweep.hpp>\n",
    "native/lab/sweep/include/haptics/sweep/sweep.hpp": "#include <haptics/devices/simulated/hand.hpp>\n",
    "native/lab/peers/include/haptics/peers/engines.hpp": "#pragma once\n",
    "native/lab/peers/mujoco/chain.cpp": "#include <haptics/peers/engines.hpp>\n#include <mujoco/mujoco.h>\n",
    "native/tests/core/contact_test.cpp": "#include <doctest/doctest.h>\n#include <haptics/core/types.hpp>\n",
    "addons/haptics/nodes/tool.gd": 'const A := preload("res://addons/haptics/resources/surface.gd")\n',
    "addons/haptics/environment/query.gd": "var space := get_world_2d().direct_space_state\n",
    "addons/haptics/plugin.gd": 'const P := preload("res://addons/haptics/editor/plugin.gd")\n',
}
# where, what, and the words that the message has to carry
VIOLATIONS = {
    "core_sees_realtime": ("native/core/a.cpp", "\n#include <haptics/realtime/loop.hpp>\n", "native/core/a.cpp:2: error: <haptics/realtime"),
    "core_sees_binder": ("native/core/a.hpp", "#include <haptics/binder/object.hpp>\n", "native/core/a.hpp:1: error"),
    "core_sees_posix": ("native/core/a.cpp", "#include <pthread.h>\n", "(posix)"),
    "core_sees_the_engine": ("native/core/a.cpp", "#include <gdextension_interface.h>\n", "native/godot/binder only"),
    "core_knows_godot": ("native/core/a.cpp", "int godot_version();\n", "a.cpp:1: error: 'godot' is a word of the engine"),
    "core_names_a_node": ("native/core/a.cpp", "struct Node2D;\n", "'Node2D'"),
    "climbing": ("native/core/contact/a.cpp", '#include "../contact/detail.hpp"\n', "climbs"),
    "another_room_by_quotes": ("native/realtime/a.cpp", '#include "contact/detail.hpp"\n', "not in this room"),
    "an_unknown_room": ("native/core/a.cpp", "#include <haptics/nowhere/a.hpp>\n", "belongs to no room"),
    "a_folder_without_a_room": ("native/attic/a.cpp", "", "no room of cmake/rooms.txt"),
    "realtime_sees_devices": ("native/realtime/a.cpp", "#include <haptics/devices/simulated/hand.hpp>\n", "may use"),
    "devices_see_realtime": ("native/devices/a.cpp", "#include <haptics/realtime/loop.hpp>\n", "may use"),
    "hidapi_outside_hid": ("native/devices/simulated/a.cpp", "#include <hidapi/hidapi.h>\n", "(hidapi)"),
    "hidapi_in_the_addon": ("native/godot/classes/a.cpp", "#include <hidapi/hidapi.h>\n", "(hidapi)"),
    "devices_see_the_protocol": ("native/devices/simulated/a.cpp", "#include <haptics_firmware/protocol.h>\n", "(protocol)"),
    "the_driver_ships_firmware": ("native/devices/hid/a.cpp", "#include <haptics_firmware/firmware.h>\n", "(firmware)"),
    "firmware_prints": ("firmware/a.c", "#include <stdio.h>\n", "without an operating system"),
    "firmware_sees_the_driver": ("firmware/a.c", "#include <haptics/devices/hid/hid.hpp>\n", "without an operating system"),
    "firmware_climbs": ("firmware/a.c", '#include "../native/core/a.hpp"\n', "climbs"),
    "a_c_file_in_core": ("native/core/a.c", "#include <pthread.h>\n", "(posix)"),
    "sweep_sees_hid": ("native/lab/sweep/a.cpp", "#include <haptics/devices/hid/hid.hpp>\n", "may use"),
    "binder_sees_core": ("native/godot/binder/a.cpp", "#include <haptics/core/types.hpp>\n", "may use"),
    "binder_sees_eigen": ("native/godot/binder/a.cpp", "#include <Eigen/Dense>\n", "(eigen)"),
    "binder_knows_the_domain": ("native/godot/binder/a.cpp", "struct HapticTool;\n", "is a word of haptics"),
    "classes_see_the_engine_raw": ("native/godot/classes/a.cpp", "#include <gdextension_interface.h>\n", "binder only"),
    "a_game_sees_the_sweep": ("native/godot/classes/a.cpp", "#include <haptics/sweep/sweep.hpp>\n", "may use"),
    "a_game_sees_another_engine": ("native/godot/classes/a.cpp", "#include <box2d/box2d.h>\n", "(box2d)"),
    "a_peer_sees_another": ("native/lab/peers/mujoco/a.cpp", "#include <pinocchio/multibody.hpp>\n", "(pinocchio)"),
    "a_test_in_core": ("native/core/a.cpp", "#include <doctest/doctest.h>\n", "(doctest)"),
    "a_spaced_include": ("native/core/a.cpp", "  #  include  <sys/mman.h>\n", "(posix)"),
    "an_include_after_a_comment": ("native/core/a.cpp", "/* why */ #include <sys/mman.h>\n", "(posix)"),
    "a_game_loads_the_editor": ("addons/haptics/nodes/a.gd", 'preload("res://addons/haptics/editor/x.gd")\n', "addons/haptics/editor/"),
    "a_scene_loads_the_editor": ("scenes/01/a.tscn", '[ext_resource path="res://addons/haptics/editor/x.gd"]\n', "addons/haptics/editor/"),
    "the_addon_loads_a_game": ("addons/haptics/nodes/a.gd", 'load("res://scenes/a.tscn")\n', "res://scenes/"),
    "physics_read_in_a_node": ("addons/haptics/nodes/a.gd", "get_world_2d().direct_space_state\n", "direct_space_state"),
}


class RoomCheck(unittest.TestCase):
    def setUp(self) -> None:
        self.root = Path(tempfile.mkdtemp())
        self.addCleanup(shutil.rmtree, self.root)
        (self.root / "cmake").mkdir()
        shutil.copy(REPOSITORY / "cmake" / "rooms.txt", self.root / "cmake")
        for path, text in CLEAN.items():
            self.plant(path, text)

    def plant(self, path: str, text: str) -> None:
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def check(self) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, str(REPOSITORY / "tools/lint/check_rooms.py"), "--root", str(self.root)]
        return subprocess.run(command, capture_output=True, text=True)

    def test_a_clean_tree_passes(self) -> None:
        result = self.check()
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"{len(CLEAN)} files", result.stdout)

    def test_each_violation_fails_with_its_place(self) -> None:
        for name, (path, text, words) in VIOLATIONS.items():
            with self.subTest(name):
                self.plant(path, text)
                result = self.check()
                self.assertEqual(result.returncode, 1, "not seen")
                self.assertIn(words, result.stderr)
                self.assertEqual(len(result.stderr.splitlines()), 1, result.stderr)
                (self.root / path).unlink()


if __name__ == "__main__":
    unittest.main()
