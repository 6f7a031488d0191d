#!/usr/bin/env python3
"""The report's page on small tables made for it: what is missing is said, what fails is marked, text is escaped."""

from __future__ import annotations

import json
import tempfile
import unittest
from pathlib import Path

import lab_html

LOOP = "coupling,rate_hz,delay_steps,encoder_m,stiffness_n_per_m,verdict\n"


class Page(unittest.TestCase):
    def setUp(self) -> None:
        scratch = tempfile.TemporaryDirectory()
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def write(self, name: str, text: str) -> None:
        (self.folder / name).write_text(text, encoding="utf-8")

    def test_missing_tables_are_said_to_be_missing(self) -> None:
        page = lab_html.page(self.folder, {})
        self.assertIn("host.csv is missing", page)
        self.assertEqual(page.count("Not measured in this run"), 7)
        self.assertIn("Absent: no benchmark of other engines", page)
        self.assertIn("peg and wall in other engines: not measured in this run", page)

    def test_pictures_are_inside_and_nothing_is_fetched(self) -> None:
        self.write("stability.csv", "verdict\nstable\n")
        page = lab_html.page(self.folder, {"stability": "QUJD"})
        self.assertIn('src="data:image/png;base64,QUJD"', page)
        self.assertNotIn("http", page)

    def test_text_is_escaped(self) -> None:
        self.write("host.csv", "what,value\nflags,<b>&\n")
        self.assertIn("&lt;b&gt;&amp;", lab_html.page(self.folder, {}))

    def test_a_missed_goal_of_the_plan_is_marked(self) -> None:
        columns = "scene,integrator,bodies,bodies_sent,ns_per_step_planned,ns_per_step_everything,times_cheaper,times_asked,largest_difference,left_out\n"
        self.write("plan.csv", columns + '"nothing near",exact,4,0,100,110,1.1,4,0,gravity\ncrowd,exact,64,0,10,200,20,15,0,x\nother,exact,1,1,1,1,1,0,0,x\n')
        page = lab_html.page(self.folder, {})
        self.assertIn('class="fail">nothing near, exact: 1.1 times cheaper, wanted 4: fail', page)
        self.assertIn('class="pass">crowd, exact: 20 times cheaper, wanted 15: pass', page)
        self.assertNotIn("other, exact", page)

    def test_extreme_cases_that_fail_come_first(self) -> None:
        columns = "case,result,figure,value,bound,not_finite_steps,force_over_limit,note\n"
        self.write("extreme.csv", columns + "calm,pass,m,1,2,0,0,\nwild,FAIL,m,inf,2,7,0,why\n")
        page = lab_html.page(self.folder, {})
        self.assertIn("1 of 2 pass; what fails comes first.", page)
        self.assertLess(page.index("wild"), page.index("calm"))
        self.assertIn('<td class="FAIL">FAIL</td>', page)

    def test_a_scene_comes_first_with_what_is_to_be_said_of_it(self) -> None:
        self.write("scene.csv", "what,value\nscene,res://a<b.tscn\nnote,it never touched anything\nleft out: gravity,gravity is zero\n")
        self.write("scene_recommended.csv", "experiment,motion,method,reason,repeats_within_m\nscene,smooth,penalty,why so,0.002\n")
        self.write("scene_plan.csv", "bodies,bodies_sent,bodies_without_place,ns_per_step_planned,ns_per_step_everything,times_cheaper,largest_difference_m\n9,2,3,10,50,5,0\n")
        columns = "wall,stiffness_n_per_m,damping_n_s_per_m,mass_kg,integrator,rate_hz,verdict,semi_implicit_floor_kg\n"
        self.write("scene_stability.csv", columns + "W,1,2,3,exact,500,stable,9\nW,1,2,3,exact,250,unstable,9\n")
        page = lab_html.page(self.folder, {})
        self.assertIn("<h2>Scene res://a&lt;b.tscn</h2>", page)
        self.assertLess(page.index("never touched"), page.index("Other engines"))
        for text in ("up to 0.002 m apart", "gravity: gravity is zero", "3 bodies had no place", "why so", "250 (unstable)"):
            self.assertIn(text, page)

    def test_what_other_engines_do_better_is_said_first_and_goals_are_judged(self) -> None:
        columns = "motion,error_asked_m,engine,method,steps_per_s,error_m,truth_difference_m,us_per_simulated_s,us_low,us_high\n"
        rows = "swift,1e-09,ours,Dormand-Prince 8,9,1e-10,1e-14,100,1,1\nswift,1e-09,ours,Euler,,1,1e-14,,,\n"
        rows += "swift,1e-09,mujoco 9,Runge-Kutta 4,9,1e-10,1e-14,2900,1,1\nswift,1e-09,quick 1,RK,9,1e-10,1e-14,50,1,1\n"
        rows += "swift,1e-09,slow 1,Euler,,1,1e-14,,,\nswift,1e-09,gone,missing: no network,,,,,,\n"
        self.write("peers_precision.csv", columns + rows)
        columns = "scene,way,setup,deepest_m,behind_hand_m,ns_per_step,ns_low,ns_high\n"
        self.write("peers_contact.csv", columns + 'peg,"ours, linearly implicit",x,2e-6,0,500,1,1\npeg,other,x,1e-6,0,900,1,1\n')
        page = lab_html.page(self.folder, {})
        self.assertIn("MuJoCo Runge-Kutta 4 takes 29 times as long as ours, wanted 30: fail", page)
        self.assertIn("2 µm deepest, wanted at most 3: pass", page)
        self.assertIn("500 ns a step, wanted at most 600: pass", page)
        self.assertIn("Better than ours: other overlaps by at most 1 µm where ours has 2 (peg)", page)
        self.assertNotIn("other takes", page)
        self.assertIn("gone is missing: no network", page)
        self.assertLess(page.index("Better than ours: quick 1, RK: 0.5 times"), page.index("wanted 30"))
        self.assertIn("not reached", page)

    def test_the_stiffest_wall_stops_at_the_first_that_is_not_stable(self) -> None:
        rows = "direct,500,1,1e-6,100,stable\ndirect,500,1,1e-6,1000,chattering\ndirect,500,1,1e-6,10000,stable\n"
        rows += "four_channel,500,1,1e-6,100,stable\nfour_channel,500,1,1e-6,1000,stable\nfour_channel,500,1,1e-6,10000,stable\n"
        # the same loop with another error of the mass
        rows += "four_channel,500,1,1e-6,10000,unstable\n"
        self.write("stability_device.csv", LOOP + rows)
        walls = lab_html.stiffest_walls(lab_html.read(self.folder / "stability_device.csv"))
        self.assertEqual([(w["wall"], w["times_direct"]) for w in walls], [("100", "1"), ("1e+03", "10")])

    def test_benchmarks_of_other_engines_become_a_table(self) -> None:
        def run(name: str, time: float) -> dict:
            return {"name": name, "run_name": name, "run_type": "iteration", "cpu_time": time, "time_unit": "ns"}

        runs = [run("dynamics/links:3", 40.0), run("peer_mujoco/links:3", 1000.0), run("peer_box2d/links:3", 30.0)]
        context = {"peer_mujoco": "3.1", "peer_mujoco_difference": "1e-12", "peer_pinocchio": "missing: no network"}
        self.write("bench.json", json.dumps({"context": context, "benchmarks": [*runs, {"name": "lost", "error_occurred": True}]}))
        lab_html.write_peers(self.folder / "bench.json", self.folder / "peers.csv")
        rows = lab_html.read(self.folder / "peers.csv")
        self.assertEqual([(r["engine"], r["times_ours"], r["result"]) for r in rows], [("MuJoCo", "25.0", "pass"), ("Box2D", "0.75", ""), ("Pinocchio", "", "")])
        page = lab_html.page(self.folder, {})
        self.assertIn("Faster than ours: Box2D at 3 links", page)


if __name__ == "__main__":
    unittest.main()
