"""The Python module: shapes, units, errors, and that it says what the C++ functions say."""
import copy
import dataclasses
import functools
import inspect
import json
import os
import pickle
import pydoc
import re
import shutil
import subprocess
import sys
import threading
import time
import unittest
from pathlib import Path

import pcl_symmetry
from tool_run import BOX_FACES, ToolTest, box_corners, grid_faces, needs, np, rotation, triangles, turned
from tool_run import points_on_box as box


def has_pcl():
    return any(Path(pcl_symmetry.__file__).parent.glob("_recognition*.so"))


needs_pcl = unittest.skipUnless(has_pcl(), "the module was built without PCL")


def warned(words, function, *arguments, **options):
    """What a function returns that warns with these words, of the line that called it."""
    with unittest.TestCase().assertWarnsRegex(RuntimeWarning, words) as caught:
        result = function(*arguments, **options)
    assert caught.filename == __file__, caught.filename
    return result


def box_mesh():
    """A box of two by one by one with its faces as triangles."""
    return box_corners(1, 0.5, 0.5).astype(np.float32), triangles(BOX_FACES)


def count_planes(seed):
    return len(pcl_symmetry.planes(box(seed=seed)))


class Functions(unittest.TestCase):
    def test_volumes_without_an_answer_say_why(self):
        found = warned("^volume: all values are equal", pcl_symmetry.planes, volume=np.zeros((8, 8, 8)))
        self.assertEqual(found.reason, "volume: all values are equal")

    def test_planes_as_published_are_neither_added_nor_judged(self):
        found = pcl_symmetry.planes(box(num_points=2000), as_published=True)
        self.assertTrue(len(found))
        self.assertEqual({plane.kind for plane in found}, {"approximate"})
        self.assertTrue(np.isnan([(p.share, *p.share_interval, p.deviation) for p in found]).all(), "not measured")
        frame = pcl_symmetry.frame(box(num_points=2000), as_published=True)
        np.testing.assert_allclose(np.abs(frame.axes).max(axis=0), 1, atol=1e-3)

    def test_all_kinds_of_rows_give_the_same(self):
        class Like:
            def __array__(self, *arguments, **keywords):
                return box()

        points = box()
        padded = np.zeros((len(points), 5), dtype=np.float32)
        padded[:, :3] = points
        expected = [plane.coefficients for plane in pcl_symmetry.planes(points)]
        for same in (points.astype(np.float64), np.asfortranarray(points), padded[:, :3], points.tolist(), Like()):
            found = pcl_symmetry.planes(same)
            np.testing.assert_allclose([plane.coefficients for plane in found], expected, atol=1e-9)

    def test_rows_of_one_memory_are_read_as_their_copies(self):
        row, plane = np.broadcast_to(np.float32([1, 2, 3]), (1000, 3)), pcl_symmetry.ReflectionPlane([1, 0, 0], 0.0)
        for same, other in zip(pcl_symmetry.complete(row, plane), pcl_symmetry.complete(row.copy(), plane)):
            np.testing.assert_array_equal(same, other)

    def test_rows_that_are_not_finite_are_left_out(self):
        points = np.vstack([box(), [[np.nan, 0, 0]]]).astype(np.float32)
        masked = np.ma.masked_array(np.vstack([box(), [[9, 9, 9]]]), mask=~np.isfinite(points))
        for found in (pcl_symmetry.planes(points), pcl_symmetry.planes(masked)):
            self.assertEqual(len(found), 3)
            self.assertTrue(np.isnan(found.point_support(0)[-1]))
            self.assertFalse(np.isnan(found.point_support(0)[:-1]).any())

    def test_a_scan_of_a_block_has_its_rotations(self):
        """A square block, seen from above and one side. The evidence holds rotations of no confidence, too."""
        points = box((1.0, 1.0, 0.4), 40_000)
        viewpoint = np.array([1.6, 2.4, 3.2])
        seen = points[(points[:, 0] == 0.5) | (points[:, 1] == 0.5) | (points[:, 2] == np.float32(0.2))]
        found = pcl_symmetry.planes(seen, viewpoint=viewpoint, evidence=True)
        self.assertGreaterEqual(len(found.rotations), 1)
        turn = found.rotations[0]
        self.assertGreater(abs(turn.direction[2]), np.cos(np.radians(1)))
        self.assertLess(np.linalg.norm(turn.point[:2]), 0.02)
        self.assertTrue(turn.fold == 4 and turn.confidence >= 0.5 and turn.off <= 1.0, turn)
        turns = found.rotation_evidence
        self.assertGreaterEqual(len(turns), len(found.rotations))
        self.assertEqual(set(found.evidence["kind"]), {1})
        for turn in found.rotations:
            row = turns[np.argmin(np.abs(turns["confidence"] - turn.confidence))]
            self.assertEqual((row["fold"], row["off"], row["support"]), (turn.fold, turn.off, turn.support))
        self.assertEqual(len(pcl_symmetry.planes(seen, viewpoint=viewpoint).rotation_evidence), 0)
        self.assertEqual(pcl_symmetry.frame(seen, viewpoint=viewpoint).rotations[0].fold, 4)
        self.assertEqual([f(points).rotations for f in (pcl_symmetry.planes, pcl_symmetry.frame)], [[], []], "whole clouds have rotations()")

    def test_evidence_is_an_array_of_candidates(self):
        found = pcl_symmetry.planes(box(), evidence=True)
        evidence = found.evidence
        self.assertGreaterEqual(len(evidence), 3)
        for plane in found:
            gap = np.minimum(*(np.abs(evidence["coefficients"] - s * plane.coefficients).max(axis=1) for s in (1, -1)))
            self.assertLess(gap.min(), 0.01)
            row = evidence[gap.argmin()]
            self.assertEqual(row["kind"], 0)
            self.assertAlmostEqual(row["share"], plane.share, delta=0.01)
            self.assertGreater(row["confidence"], 0.5)
            self.assertEqual(row["terms"][0], 1)
        self.assertEqual([plane.confidence for plane in found], [p.confidence for p in pcl_symmetry.planes(box())])
        self.assertEqual((len(found.rotation_evidence), len(pcl_symmetry.planes(box()).evidence)), (0, 0))

    def test_data_without_an_answer_give_a_reason(self):
        """All of them warn with it, and their answer is empty."""
        s, plane = pcl_symmetry, pcl_symmetry.ReflectionPlane([1, 0, 0], 0.0)
        found = warned(r"points: they leave it open, a share of 0[.]\d+ to 1[.]00 for the best plane", s.planes, box(num_points=100))
        self.assertEqual((len(found), found.undecided, repr(found)[-12:]), (0, True, ", undecided)"))
        none = np.zeros((0, 3), np.float32)
        for number, points in ((5, box(num_points=5)), (12, box(num_points=12)), (1, np.ones((1000, 3))), (0, np.full((50, 3), np.nan)), (0, none)):
            words = f"{number} distinct point{'s' if number > 1 else ''}, at least 20 are needed" if number else "no finite point"
            of = {f.__name__: warned("points: " + words, f, points)
                  for f in (s.planes, s.frame, s.rotations, s.transform, s.describe, s.descriptors, s.local_symmetry, s.segment, s.viewpoints)}  # fmt: skip
            self.assertEqual((len(of["planes"]), of["planes"].reason), (0, words))
            for found, size in ((of["frame"], len(of["frame"].equivalent)), (of["rotations"], len(of["rotations"].discrete)),
                                (of["transform"], of["transform"].values.size)):  # fmt: skip
                self.assertEqual((found.reason, np.isnan(found.center).all(), size), (words, True, 0))
            self.assertFalse(of["frame"] or of["rotations"].name or of["transform"].radius or of["viewpoints"])
            self.assertTrue(len(of["local_symmetry"]) == len(points) and np.isnan(of["local_symmetry"]).all())
            self.assertEqual(of["segment"].tolist(), [-1] * len(points))
            if has_pcl():
                found = warned("source: " + words, s.register, points, box())
                self.assertEqual((found.converged, found.reason, found.poses), (False, "source: " + words, []))
                database = s.Database(":memory:")
                self.assertEqual([warned("points: " + words, ask, points) for ask in (database.match, database.recognize)], [[], []])
        for points in (none, np.full((50, 3), np.nan)):
            self.assertRaisesRegex(ValueError, "number of points = 0, must be > 0", s.symmetrize, points, plane)
            self.assertEqual([len(each) for each in plane.pairs(points)], 2 * [len(points)])
        warned(r"points: \d\d % of the points lie behind others as seen from the viewpoint given", s.planes, box(), viewpoint=(3, 2, 1))

    def test_wrong_options_are_named_with_their_rule_the_same_where_points_hold_no_answer(self):
        s, points = pcl_symmetry, box()
        complete, symmetrize = (functools.partial(f, plane=s.ReflectionPlane([1, 0, 0], 0.0)) for f in (s.complete, s.symmetrize))
        wrong = {ValueError: [
            (s.planes, {"tolerance = -1, must be": dict(tolerance=-1), "tolerance = 0.5, must be": dict(tolerance=0.5),
                        "threads = -1, must be >= 0": dict(threads=-1), "seed = -1, must be int, 0 to ": dict(seed=-1),
                        "viewpoint = here, must be": dict(viewpoint="here"), "method = guess, must be": dict(as_published=True, method="guess"),
                        "viewpoint = nan +0 +0, must be finite": dict(viewpoint=(np.nan, 0, 0)),
                        r"viewpoint = array of shape \(2, 3\), must be": dict(viewpoint=np.eye(3)[:2]),
                        "method = voting, must be convolution without as_published": dict(method="voting"),
                        "max_planes = 1099511627776, must be int, -2147483648 to 2147483647": dict(max_planes=2**40)}),
            (s.frame, {"threads = -1, must": dict(threads=-1), "viewpoint = here, must": dict(viewpoint="here")}),
            (s.rotations, {"tolerance = -1, must be in": dict(tolerance=-1), "tolerance = 2, must be in": dict(tolerance=2.0),
                           "max_feature = 2, must": dict(max_feature=2.0)}),
            (s.segment, {"method = cutting, must be merging or splitting": dict(method="cutting"), "parts = -1, must": dict(parts=-1)}),
            (s.transform, {"method = guess, must be": dict(method="guess"), "radius = -1, must be": dict(radius=-1),
                           "bins of theta = 0, must": dict(bins=(0, 2, 2)), "cells = 1, must": dict(cells=1),
                           "samples = -1, must": dict(samples=-1)}),
            (s.local_symmetry, {"scale = 2, must be in": dict(scale=2), "threads = -1, must": dict(threads=-1)}),
            (s.describe, {"threads = -1, must": dict(threads=-1)}),
            (s.descriptors, {"viewpoint = .*inf.*, must be finite": dict(viewpoint=(np.inf, 0, 0))}),
            (complete, {"threads = -1, must": dict(threads=-1)}),
            (symmetrize, {"threads = -1, must": dict(threads=-1), "half = both, must be mean, left or right": dict(half="both")}),
        ], TypeError: [
            (s.planes, {".*tolerence": dict(tolerence=0.1), "tolerance = 'small', must be float": dict(tolerance="small"),
                        "viewpoint = dict, must be": dict(viewpoint=dict(x=1)),
                        "seed = 'one', must be int, 0 to ": dict(seed="one"), "seed = 1.5, must be int, 0 to ": dict(seed=1.5),
                        r"seed = array of shape \(6000, 3\) and type float32, must be int": dict(seed=points),
                        r"seed = array of shape \(6000, 3\) and type float64, must be int": dict(seed=points.tolist())}),
            (s.complete, {r"plane = list, must be a plane, such as planes\(\)\[0\], or \(4,\) a, b, c, d": dict(plane=[1, 0, 0])}),
            (symmetrize, {"half = 3, must be str": dict(half=3)}), (s.transform, {"bins = 64, must be three whole numbers": dict(bins=64)}),
        ]}  # fmt: skip
        if has_pcl():
            database, scene = s.Database(":memory:"), functools.partial(s.scene, viewpoint=(0, 0, 9))
            register = functools.partial(s.register, target=points)
            wrong[ValueError] += [
                (register, {r"guess = .*, must be numbers of shape \(4, 4\)": dict(guess=np.eye(3)), "viewpoint": dict(source_viewpoint="here"),
                            "guess = another matrix, must be": dict(guess=np.ones((4, 4)))}),
                (lambda p, **options: s.register(points, p, **options), {"around.angle = -1, must": dict(around=(-1.0, 0.0))}),
                (lambda p, **options: s.register_all([p, p], **options), {"viewpoint = here": dict(viewpoint="here")}),
                (database.match, {"num_nearest = -1, must be >= 1": dict(num_nearest=-1), "num_nearest = 0, must be >= 1": dict(num_nearest=0),
                                  "viewpoint = there": dict(viewpoint="there")}),
                (database.recognize, {"min_confidence = 2, must": dict(min_confidence=2.0)}),
                (scene, {"min_points = 1, must": dict(min_points=1), "seed = -1, must be int, 0 to ": dict(seed=-1)}),
            ]  # fmt: skip
            wrong[TypeError] += [
                (database.match, {"num_nearest = 0.5, must": dict(num_nearest=0.5)}),
                (scene, {"database = 3, must be a Database": dict(database=3), "min_points = 30.5, must be int": dict(min_points=30.5)}),
            ]
        for error, (words, function, options) in ((error, (words, function, options)) for error, calls in wrong.items()
                                                  for function, each in calls for words, options in each.items()):
            said = set()
            for p in (points, points[:5], np.full((50, 3), np.nan)):
                with self.subTest(words), self.assertRaisesRegex(error, "(?s)^" + words) as raised:
                    function(p, **options)
                said.add(str(raised.exception))
            self.assertTrue(len(said) == 1 and len(said.pop()) < 200, words)

    def test_parameters_that_would_do_nothing_are_refused(self):
        s, points, mesh = pcl_symmetry, box(), Mesh(*box_mesh())
        plane, volume = s.ReflectionPlane([1, 0, 0], 0.0), np.random.default_rng(1).random((8, 8, 8))
        published, both = dict(as_published=True), dict(tolerance=0.02, absolute_tolerance=0.1)
        calls = [
            (s.planes, points, dict(spacing=(1, 1, 2)), dict(levels=(0, 1)), both),
            (s.planes, points, *({**published, **each} for each in (dict(max_planes=3), dict(max_points=100), dict(viewpoint=np.ones(3)),
                                                                    dict(indices=[1, 2, 3]), dict(approximate=True)))),
            (s.planes, None, *(dict(volume=volume, **each) for each in (dict(max_points=100), dict(viewpoint=(0, 0, 5)), dict(evidence=True)))),
            (s.planes, mesh, dict(indices=[1, 2, 3]), dict(normals=mesh.vertices)),
            (s.frame, mesh, dict(indices=[1, 2, 3])),
            (s.frame, points, {**published, "viewpoint": None}),
            (s.rotations, points, both),
            (s.segment, points, dict(depth=2), published, dict(method="splitting", parts=2, depth=2)),
            (s.segment, mesh, dict(faces=mesh.faces)),
            (s.sample_mesh, mesh, dict(faces=mesh.faces)),
            (s.symmetrize, mesh, dict(plane=plane, faces=mesh.faces)),
            (s.symmetrize, points, dict(plane=plane, cut=True)),
            (s.descriptors, points, dict(input_axes=True, viewpoint=None)),
            (s.local_symmetry, points, dict(spacing=(1, 1, 2))),
            (s.transform, points, dict(spacing=(1, 1, 2)), dict(center=(1, 0, 0)), dict(method="convolution", samples=5), dict(refined_share=0.5)),
            (s.transform, points, published),
        ]  # fmt: skip
        if has_pcl():
            calls.append((s.scene, points, dict(viewpoint=(0, 0, 9), min_name_confidence=0.9)))
        for function, shape, *options in calls:
            for each in options:
                with self.assertRaisesRegex(ValueError, "must be left out with", msg=(function, each)):
                    function(shape, **each)

    def test_faces_are_indices(self):
        vertices, faces = box_mesh()
        expected = pcl_symmetry.sample_mesh(vertices, faces)
        np.testing.assert_array_equal(pcl_symmetry.sample_mesh(vertices, faces.astype(float)), expected)  # of loadtxt()
        for wrong in (0.5, -1.0, np.nan, 2**32, 8, "a"):
            self.assertRaisesRegex(ValueError, "faces|vertex", pcl_symmetry.sample_mesh, vertices, np.where(faces == 0, wrong, faces))

    def test_other_python_threads_run_meanwhile(self):
        points, ticks = box(num_points=50_000), []
        timers = [threading.Timer(0.0005 * k, lambda: ticks.append(time.monotonic())) for k in range(1, 5)]
        for timer in timers:
            timer.start()
        pcl_symmetry.planes(points, threads=1)
        ended = time.monotonic()
        for timer in timers:
            timer.join()
        self.assertLess(max(ticks), ended)

    def test_frame_and_rotations_of_a_box(self):
        frame = pcl_symmetry.frame(box())
        np.testing.assert_allclose(np.abs(frame.axes).max(axis=0), 1, atol=1e-3)
        np.testing.assert_allclose(frame.transform @ np.append(frame.center, 1), [0, 0, 0, 1], atol=1e-9)
        self.assertEqual(frame.equivalent.shape[1:], (4, 4))
        self.assertEqual(frame.probable[0].axes.tolist(), frame.axes.tolist())
        self.assertTrue(0.5 < frame.probable[0].probability <= sum(other.probability for other in frame.probable) < 1)
        evidence = frame.evidence
        self.assertEqual((len(evidence), evidence["best"][0], evidence["value"][0], evidence["constant"].min()), (len(frame.probable), 1, 0, 1))
        rotations = pcl_symmetry.rotations(box())
        self.assertEqual((rotations.name, rotations.discrete.shape), ("D2", (3, 4, 4)))
        self.assertAlmostEqual(rotations.tolerance, 0.01 * np.linalg.norm([1, 0.7, 0.4]), delta=2e-4)

    def test_rotations_keep_to_the_tolerance_that_is_asked_for(self):
        nearly_square = box((1.0, 0.96, 0.4))
        self.assertEqual(pcl_symmetry.rotations(nearly_square, tolerance=0.005).name, "D2")
        self.assertEqual(pcl_symmetry.rotations(nearly_square, absolute_tolerance=0.05).name, "D4")

    def test_poses_under_the_symmetries_of_a_box(self):
        symmetries = pcl_symmetry.rotations(box())
        pose, corners = motion(), box_mesh()[0] * (0.5, 0.7, 0.4)
        same = symmetries.equivalents(pose)
        self.assertEqual(same.shape, (4, 4, 4))
        np.testing.assert_allclose(same[0], pose, atol=1e-12)
        for other in same:
            self.assertLess(symmetries.mssd(other, pose, corners), 1e-6)
            np.testing.assert_allclose(symmetries.canonical(other), symmetries.canonical(pose), atol=1e-9)
            np.testing.assert_allclose(symmetries.closest_to(other, pose), pose, atol=1e-9)
        shifted = pose + np.array([[0, 0, 0, 0.1], [0] * 4, [0] * 4, [0] * 4])
        self.assertAlmostEqual(symmetries.mssd(shifted, pose, corners), 0.1, places=6)

    def test_results_print_what_tells_most(self):
        found = pcl_symmetry.planes(box())
        self.assertRegex(repr(found), r"(?s)^Planes\(\[\n  Plane\(kind='symmetry', equation='.* x .* y .* z .* = 0', confidence=0\.9.*\),\n\]\)$")
        self.assertEqual(repr(pcl_symmetry.ReflectionPlane((0, 0, 2), 1)), "ReflectionPlane(equation='0 x + 0 y + 1 z - 0.5 = 0')")
        self.assertEqual(pcl_symmetry.ReflectionPlane((-0.6, 0, 0.8), 0).equation, "-0.6 x + 0 y + 0.8 z + 0 = 0")
        self.assertRegex(repr(pcl_symmetry.frame(box())), r"^Frame\(center=\[.*axes=\[\[.*revolution_axis=-1\)$")
        self.assertRegex(repr(pcl_symmetry.rotations(box())), r"^Rotations\(name='D2', center=.*confidence=")
        self.assertRegex(repr(pcl_symmetry.planes(lamp(), approximate=True)), r"^Planes\(\[\].*, approximate=[1-9]")
        if has_pcl():
            self.assertRegex(repr(pcl_symmetry.viewpoints(found)[0]), r"^View\(direction=\[.*score=")

    def test_half_a_box_is_completed(self):
        points = box()
        half = points[points[:, 0] > -0.1]
        plane = pcl_symmetry.ReflectionPlane((1, 0, 0), 0)
        added, rows = pcl_symmetry.complete(half, plane, viewpoint=None)
        self.assertGreater(len(added), 1000)
        np.testing.assert_allclose(added, half[rows] * (-1, 1, 1), atol=1e-6)
        self.assertLess(added[:, 0].max(), 0.0)
        axis, front = pcl_symmetry.Axis(np.array([0, 0, 1.0]), np.eye(3)[2], 1, 1, 1), np.array([5.0, 0, 0])
        across = pcl_symmetry.complete(half, plane, viewpoint=front)
        for place in (np.zeros(3), FarFromTheOrigin.SHIFT):  # the plane through the axis and across the view
            by_axis = pcl_symmetry.complete(half + place, dataclasses.replace(axis, point=axis.point + place), viewpoint=front + place)
            np.testing.assert_array_equal(by_axis[1], across[1])
            np.testing.assert_allclose(by_axis[0], across[0] + place, atol=1e-5)
        ball = pcl_symmetry.Center(np.zeros(3), 1, 1, 1)  # its plane is across the view, too
        np.testing.assert_array_equal(pcl_symmetry.complete(half, ball, viewpoint=front)[1], across[1])
        possible = dataclasses.replace(pcl_symmetry.planes(points)[0], normal=plane.normal, offset=0.0, kind="possible", confidence=0.3)
        doubt = f"points: {len(added)} are added across a plane that is only possible, of confidence 0.30"
        for cloud, by, words in (
            (half, possible, doubt),
            (np.concatenate([half, half * (-1, 1, 1)]), plane, "points: 0 are added: their reflections fall onto the points"),
            (np.full((9, 3), np.nan), plane, "points: 0 are added: no finite point"),
        ):
            warned(words, pcl_symmetry.complete, cloud, by, viewpoint=None)

    def test_parts_of_a_mesh_and_of_a_cloud(self):
        vertices, faces = box_mesh()
        self.assertEqual(len(pcl_symmetry.segment(vertices, faces)), len(faces))
        many = box(num_points=30_500)  # more than are drawn: the others follow the closest
        many[7] = np.nan
        np.testing.assert_array_equal(np.flatnonzero(pcl_symmetry.segment(many, parts=2) < 0), [7])
        warned("^parts = 1000, [0-9]+ possible: ", pcl_symmetry.segment, vertices, faces, parts=1000)
        split = pcl_symmetry.segment(vertices, faces, method="splitting", depth=1, as_published=True)
        self.assertLessEqual(len(set(split)), 2)

    def test_merges_of_a_mesh_follow_their_weights(self):
        vertices, faces = box_mesh()
        merging = pcl_symmetry.Merging(vertices, faces)
        self.assertEqual(len(merging.patches), len(faces))
        merges = merging.merges()
        for same in (faces.tolist(), [*faces[:-1].tolist(), tuple(faces[-1].tolist())]):
            self.assertEqual(pcl_symmetry.Merging(vertices, same).merges().tobytes(), merges.tobytes())
        self.assertEqual(len(merges), max(merging.patches))
        self.assertEqual((merges["cues"].shape[1], merges["cues"][0, 0]), (14, 1))
        self.assertTrue((merging.merges([1] + [0] * 13)["log_odds"] == 1).all())

    def test_descriptors_of_the_paper_have_its_sizes(self):
        prst, prsd, gedt = pcl_symmetry.descriptors(box(), input_axes=True)
        self.assertEqual((prst.shape, prsd.shape, gedt.shape), ((32, 32, 32), (32, 32), (32, 32, 32)))
        by_equation_1 = pcl_symmetry.descriptors(box(), input_axes=True, by_equation_1=True)[0]
        np.testing.assert_allclose(by_equation_1, np.sqrt((1 + prst**2) / 2), atol=1e-5)

    def test_the_map_has_its_maximum_at_a_plane_of_the_box(self):
        for method, options in (("sampled", {}), ("convolution", {}), ("rotational", {"refined_share": 0.02}), ("voting", {})):
            map_ = pcl_symmetry.transform(box(), (32, 64, 33), method=method, cells=32, **options)
            self.assertEqual(map_.values.shape, (32, 64, 33))
            best = np.unravel_index(map_.values.argmax(), map_.values.shape)
            self.assertGreater(np.abs(map_.plane(*map(int, best))[:3]).max(), 0.98)
            np.testing.assert_allclose(map_.prst() ** 2, (1 + map_.values) / 2, atol=1e-6, err_msg="equation 1")

    def test_the_map_covers_the_ball_that_is_given(self):
        map_ = pcl_symmetry.transform(box() + (1, 0, 0), (8, 16, 9), center=(1, 0, 0), radius=2.0, sigma=0.1)
        self.assertAlmostEqual(map_.sigma, 0.1)
        offsets = [plane[:3] @ (1, 0, 0) + plane[3] for plane in (map_.plane(0, 0, k) for k in range(9))]
        np.testing.assert_allclose(offsets, np.linspace(16 / 9, -16 / 9, 9), atol=1e-9)

    @needs_pcl
    def test_views_of_points_have_cameras_and_are_apart(self):
        for points in (lamp().astype(float) + (4e5, 5e6, 100.0), Mesh(*box_mesh())):
            views = pcl_symmetry.viewpoints(points, number=3, up=(0, 0, 2), separation=0.5)
            self.assertTrue(1 <= len(views) <= 3)
            self.assertEqual([v.score for v in views], sorted((v.score for v in views), reverse=True))
            directions = np.array([v.direction for v in views])
            self.assertTrue((directions[:, 2] > -0.06).all(), "from above")
            self.assertTrue(((directions @ directions.T)[np.triu_indices(len(views), 1)] < np.cos(0.5) + 1e-6).all())
            for view in views:
                np.testing.assert_allclose(view.pose[:3, 2], -view.direction, atol=1e-5)
                away = view.pose[:3, 3] - pcl_symmetry.frame(points).center
                self.assertGreater(away / np.linalg.norm(away) @ view.direction, 0.9)
            (worst,) = pcl_symmetry.viewpoints(points, worst=True)
            self.assertLess(worst.score, views[0].score)
        self.assertIsNone(pcl_symmetry.viewpoints(pcl_symmetry.planes(box()).planes)[0].pose)
        with self.assertWarnsRegex(RuntimeWarning, "points: .*at least 20"):
            self.assertEqual(pcl_symmetry.viewpoints(box()[:3]), [])

    @needs_pcl
    def test_a_body_of_revolution_is_seen_from_its_side_a_little_from_above(self):
        vertices, quads = turned([(0.3, 0), (0.5, 1)], 96)
        cone = pcl_symmetry.sample_mesh(vertices, triangles(quads), 6000)
        found = pcl_symmetry.planes(cone, approximate=True)
        self.assertEqual(len(found.axes), 1, "its planes through the axis are no planes of the list")
        best = pcl_symmetry.viewpoints(found)[0].direction
        self.assertLess(abs(best[2]), 0.8, "the axis is the strongest symmetry")


