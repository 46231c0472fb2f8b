"""Tests of what the programs of test/benchmark share, of the search for references, and of how planes are judged."""
import contextlib
import functools
import io
import json
import os
import pathlib
import subprocess
import sys
import unittest

from tool_run import BOX_FACES, ToolTest, box_corners, need, np, off

need("open3d", "scipy", "pcl_symmetry")
import bench
import planes
import real_frames
import references
import shapes

CORNERS = (box_corners(1, 1, 1) + 1) * (1.5, 1, 0.5)


def box():
    return bench.make_mesh(CORNERS, BOX_FACES)


@functools.cache
def references_of_box():
    return references.find_references(box())


def beast(side_leg):
    """A body with a head and four legs; with a fifth leg on one side, asymmetric."""
    parts = [((0, 0, 0), (4, 1.5, 1.5)), ((3.6, 0.35, 1), (1.6, 0.8, 1.2))]
    parts += [((x, y, -1.5), (0.5, 0.4, 1.6)) for x in (0.2, 3.2) for y in (0, 1.1)]
    parts += [((0.5, 1.4, 0.4), (1.2, 2.5, 0.8))] * side_leg
    vertices, polygons = [], []
    for low, size in parts:
        polygons += [[len(vertices) + i for i in face] for face in BOX_FACES]
        vertices += [*(low + size * (box_corners(0.5, 0.5, 0.5) + 0.5))]
    return bench.make_mesh(vertices, polygons)


def run_program(*words):
    """Exit code and standard error of a program of test/benchmark."""
    path = pathlib.Path(bench.__file__).parent / words[0]
    done = subprocess.run([sys.executable, path, *map(str, words[1:])], capture_output=True, text=True)
    return done.returncode, done.stderr.strip()


class Parts(unittest.TestCase):
    def test_calibration(self):
        self.assertAlmostEqual(bench.calibration([0.85] * 4, [1, 1, 1, 0])["error"], 0.1)
        self.assertAlmostEqual(bench.calibration([1, 0], [1, 0])["brier"], 0)

    def test_samples_lie_on_the_mesh_by_area(self):
        mesh = box()
        for even in (True, False):
            points = bench.sample(mesh, 22_000, np.random.default_rng(0), even)
            self.assertLess(mesh.distances((points - mesh.center) / mesh.diagonal).max(), 1e-5)
            self.assertAlmostEqual((points[:, 2] == 1).mean(), 6 / 22, delta=0.01)
        twice = [bench.sample(mesh, 5, np.random.default_rng(1)) for _ in range(2)]
        np.testing.assert_array_equal(*twice)

    def test_scans_see_the_near_side(self):
        mesh = box()
        scan = bench.scan(mesh, [0, 0, 1], np.random.default_rng(0), 2000)
        np.testing.assert_allclose(scan.rows[:, 2], 1, atol=1e-9)
        self.assertAlmostEqual(len(scan.rows) / 2000, 1, delta=0.05)
        np.testing.assert_allclose(scan.viewpoint, mesh.center + [0, 0, 2 * mesh.diagonal])
        pose = bench.random_pose(np.random.default_rng(1), mesh)
        turned = bench.scan(mesh, [0, 0, 1], np.random.default_rng(0), 2000, pose=pose)
        np.testing.assert_allclose(turned.rows, bench.moved(pose, scan.rows), atol=1e-9)

    def test_a_box_has_its_three_planes(self):
        found = references_of_box()
        self.assertEqual(found["kind"], "symmetric")
        normals = np.array([p["coefficients"][:3] for p in found["planes"]])
        np.testing.assert_allclose(np.sort(np.abs(normals).argmax(1)), [0, 1, 2])
        at_center = [planes.plane_row(p)[:3] @ found["center"] + p["coefficients"][3] for p in found["planes"]]
        np.testing.assert_allclose(at_center, 0, atol=0.01)

    def test_a_beast_has_one_plane_and_with_a_leg_on_one_side_none(self):
        found = references.find_references(beast(False))
        self.assertEqual((found["kind"], len(found["planes"])), ("symmetric", 1))
        self.assertGreater(abs(found["planes"][0]["coefficients"][1]), 0.999)
        self.assertEqual(references.find_references(beast(True))["kind"], "asymmetric")

    def test_a_bottle_has_an_axis(self):
        shape = shapes.round_shape("bottle", np.random.default_rng(0))
        found = references.find_references(shape.mesh)
        self.assertEqual((len(found["axes"]), len(found["planes"])), (1, 0))
        self.assertGreater(abs(found["axes"][0]["direction"][2]), 0.999)