def lamp(num_points=4000, seed=1):
    """An object without symmetry: three boxes of different sizes, one on the other, off the middle."""
    parts = [box((1.0, 0.7, 0.2), num_points // 2, seed), box((0.2, 0.15, 0.9), num_points // 4, seed + 1)]
    parts.append(box((0.6, 0.3, 0.25), num_points // 4, seed + 2))
    offsets = [(0.0, 0.0, 0.0), (0.3, 0.1, 0.5), (0.1, 0.25, 1.0)]
    return np.concatenate([part + np.float32(offset) for part, offset in zip(parts, offsets)])


def motion(angle=2.0, translation=(3.0, -1.0, 0.5)):
    """A turn about (1, 2, 3) and a translation, (4, 4)."""
    return np.vstack([np.c_[rotation((1, 2, 3), angle), translation], (0, 0, 0, 1)])


def moved(points, T):
    return (points @ T[:3, :3].T + T[:3, 3]).astype(points.dtype)


class Mesh:
    """What Open3D and trimesh have in common."""

    def __init__(self, vertices, faces):
        self.vertices, self.faces = np.array(vertices, dtype=float), np.array(faces)


def bar(x=30.0, y=2.0, z=1.0):
    return Mesh((box_corners(1, 1, 1) + 1) / 2 * (x, y, z), triangles(BOX_FACES))


def bumped(rings, around, height, radius):
    """Vertices and faces of a spheroid of semi-axes 1, 0.8, 0.6 with a bump about (1, 0, 0); x -> -x maps the faces."""
    theta = np.pi * (np.arange(rings) + 0.5) / rings
    phi = 2 * np.pi * (np.arange(around) + 0.5) / around
    t, p = (a.ravel() for a in np.meshgrid(theta, phi, indexing="ij"))
    sphere, axes = np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=1), np.array([1, 0.8, 0.6])
    normals = sphere / axes / np.linalg.norm(sphere / axes, axis=1, keepdims=True)
    share = np.minimum(1, np.linalg.norm(sphere * axes - (1, 0, 0), axis=1) / radius)
    vertices = sphere * axes + 0.5 * height * (1 + np.cos(np.pi * share))[:, None] * normals
    quads = np.array(grid_faces(rings, around))[:, ::-1]
    k = np.arange(len(quads)) % around
    right = ((4 * k < around) | (4 * k >= 3 * around))[:, None]
    return vertices, triangles(np.where(right, quads, np.roll(quads, 1, axis=1)))


class Meshes(ToolTest):
    def test_a_page_shows_planes(self):
        page = pcl_symmetry.planes(box()).show(box())
        self.assertTrue("plane 3 (symmetry)" in page.html and page._repr_html_().startswith("<iframe"))
        self.assertEqual(len(json.loads(page.html.split('id="scene">')[1].split("</script>")[0])["panels"]), 3)
        page.save(self.folder / "page.html")
        self.assertEqual(self.text("page.html"), page.html)

    def test_symmetries_of_a_mesh_are_exact(self):
        offset = np.array([4e5, 5.4e6, 100.0])
        for shift in (np.zeros(3), offset):
            mesh = bar()
            mesh.vertices = mesh.vertices + shift
            center = shift + (15.0, 1.0, 0.5)
            found = pcl_symmetry.planes(mesh)
            self.assertEqual(len(found), 3)
            for plane in found:
                self.assertGreater(np.abs(plane.normal).max(), 1 - 1e-9)
                self.assertLess(abs(plane.distance(center)), 1e-4)
            group = pcl_symmetry.rotations(mesh)
            self.assertEqual(group.name, "D2")
            np.testing.assert_allclose(group.center, center, atol=1e-4)
            np.testing.assert_allclose(pcl_symmetry.frame(mesh).center, center, atol=1e-4)

    def test_a_square_bar_has_four_folds_at_any_tolerance(self):
        mesh = bar(y=1.0)
        for seed, tolerance in enumerate((0.0003, 0.001, 0.003, 0.01), 1):
            group = pcl_symmetry.rotations(mesh, tolerance=tolerance, seed=seed)
            self.assertEqual(group.name, "D4", tolerance)
            np.testing.assert_allclose(group.center, (15, 0.5, 0.5), atol=1e-4)
            turns = np.abs(group.discrete[:, :3, :3])
            self.assertLess(np.minimum(turns, abs(turns - 1)).max(), 1e-4, tolerance)

    def test_measures_a_bump_of_known_height(self):
        height, radius = 0.02, 0.5
        plain, faces = bumped(120, 240, 0.0, radius)
        vertices, _ = bumped(120, 240, height, radius)
        plane = pcl_symmetry.ReflectionPlane((1, 0, 0), 0.0)
        found = pcl_symmetry.symmetrize(vertices, plane, faces=faces)
        corners = vertices[faces]
        areas = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
        # Outside on the side of the bump, inside on the other one.
        across = np.abs(plain[faces].mean(axis=1)[:, :1]) * (1, 0, 0) + plain[faces].mean(axis=1) * (0, 1, 1)
        share = np.minimum(1, np.linalg.norm(across - (1, 0, 0), axis=1) / radius)
        expected = (areas * height * (1 + np.cos(np.pi * share))).sum() / 2 / areas.sum()
        self.assertAlmostEqual(found.mean_asymmetry, expected, delta=0.01 * expected)
        self.assertAlmostEqual(found.greatest_asymmetry, height, delta=0.01 * height)
        self.assertAlmostEqual(found.asymmetry[vertices[:, 0].argmax()], height, delta=0.02 * height)
        self.assertAlmostEqual(found.asymmetry[vertices[:, 0].argmin()], -height, delta=0.02 * height)
        self.assertLess(found.deviation, 1e-5 * 2)
        np.testing.assert_array_equal(found.faces, faces)
        cut = pcl_symmetry.symmetrize(vertices, plane, faces=faces, cut=True)
        again = pcl_symmetry.symmetrize(cut.points, plane.coefficients, faces=cut.faces)
        self.assertLess(max(again.deviation, again.greatest_asymmetry), 1e-6 * 2)
        self.assertEqual(cut.faces.max(), len(cut.points) - 1)
        self.assertEqual(cut.deviation, 0.0)
        same = pcl_symmetry.symmetrize(plain, plane, faces=faces)
        np.testing.assert_allclose(same.points, plain, atol=1e-5)
        # What has no other side stays.
        hole = pcl_symmetry.symmetrize(plain, plane, faces=faces[plain[faces[:, 0], 0] < 0.9])
        left = plain[:, 0].argmin()
        self.assertTrue(np.isnan(hole.asymmetry[left]))
        np.testing.assert_allclose(hole.points[left], plain[left], atol=1e-6)
        cloud = pcl_symmetry.sample_mesh(vertices, faces, 20_000)
        mean = pcl_symmetry.symmetrize(cloud, plane)
        self.assertAlmostEqual(mean.greatest_asymmetry, height, delta=0.1 * height)
        self.assertAlmostEqual(mean.points[:, 0].max(), 1.01, delta=0.001)

    def test_what_is_made_symmetric_is_its_own_reflection(self):
        """Vertices that the plane maps onto each other, with a bump on the right side: half of it on both, none, or all of it."""
        vertices, faces = bumped(100, 200, 0.05, 0.6)
        plane = pcl_symmetry.ReflectionPlane((1, 0, 0), 0.0)
        for half, reach in (("mean", 1.025), ("left", 1.0), ("right", 1.05)):
            found = pcl_symmetry.symmetrize(vertices, plane, half, faces=faces)
            index, distance = plane.pairs(found.points)
            self.assertLess(distance.max(), 1e-5 * 2, "of the diameter")
            np.testing.assert_array_equal(index[index], np.arange(len(index)))
            np.testing.assert_allclose([found.points[:, 0].min(), found.points[:, 0].max()], [-reach, reach], atol=1e-3)

    def test_a_half_and_its_reflection_fit_whatever_the_triangles(self):
        """A ball whose triangles the plane x = 0.3 z does not map onto each other."""
        vertices, faces = bumped(100, 200, 0.0, 0.6)
        plane = pcl_symmetry.ReflectionPlane((1, 0, -0.3), 0.0)
        for half in ("left", "right"):
            cut = pcl_symmetry.symmetrize(vertices, plane, half, faces=faces, cut=True)
            self.assertLess(plane.pairs(cut.points)[1].max(), 1e-6)
            source = vertices[cut.rows]
            off = [np.linalg.norm(points - source, axis=1) for points in (cut.points, plane.reflect(cut.points))]
            self.assertLess(np.minimum(*off).max(), 0.04, "an edge")
            edges = np.sort(cut.faces[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
            _, counts = np.unique(edges, axis=0, return_counts=True)
            self.assertEqual((counts == 1).sum(), 2 * 200, "the holes at the poles, or their reflections")

    def test_a_vase_with_noise_has_its_profile(self):
        rng, radius = np.random.default_rng(4), lambda height: 0.25 + 0.1 * np.sin(2 * np.pi * height) - 0.05 * height
        angle, height = rng.uniform(0, 2 * np.pi, 20_000), rng.uniform(0, 1, 20_000)
        local = np.stack([radius(height) * np.cos(angle), radius(height) * np.sin(angle), height], axis=1)
        diameter = 1.1
        points = local @ motion()[:3, :3].T + (1, 2, 3) + rng.normal(size=local.shape) * 0.01 * diameter
        axis = pcl_symmetry.Axis(np.array([1.0, 2.0, 3.0]), motion()[:3, 2], 1.0, 1.0, 1.0)
        found = axis.profile(points)
        at = np.linspace(0, 1, 4001)
        distance = np.hypot(found.radius[:, None] - radius(at), found.height[:, None] - at).min(axis=1)
        wall = abs(found.height - 0.5) < 0.45
        self.assertGreater(wall.sum(), 60)
        self.assertLess(np.sqrt(np.mean(distance[wall] ** 2)) / diameter, 0.002)
        np.testing.assert_allclose(np.median(found.spread), 0.01 * diameter, rtol=0.2)
        steps = np.hypot(np.diff(found.radius), np.diff(found.height))
        self.assertLess(steps.max(), 0.1, "in order along the curve")

    def test_a_half_of_a_cloud_is_reflected_whatever_is_not_finite(self):
        left = pcl_symmetry.symmetrize(box(), pcl_symmetry.ReflectionPlane((1, 0, 0), 0.0), "left")
        half = len(left.points) // 2
        np.testing.assert_allclose(left.points[half:] * (-1, 1, 1), left.points[:half])
        np.testing.assert_array_equal(left.rows[half:], left.rows[:half])
        holes = np.insert(box(), [0, 5, 6000], np.nan, axis=0)  # as depth cameras have them
        same, finite = pcl_symmetry.symmetrize(holes, pcl_symmetry.ReflectionPlane((1, 0, 0), 0.0), "left"), np.isfinite(holes[:, 0])
        np.testing.assert_array_equal(same.points, left.points)
        np.testing.assert_array_equal(same.rows, np.flatnonzero(finite)[left.rows])
        np.testing.assert_array_equal(same.asymmetry[finite], left.asymmetry)
        self.assertTrue(np.isnan(same.asymmetry[~finite]).all())


@needs_pcl
class WithPCL(ToolTest):
    def test_registers_from_any_pose_and_far_from_the_origin(self):
        source, truth, unseen = lamp(), motion(), dict(source_viewpoint=None, target_viewpoint=None)
        target = moved(lamp(seed=5), truth)
        found = pcl_symmetry.register(source, target, **unseen)
        self.assertLess(np.abs(found.transform - truth).max(), 0.02)
        self.assertGreater(found.score.merit, 0.5)
        np.testing.assert_array_equal(found.poses[0][0], found.transform)
        self.assertEqual([found.poses[0][1].merit, found.merit], 2 * [found.score.merit])
        self.assertAlmostEqual(found.score.merit, found.score.support - found.score.conflict / 2)
        self.assertEqual(found.covariance.shape, (6, 6))
        self.assertTrue((np.linalg.eigvalsh(found.covariance) > 0).all())
        self.assertRegex(repr(found), r"^Registration\(transform=\[\[.*confidence=0\.[89]")
        tracked = pcl_symmetry.register(source, target, guess=truth, around=(0.2, 0.1), **unseen)
        self.assertLess(np.abs(tracked.transform - truth).max(), 0.02)
        shift_source, shift_target = np.array([4e5, 5.4e6, 100.0]), np.array([-3e5, 2e6, 0.0])
        far = pcl_symmetry.register(source + shift_source, target + shift_target, **unseen)
        self.assertTrue(found.converged and far.converged)
        x = source[:10].astype(float)
        np.testing.assert_allclose(moved(x + shift_source, far.transform), moved(x, found.transform) + shift_target, atol=1e-2)

    def test_a_database_finds_what_it_holds(self):
        path = self.folder / "models.db"
        self.assertRaisesRegex(FileNotFoundError, "models.db: no such database; create=True makes one", pcl_symmetry.Database, path)
        self.assertFalse(path.exists())
        with self.assertRaisesRegex(FileNotFoundError, "none/models.db: cannot be made: No such file or directory"):
            pcl_symmetry.Database(path.parent / "none" / "models.db", create=True)
        truth = motion()
        seen = moved(lamp(seed=9), truth)
        with pcl_symmetry.Database(str(path), create=True, unit="m") as database:
            for name, points in dict(box=box(), lamp=lamp(), plate=box((1.0, 0.9, 0.1))).items():
                database.add(name, points)
            self.assertEqual((len(database), database.names, list(database)), (3, *2 * [["box", "lamp", "plate"]]))
            self.assertIn("lamp", database)
            matches = database.match(seen, viewpoint=None)
            self.assertEqual(matches[0].name, "lamp")
            self.assertEqual(sorted(match.distance for match in matches), [match.distance for match in matches])
            recognized = database.recognize(seen, viewpoint=None)
            self.assertEqual(recognized[0].name, "lamp")
            self.assertRegex(repr(recognized[0]), r"^Recognized\(name='lamp', confidence=")
            self.assertRegex(repr(database), r"^Database\('.*models.db', models=3\)$")
            self.assertEqual(database.recognize(seen, viewpoint=None, min_confidence=1.0), [])
            self.assertLess(np.abs(recognized[0].transform @ truth - np.eye(4)).max(), 0.05)
            self.assertEqual(database.cloud("box").shape[1], 3)
            np.testing.assert_array_equal(database["box"], database.cloud("box"))
            database.remove("plate")
            self.assertEqual(pcl_symmetry.Database(path).names, ["box", "lamp"])
            for unknown in (database.cloud, database.remove, database.__getitem__):
                self.assertRaisesRegex(KeyError, "nothing", unknown, "nothing")
            database.add("box", lamp())
            self.assertEqual(len(database), 2, "a model of the same name is replaced")
        with self.assertRaisesRegex(ValueError, "models.db: the database was closed"):
            database.names
        self.assertRaisesRegex(OSError, "wrong.db", pcl_symmetry.Database, self.write("wrong.db", "no database at all"))

    def test_many_models_are_stored_at_once(self):
        database, shares = pcl_symmetry.Database(":memory:"), []
        models = {"box": box(), "flat": np.zeros((50, 3)), "lamp": lamp(), "words": b"none", "plate": box((1.0, 0.9, 0.1))}
        report = database.build(models, progress=shares.append)
        self.assertEqual((report.num_added, report.cancelled), (3, False))
        self.assertEqual([name for name, _ in report.failures], ["flat", "words"])
        self.assertRegex(report.failures[1][1], "points")
        self.assertEqual(database.names, ["box", "lamp", "plate"])
        self.assertEqual(database.match(lamp(seed=9), viewpoint=None)[0].name, "lamp")
        self.assertEqual((sorted(shares), shares[-1]), (shares, 1.0))
        self.assertRegex(repr(report), r"^BuildReport\(num_added=3, ")

        stopped = pcl_symmetry.Database(":memory:", threads=1).build(models.items(), progress=lambda share: False)
        self.assertEqual((stopped.num_added, stopped.cancelled), (1, True))
        self.assertRaises(ZeroDivisionError, pcl_symmetry.Database(":memory:").build, models, progress=lambda share: 1 / 0)

    def test_parts_become_one_database(self):
        """Its contents are those of one that was built at once: test_recognition."""
        parts = [self.folder / f"{i}.db" for i in range(3)]
        for i, part in enumerate(parts):
            pcl_symmetry.Database(part, create=True, unit="m").add(f"box {i}", box((1, 0.7, 0.1 + 0.3 * i)))
        merged = pcl_symmetry.Database(self.folder / "merged.db", create=True)
        self.assertEqual((merged.merge(parts), len(merged)), (3, 3))
        self.assertRaisesRegex(OSError, "model 'box 0' is also in", merged.merge, parts[:1])
        self.assertEqual((len(merged), pcl_symmetry.Database(parts[0], unit="m").unit), (3, "m"))


class FarFromTheOrigin(unittest.TestCase):
    SHIFT = np.array([4.5e5, 5.4e6, 120.0])  # meters, as of UTM

    def test_double_coordinates_give_the_same_planes_and_frames(self):
        near, far = box().astype(float), box() + self.SHIFT
        found, moved = pcl_symmetry.planes(near), pcl_symmetry.planes(far)
        self.assertEqual(len(found), len(moved))
        for a, b in zip(found, moved):
            self.assertLess(a.angle_to(b), 1e-3)
            self.assertAlmostEqual(b.distance(self.SHIFT), a.distance(np.zeros(3)) * np.sign(a.normal @ b.normal), delta=2e-3)
        frame = pcl_symmetry.frame(far)
        np.testing.assert_allclose(frame.center, self.SHIFT, rtol=0, atol=5e-3)
        np.testing.assert_allclose(frame.transform @ np.append(frame.center, 1), [0, 0, 0, 1], atol=1e-6)
        group = pcl_symmetry.rotations(far)
        for half in group.discrete:
            np.testing.assert_allclose(half @ np.append(self.SHIFT, 1), np.append(self.SHIFT, 1), atol=5e-3)
        map_ = pcl_symmetry.transform(far, (16, 32, 17))
        best = np.unravel_index(map_.values.argmax(), map_.values.shape)
        self.assertLess(abs(map_.plane(*best) @ np.append(self.SHIFT, 1)), 0.1)

    def test_double_coordinates_give_the_same_of_everything_else(self):
        near, far = box().astype(float), box() + self.SHIFT
        for function in (pcl_symmetry.describe, pcl_symmetry.descriptors, lambda points: pcl_symmetry.local_symmetry(points[::40], 1.0),
                         lambda points: pcl_symmetry.segment(points[:2000])):  # fmt: skip
            for a, b in zip(function(far), function(near), strict=True):
                np.testing.assert_allclose(a, b, atol=1e-5)
        plane, moved = (pcl_symmetry.ReflectionPlane((1, 0, 0), offset) for offset in (0.0, self.SHIFT[0]))
        half = near[near[:, 0] > -0.1]
        added, _ = pcl_symmetry.complete(half, plane, viewpoint=None)
        far_added, _ = pcl_symmetry.complete(half + self.SHIFT, moved, viewpoint=None)
        np.testing.assert_allclose(far_added, added + self.SHIFT, rtol=0, atol=1e-6)
        np.testing.assert_array_equal(moved.pairs(far)[0], plane.pairs(near)[0])

    def test_coarse_float32_coordinates_are_warned_of(self):
        far = (box() + self.SHIFT).astype(np.float32)
        warned("points: float32 coordinates up to 5.4e.* leave 0 digits of an extent", pcl_symmetry.planes, far)


class Results(unittest.TestCase):
    def test_compare_copy_and_pickle(self):
        points = box()
        results = [pcl_symmetry.planes(points), pcl_symmetry.frame(points), pcl_symmetry.rotations(points)]
        results += [results[0][0], pcl_symmetry.transform(points, (8, 8, 9)), pcl_symmetry.ReflectionPlane((0, 0, 1), 2)]
        for result in results:
            for same in (copy.deepcopy(result), pickle.loads(pickle.dumps(result))):
                self.assertEqual(result, same)
                self.assertEqual(len({result, same}), 1)
            self.assertNotEqual(result, None)
        self.assertNotEqual(results[0][0], results[0][1])

    def test_become_dicts_and_json(self):
        found = pcl_symmetry.planes(box())
        read = json.loads(found.to_json())
        self.assertEqual(read["planes"][0]["kind"], "symmetry")
        np.testing.assert_array_equal(read["planes"][0]["coefficients"], found[0].coefficients)
        nothing = warned("points: ", pcl_symmetry.frame, np.zeros((9, 3)))
        self.assertEqual(json.loads(nothing.to_json(indent=1), parse_constant=self.fail), {"error": nothing.reason})

    def test_planes_are_a_sequence(self):
        found = pcl_symmetry.planes(box())
        self.assertEqual((found[1:], found[-1], found.reason, found.best), (found.planes[1:], found.planes[-1], "", None))
        self.assertAlmostEqual(found.tolerance, 0.01 * np.linalg.norm([1, 0.7, 0.4]), delta=2e-4)
        np.testing.assert_array_equal(found.point_support(found[1]), found.point_support(1))

    def test_a_plane_reflects_points_and_pairs_them(self):
        plane = pcl_symmetry.ReflectionPlane((1, 0, 0), 0.5)
        x = box()
        np.testing.assert_allclose(plane.reflect(x), x * (-1, 1, 1) + (1, 0, 0), atol=1e-6)
        self.assertEqual(plane.reflect(x).dtype, np.float32)
        np.testing.assert_allclose(plane.reflect(plane.reflect(x.astype(float))), x, atol=1e-12)
        np.testing.assert_allclose(plane.reflect(x[0]), (plane.reflection @ np.append(x[0], 1))[:3], atol=1e-6)
        half = x[x[:, 0] > 0]
        both = np.vstack([half, half * (-1, 1, 1), [[0.2, 3.0, 0.0]], [[np.nan, 0, 0]]])
        index, distance = pcl_symmetry.ReflectionPlane((1, 0, 0), 0).pairs(both)
        n = len(half)
        np.testing.assert_array_equal(both[index[:n]], both[n : 2 * n])
        self.assertLess(distance[: 2 * n].max(), 1e-6)
        self.assertEqual(index[-2:].tolist(), [-1, -1])
        self.assertTrue(np.isinf(distance[-2:]).all())

    def test_an_axis_rotates_points(self):
        axis = pcl_symmetry.Axis(np.array([1.0, 0, 0]), np.array([0.0, 0, 1]), 1.0, 1.0, 1.0)
        np.testing.assert_allclose(axis.rotate([[2.0, 0, 5]], np.pi / 2), [[1, 1, 5]], atol=1e-12)

    def test_pages_need_no_matplotlib(self):
        code = "import sys; sys.modules['matplotlib'] = None; import test_pcl_symmetry as t; t.pcl_symmetry.planes(t.box()).show(t.box())"
        subprocess.run([sys.executable, "-B", "-c", code], cwd=Path(__file__).parent, check=True, timeout=60)

    @needs("matplotlib")
    def test_plots_draw(self):
        points = box()
        self.assertEqual(len(pcl_symmetry.planes(points).plot(points).collections), 4)
        self.assertEqual(len(pcl_symmetry.frame(points).plot(points).lines), 3)
        mesh = Mesh(*box_mesh())
        self.assertGreater(len(pcl_symmetry.frame(mesh).plot(mesh).collections[0].get_offsets()), 1000, "not the corners alone")
        self.assertEqual(len(pcl_symmetry.transform(points, (8, 8, 9)).plot().images), 1)

    def test_forked_workers_answer_after_the_parent_has(self):
        code = (
            "import multiprocessing, test_pcl_symmetry as t\n"
            "assert t.count_planes(1) == 3\n"
            "with multiprocessing.get_context('fork').Pool(2) as pool: print(pool.map(t.count_planes, [1, 2, 3]))\n"
        )
        folder = Path(__file__).parent
        result = subprocess.run([sys.executable, "-B", "-c", code], cwd=folder, capture_output=True, text=True, timeout=60)
        self.assertEqual(result.stdout.strip(), "[3, 3, 3]", result.stderr)


class Package(ToolTest):
    def test_public_names_are_listed_and_documented(self):
        public = [name for name in dir(pcl_symmetry) if not name.startswith("_")]
        self.assertLess({*pcl_symmetry.__all__, "Planes", "Scene", "Merging"}, {*public})
        self.assertFalse(hasattr(pcl_symmetry, "nothing"))
        self.assertLess(pydoc.plain(pydoc.render_doc(pcl_symmetry)).index("FUNCTIONS"), 20000, "not after the 1800 lines of what they return")
        self.assertIn("\ntransform: (4, 4) from the input to the canonical frame.\n", pcl_symmetry.Frame.__doc__)
        for name in public:
            value = getattr(pcl_symmetry, name)
            self.assertTrue(value.__doc__, name)
            for member in vars(value) if inspect.isclass(value) else ():
                if not member.startswith("_") and callable(getattr(value, member)):
                    self.assertTrue(getattr(value, member).__doc__, f"{name}.{member}")

    def test_without_pcl_its_names_are_missing_and_say_so(self):
        code = (
            "import pcl_symmetry\n"
            "from pcl_symmetry import *\n"
            "print([name in dir(pcl_symmetry) or hasattr(pcl_symmetry, name) for name in ('Database', 'register')])\n"
        )
        copied = self.folder / "pcl_symmetry"
        shutil.copytree(Path(pcl_symmetry.__file__).parent, copied, ignore=shutil.ignore_patterns("_recognition*.so"))
        result = subprocess.run([sys.executable, "-c", code], cwd=self.folder, env={}, capture_output=True, text=True)
        self.assertEqual((result.stdout, result.stderr), ("[False, False]\n", ""))

    def test_wrong_arguments_are_named_with_their_rule(self):
        s, points, volume, (vertices, faces) = pcl_symmetry, box(), np.random.default_rng(1).random((8, 8, 8)), box_mesh()
        plane, axis, found, rotations = s.ReflectionPlane([1, 0, 0], 0.0), s.Axis(np.zeros(3), np.eye(3)[0], 1, 1, 1), s.planes(points), s.rotations(points)
        calls = [
            (ValueError, lambda: s.planes(np.zeros((5, 2))), r"points = array of shape \(5, 2\), must be \(N, 3\)"),
            (ValueError, lambda: s.planes(np.zeros((3, 50))), r"points = array of shape \(3, 50\), must be \(N, 3\): points.T"),
            (ValueError, lambda: s.planes(np.zeros((50, 4))), r"points = .*must be \(N, 3\): points\[:, :3\] leaves out"),
            (ValueError, lambda: s.planes(np.zeros((24, 32, 4))), r"points = .*must be \(N, 3\) or \(H, W, 3\): points\[..., :3\] leaves out"),
            (ValueError, lambda: s.planes(np.zeros((5, 3), dtype="U3")), "points = array of type <U3"),
            (ValueError, lambda: s.planes(1e300 * points.astype(float)), "points = .*coordinates that float32 cannot hold"),
            (ValueError, lambda: s.planes(1e-300 * points.astype(float)), "points = .*coordinates that float32 cannot hold"),
            (ValueError, lambda: s.planes((points, [[0, 1, 2]])), r"points = tuple of length 2, must be \(N, 3\), Shape"),
            (TypeError, lambda: s.planes(60 * b"cloud"), "points = bytes of 303 characters, must be an array"),
            *((TypeError, lambda nothing=nothing: s.planes(nothing), "points = .*, must be an array")
              for nothing in (b"cloud", 5, {"x": 1}, (row for row in points))),
            ((TypeError, ValueError), lambda: s.planes([[1, 2, 3], [4]]), "points = "),
            (ValueError, lambda: s.planes("cloud"), "cloud: unknown extension '', must be .pcd, "),
            *((TypeError, lambda none=none: s.planes(*none), r"planes\(\) takes points or volume") for none in ((), (None,))),
            (ValueError, lambda: s.planes(points, viewpoint=(0, 0, 0)), "viewpoint: among the points"),
            (ValueError, lambda: s.planes(points, normals=np.zeros((5, 3))), r"normals = array of shape \(5, 3\), must be \(6000, 3\)"),
            (ValueError, lambda: s.planes(volume=volume, tolerance=0.02), "tolerance: must be left out with volume"),
            (ValueError, lambda: s.planes(volume=volume, spacing=2.0), r"spacing = 2, must be numbers of shape \(3,\)"),
            (ValueError, lambda: s.planes(volume=volume, spacing=(1, 0, 1)), "spacing = .* must be finite and > 0"),
            (ValueError, lambda: s.planes(volume=volume, direction=np.eye(2)), r"direction = .* must be numbers of shape \(3, 3\)"),
            (ValueError, lambda: s.planes(volume=volume, levels=5), r"levels = 5, must be numbers of shape \(2,\)"),
            (ValueError, lambda: found.show(points[:10]), r"points = array of shape \(10, 3\), must be \(6000, 3\)"),
            (IndexError, lambda: found.point_support(9), "index = 9, must be that of one of 3 planes"),
            (TypeError, lambda: found.point_support("first"), "index = 'first', must be int or a plane of this answer"),
            (ValueError, lambda: found.point_support(s.planes(lamp(), approximate=True).every[0]), r"index = Plane\(.*must be a plane of"),
            *((ValueError, lambda wrong=wrong: plane.pairs(wrong), "points = ")
              for wrong in (1e300 * points.astype(float), np.zeros((5, 2)), np.zeros((5, 3), dtype="U3"))),
            *((ValueError, lambda f=f: f(np.ones((24, 32))), r"points = array of shape \(24, 32\), must be \(3,\) or \(N, 3\)")
              for f in (plane.reflect, plane.distance, lambda x: axis.rotate(x, 1))),
            (ValueError, lambda: rotations.canonical(np.eye(3)), r"pose = .*, must be numbers of shape \(4, 4\)"),
            (ValueError, lambda: rotations.mssd(np.eye(4), np.ones((4, 4)), points), "truth"),
            (IndexError, lambda: s.transform(points, (8, 8, 9)).plane(8, 0, 0), r"bin = \(8, 0, 0\), must"),
            (ValueError, lambda: s.descriptor_distance(np.zeros((2, 3, 4)), np.ones((1, 3, 4))), "a, b: shapes"),
            (ValueError, lambda: s.sample_mesh(np.full((8, 3), np.nan), faces), "vertices: not all finite"),
            (TypeError, lambda: s.sample_mesh(vertices, 500), "faces = 500, must be"),
            (ValueError, lambda: s.Merging(vertices, faces[:, :2]), r"faces = array of shape \(\d+, 2\), must be \(F, 3\)"),
            ((ValueError, TypeError), lambda: s.Merging(vertices, [[0, 1, 2.5], [0, 1]]), "faces = no numbers, must be"),
            ((ValueError, TypeError), lambda: s.Merging((vertices, faces[:9]), faces), "points = .*must be"),
            (ValueError, lambda: s.Merging(vertices, faces).merges([1, 2]), "weights = 2 numbers, must be 14"),
            (TypeError, lambda: s.viewpoints(None), "points = None, must be an array"),
        ]  # fmt: skip
        for each in (s.planes, s.frame, s.segment, s.describe, plane.pairs):
            calls += [
                (ValueError, lambda f=each: f(np.ones((24, 32))), r"points = array of shape \(24, 32\), must be .*; from_depth\(\) makes points of"),
                (ValueError, lambda f=each: f(Path("depth.png")), r"depth.png: unknown extension '.png', must be .pcd, .*from_depth\(\) takes"),
                (FileNotFoundError, lambda f=each: f("cloud.pcd"), ".*cloud.pcd"),
            ]
        if has_pcl():
            database = s.Database(":memory:")
            calls += [
                (TypeError, lambda: s.Database(":memory:", unit=3), "unit = 3, must be str"),
                *((TypeError, lambda f=f, given=given: f(*given), "name = 3, must be str")
                  for f, *given in ((database.add, 3, points), (database.remove, 3), (database.cloud, 3))),
                (TypeError, lambda: database.build(5), ""), (TypeError, lambda: database.build([("box", points, 3)]), "models: item 0 is no pair"),
                (ValueError, lambda: s.viewpoints(points, number=0), "number = 0, must be >= 1"),
                (ValueError, lambda: s.viewpoints(points, up=(0, 0, 0)), "up = 0 0 0, must"),
                (ValueError, lambda: s.viewpoints(points, separation=4.0), "separation = 4, must"),
                (TypeError, lambda: s.register_all("scans"), "clouds = 'scans', must be a list of clouds"),
            ]
        for error, call, words in calls:
            with self.subTest(words), self.assertRaisesRegex(error, "(?s)^" + words) as raised:
                call()
            self.assertLess(len(str(raised.exception)), 200, "values are shortened")

    @needs("mypy")
    def test_types_are_those_that_mypy_finds(self):
        root = Path(__file__).resolve().parents[2]
        checked = [self.folder / "uses.py", root / "apps/examples/14_depth_camera.py"]
        checked[0].write_text(
            "import pcl_symmetry as s\n"
            "found = s.planes([[0.0, 0.0, 0.0]])\n"
            "kinds: list[str] = [plane.kind for plane in found[1:]] + [found[0].kind]\n"
            "views: list[s.View] = s.viewpoints(found)\n"
        )
        for page in ("README.md", "apps/README.md", *sorted(map(str, (root / "src/pages").rglob("*.md")))):
            for i, block in enumerate(re.findall(r"```python\n(.*?)```", (root / page).read_text(), re.S)):
                checked.append(self.folder / f"{Path(page).stem.lower()}_{i}.py")
                checked[-1].write_text(block)
        package = Path(pcl_symmetry.__file__).parent
        path = {} if package.parent.name.endswith("-packages") else {"MYPYPATH": str(package.parent)}
        command = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", os.devnull]
        result = subprocess.run([*command, package, *checked], cwd=self.folder, env=path, capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_its_version_is_printed_and_that_of_its_files(self):
        command = [sys.executable, "-m", "pcl_symmetry", "--version"]
        version = subprocess.check_output(command, text=True).strip()
        self.assertEqual(version, pcl_symmetry.__version__)
        for name, words in (("CITATION.cff", "version: {}\n"), ("package.xml", "<version>{}<"), ("pyproject.toml", 'version = "{}"')):
            text = (Path(__file__).resolve().parents[2] / name).read_text()
            self.assertIn(words.format(version), text)
            self.assertNotIn("example.org", text, "an address that nobody reads")

    def test_the_example_of_the_package_is_true(self):
        import doctest

        self.assertEqual(doctest.testmod(pcl_symmetry).failed, 0)

    def test_numpy_is_imported_by_the_first_call(self):
        code = "import sys, pcl_symmetry; print('numpy' in sys.modules)"
        self.assertEqual(subprocess.check_output([sys.executable, "-c", code], text=True), "False\n")