class Judging(ToolTest):
    def setUp(self):
        super().setUp()
        self.pose = bench.random_pose(np.random.default_rng(3), box())
        self.truth = references.moved(references_of_box(), self.pose)

    def judged(self, *rows):
        keys = ("coefficients", "kind", "confidence")
        return planes.judge({**bench.NO_ANSWERS, "planes": [dict(zip(keys, row)) for row in rows]}, self.truth)

    def test_known_answers(self):
        first, second = (p["coefficients"] for p in self.truth["planes"][:2])
        moved = [*first[:3], first[3] + 0.03 * self.truth["diagonal"]]
        right = self.judged((first, "symmetry", 0.9), ((-np.array(second)).tolist(), "symmetry", 0.8))
        self.assertTrue(right["decided_right"] and right["called"])
        self.assertEqual((right["found"], right["references"], right["false"]), (2, 3, 0))
        self.assertEqual(self.judged((first, "symmetry", 0.9), (first, "symmetry", 0.8))["false"], 1)  # twice the same
        self.assertFalse(self.judged((moved, "symmetry", 0.9), (first, "symmetry", 0.8))["decided_right"])
        self.assertTrue(self.judged((moved, "possible", 0.4), (first, "symmetry", 0.8))["decided_right"])
        self.assertFalse(self.judged((first, "possible", 0.4))["called"])

    def test_answers_of_other_programs(self):
        self.write("a.txt", "1 0 0 -2 0.7\n0 1 0 0\n")
        found = bench.read_answers(self.folder, "a")["planes"]
        self.assertEqual([p["coefficients"] for p in found], [[1, 0, 0, -2], [0, 1, 0, 0]])
        self.assertTrue(bench.read_answers(self.folder, "b")["failed"])
        self.write("c.txt", "1 0 zero\n")
        self.assertRaises(bench.BadInput, bench.read_answers, self.folder, "c")

    def test_boxes_and_cylinders_of_frames(self):
        truth = {"shape": "cylinder", "axis": {"point": [1, 0, 5], "direction": [0, 0, 1]}, "center": [0, 0, 0], "extent": 2}
        through = {"planes": [{"coefficients": [0, 1, 0, 0], "kind": "symmetry"}]}
        beside = {"planes": [{"coefficients": [0, 1, 0, -0.1], "kind": "symmetry"}]}
        self.assertTrue(real_frames.judge(through, truth)["decided"])
        self.assertTrue(real_frames.judge(beside, truth)["wrong"])
        self.assertIsNone(real_frames.judge(through, truth)["sure"])
        through["planes"][0]["confidence"] = 0.9
        self.assertTrue(real_frames.judge(through, truth)["sure"])

    def test_axis_of_a_cylinder_that_lies(self):
        angles = np.random.default_rng(0).uniform(0, np.pi, 500)
        along = np.array([0.6, 0.8, 0])
        normals = np.outer(np.cos(angles), [-0.8, 0.6, 0]) + np.outer(np.sin(angles), [0, 0, 1])
        found = real_frames.level_axis(np.vstack([normals, np.tile(along, (100, 1))]), np.array([0.0, 0, 1]))
        self.assertGreater(abs(found @ along), 0.999)


class Runs(ToolTest):
    def test_an_interrupted_run_goes_on(self):
        arguments = bench.make_parser("").parse_args(["--json", f"{self.folder}/out.json", "--jobs", "1"])
        asked = []

        def square(x, _):
            asked.append(x)
            if x == 3 and len(asked) == 4:
                raise KeyboardInterrupt
            return x * x

        self.assertRaises(KeyboardInterrupt, bench.run, range(5), square, arguments)
        journal = self.folder / "out.json.journal"
        journal.write_text(journal.read_text() + '["4", 1')  # cut off while it was written
        self.assertEqual(bench.run(range(5), square, arguments), ([0, 1, 4, 9, 16], []))
        self.assertEqual(asked, [0, 1, 2, 3, 3, 4])
        bench.write_json(arguments, [1])
        self.assertEqual(sorted(os.listdir(self.folder)), ["out.json"])

    def test_a_failing_item_costs_itself(self):
        def divide(x, _):
            return 1 / x

        with contextlib.redirect_stderr(io.StringIO()) as told:
            results, left_out = bench.run([1, 0, 2], divide, bench.make_parser("").parse_args(["--jobs", "1"]))
        self.assertEqual((results, len(left_out)), ([1, 0.5], 1))
        self.assertIn("0: ZeroDivisionError", told.getvalue())

    def test_bad_input_is_one_sentence(self):
        self.assertEqual(run_program("planes.py", f"{self.folder}/none"), (1, f"planes.py: {self.folder}/none: must be a folder"))
        self.write("bad.cla", "PSB 1\n1 1\n")
        self.assertIn("bad.cla: is no class file", run_program("planes.py", self.folder, "--classes", f"{self.folder}/bad.cla")[1])
        self.write("bad.off", "OFF\n8 6 0\n0 0 0\n")
        self.write("box.off", off(CORNERS, BOX_FACES))
        rc, told = run_program("planes.py", self.folder, "--rows", "whole", "--points", "2000", "--json", f"{self.folder}/out.json")
        reason = "number of vertices = 8, the file is too short for them"
        self.assertEqual((rc, told), (0, f"{self.folder}/bad.off: is no mesh that can be read, {reason}"))
        result = json.loads(self.text("out.json"))
        self.assertEqual(result["groups"]["whole"]["decided_right"]["count"], 1)
