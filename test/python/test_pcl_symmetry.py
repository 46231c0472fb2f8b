"""The Python module: shapes, units, errors, and that it says what the C++ functions say."""

import inspect
import re
import subprocess
import sys
import tempfile
import threading
import time
import unittest
from pathlib import Path

try:
    import numpy as np
except ImportError:
    print("skipped: NumPy is not installed for " + sys.executable)
    sys.exit(77)

import pcl_symmetry


def box(size=(1.0, 0.7, 0.4), num_points=6000, seed=1):
    """Points on the surface of a box of the given edges about the origin, (N, 3) float32."""
    random = np.random.default_rng(seed)
    edges = np.asarray(size)
    areas = np.repeat(np.prod(edges) / edges, 2)
    side = random.choice(6, num_points, p=areas / areas.sum())
    points = (random.random((num_points, 3)) - 0.5) * edges
    axis = side // 2
    points[np.arange(num_points), axis] = (side % 2 - 0.5) * edges[axis]
    return points.astype(np.float32)


def box_mesh():
    """A box of two by one by one with its faces as triangles."""
    vertices = np.array([[x, y, z] for x in (-1, 1) for y in (-0.5, 0.5) for z in (-0.5, 0.5)], dtype=np.float32)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    return vertices, np.array([t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])


class Planes(unittest.TestCase):
    def test_a_box_has_three(self):
        found = pcl_symmetry.planes(box())
        self.assertEqual([plane.kind for plane in found], ["symmetry"] * 3)
        for plane in found:
            self.assertGreater(np.abs(plane.normal).max(), 0.9999)
            self.assertLess(abs(plane.offset), 0.002)
            self.assertGreater(plane.share, 0.97)
            low, high = plane.share_interval
            self.assertLessEqual(low, plane.share)
            self.assertLessEqual(plane.share, high)
        self.assertEqual(found.reason, "")
        self.assertIsNone(found.best)
        self.assertAlmostEqual(found.tolerance, 0.01 * np.linalg.norm([1, 0.7, 0.4]), delta=2e-4)
        self.assertEqual(found.point_support(0).shape, (6000,))

    def test_all_kinds_of_rows_give_the_same(self):
        points = box()
        padded = np.zeros((len(points), 5), dtype=np.float32)
        padded[:, :3] = points
        expected = [plane.coefficients for plane in pcl_symmetry.planes(points)]
        for same in (points.astype(np.float64), np.asfortranarray(points), padded[:, :3], points.tolist()):
            found = pcl_symmetry.planes(np.asarray(same))
            np.testing.assert_allclose([plane.coefficients for plane in found], expected, atol=1e-9)

    def test_rows_that_are_not_finite_are_left_out(self):
        points = np.vstack([box(), [[np.nan, 0, 0]]]).astype(np.float32)
        found = pcl_symmetry.planes(points)
        self.assertEqual(len(found), 3)
        self.assertTrue(np.isnan(found.point_support(0)[-1]))
        self.assertFalse(np.isnan(found.point_support(0)[:-1]).any())

    def test_a_scan_of_a_block_has_its_turns(self):
        """A square block, seen from above and one side."""
        points = box((1.0, 1.0, 0.4), 40_000)
        viewpoint = np.array([1.6, 2.4, 3.2])
        seen = points[(points[:, 0] == 0.5) | (points[:, 1] == 0.5) | (points[:, 2] == np.float32(0.2))]
        found = pcl_symmetry.planes(seen, viewpoint=viewpoint)
        self.assertGreaterEqual(len(found.turns), 1)
        turn = found.turns[0]
        self.assertEqual(turn.fold, 4)
        self.assertGreater(abs(turn.direction[2]), np.cos(np.radians(1)))
        self.assertLess(np.linalg.norm(turn.point[:2]), 0.02)
        self.assertGreaterEqual(turn.confidence, 0.5)
        self.assertLessEqual(turn.off, 1.0)
        self.assertEqual(pcl_symmetry.planes(points).turns, [], "whole clouds have rotations()")
        frame = pcl_symmetry.frame(seen, viewpoint=viewpoint)
        self.assertEqual(frame.turns[0].fold, 4)
        self.assertEqual(pcl_symmetry.frame(points).turns, [])

    def test_data_without_an_answer_give_a_reason(self):
        for points in (np.zeros((0, 3), np.float32), np.zeros((100, 3), np.float32), box(num_points=12)):
            found = pcl_symmetry.planes(points)
            self.assertEqual(len(found), 0)
            self.assertNotEqual(found.reason, "")

    def test_wrong_parameters_name_field_value_and_rule(self):
        for arguments, words in (
            (dict(points=np.zeros((5, 2))), "points = array of shape \\(5, 2\\), must be \\(N, 3\\)"),
            (dict(points=np.zeros((5, 3), dtype="U3")), "points = array of kind U"),
            (dict(points=box(), tolerance=0.5), "tolerance = 0.5, must be"),
            (dict(points=box(), threads=-1), "num_threads = -1"),
            (dict(points=box(), viewpoint="here"), "viewpoint = here, must be"),
            (dict(points=box(), viewpoint=(0, 0, 0)), "viewpoint: among the points"),
            (dict(points=box(), normals=np.zeros((5, 3))), "normals = array of shape \\(5, 3\\), must be \\(6000, 3\\)"),
            (dict(points=box().astype(float) + 1e7), "points = coordinates too large"),
        ):
            with self.assertRaisesRegex(ValueError, words):
                pcl_symmetry.planes(**arguments)

    def test_large_arrays_are_not_copied(self):
        import resource

        points = np.tile(box(), (1700, 1))  # 10.2 million rows, 122 MB
        before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
        self.assertEqual(len(pcl_symmetry.planes(points, threads=1)), 3)
        grown = (resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before) / 1024
        print(f"10.2 million points: {grown:.0f} MB more at the peak")
        self.assertLess(grown, 90)

    def test_other_python_threads_run_meanwhile(self):
        points, ticks, stop = box(num_points=50_000), [0], threading.Event()

        def tick():
            while not stop.is_set():
                ticks[0] += 1
                time.sleep(0.0005)

        thread = threading.Thread(target=tick)
        thread.start()
        before = ticks[0]
        pcl_symmetry.planes(points, threads=1)
        during = ticks[0] - before
        stop.set()
        thread.join()
        self.assertGreater(during, 3)


class OtherFunctions(unittest.TestCase):
    def test_frame_and_rotations_of_a_box(self):
        frame = pcl_symmetry.frame(box())
        np.testing.assert_allclose(np.abs(frame.axes).max(axis=0), 1, atol=1e-3)
        np.testing.assert_allclose(frame.transform @ np.append(frame.center, 1), [0, 0, 0, 1], atol=1e-9)
        self.assertEqual(frame.equivalent.shape[1:], (4, 4))
        self.assertEqual(frame.probable[0].axes.tolist(), frame.axes.tolist())
        self.assertGreater(frame.probable[0].probability, 0.5)
        self.assertLess(sum(other.probability for other in frame.probable), 1)
        rotations = pcl_symmetry.rotations(box())
        self.assertEqual(rotations.name, "D2")
        self.assertEqual(rotations.discrete.shape, (3, 4, 4))
        self.assertAlmostEqual(rotations.tolerance, 0.01 * np.linalg.norm([1, 0.7, 0.4]), delta=2e-4)

    def test_rotations_keep_to_the_tolerance_that_is_asked_for(self):
        nearly_square = box((1.0, 0.96, 0.4))
        self.assertEqual(pcl_symmetry.rotations(nearly_square, tolerance=0.005).name, "D2")
        self.assertEqual(pcl_symmetry.rotations(nearly_square, absolute_tolerance=0.05).name, "D4")
        with self.assertRaisesRegex(ValueError, "tolerance"):
            pcl_symmetry.rotations(nearly_square, tolerance=2.0)

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
        with self.assertRaisesRegex(ValueError, "truth"):
            symmetries.mssd(pose, np.ones((4, 4)), corners)

    def test_results_print_what_tells_most(self):
        found = pcl_symmetry.planes(box())
        self.assertRegex(repr(found), r"(?s)^Planes\(\[\n  Plane\(kind='symmetry', normal=\[.*confidence=0\.9.*\),\n\]\)$")
        self.assertEqual(repr(pcl_symmetry.ReflectionPlane((0, 0, 2), 1)), "ReflectionPlane(normal=[0, 0, 1], offset=0.5)")
        self.assertRegex(repr(pcl_symmetry.frame(box())), r"^Frame\(center=\[.*axes=\[\[.*revolution_axis=-1\)$")
        self.assertRegex(repr(pcl_symmetry.rotations(box())), r"^Rotations\(name='D2', center=.*confidence=")
        self.assertRegex(repr(pcl_symmetry.viewpoints(list(found))[0]), r"^View\(direction=\[.*score=")

    def test_half_a_box_is_completed(self):
        points = box()
        half = points[points[:, 0] > -0.1]
        plane = pcl_symmetry.ReflectionPlane((1, 0, 0), 0)
        added, rows = pcl_symmetry.complete(half, plane, viewpoint=None)
        self.assertGreater(len(added), 1000)
        np.testing.assert_allclose(added, half[rows] * (-1, 1, 1), atol=1e-6)
        self.assertLess(added[:, 0].max(), 0.0)

    def test_parts_of_a_mesh_and_of_a_cloud(self):
        vertices, faces = box_mesh()
        self.assertEqual(len(pcl_symmetry.segment(vertices, faces)), len(faces))
        shares = []
        labels = pcl_symmetry.segment(box(num_points=2000), parts=2, progress=shares.append)
        self.assertEqual(len(labels), 2000)
        self.assertTrue(shares and max(shares) <= 1.0)
        self.assertEqual(pcl_symmetry.sample_mesh(vertices, faces, 500).shape, (500, 3))

    def test_description_does_not_depend_on_the_pose(self):
        points = box()
        turn = np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]], dtype=np.float32)
        first = pcl_symmetry.describe(points)
        self.assertEqual(first.shape[0], 2)
        np.testing.assert_allclose(np.linalg.norm(first, axis=1), 1, atol=1e-4)
        self.assertEqual(pcl_symmetry.describe(points @ turn.T).shape, first.shape)

    def test_the_map_has_its_maximum_at_a_plane_of_the_box(self):
        for method in ("sampled", "convolution"):
            map_ = pcl_symmetry.transform(box(), (32, 64, 33), method=method)
            self.assertEqual(map_.values.shape, (32, 64, 33))
            best = np.unravel_index(map_.values.argmax(), map_.values.shape)
            self.assertGreater(np.abs(map_.plane(*map(int, best))[:3]).max(), 0.98)
        with self.assertRaises(IndexError):
            map_.plane(32, 0, 0)
        with self.assertRaisesRegex(ValueError, "method = guess, must be"):
            pcl_symmetry.transform(box(), method="guess")

    def test_views_show_three_sides_of_a_box(self):
        views = pcl_symmetry.viewpoints(pcl_symmetry.planes(box()).planes)
        self.assertGreater(np.abs(views[0].direction).min(), 0.3)


def lamp(num_points=4000, seed=1):
    """An object without symmetry: three boxes of different sizes, one on the other, off the middle."""
    parts = [box((1.0, 0.7, 0.2), num_points // 2, seed), box((0.2, 0.15, 0.9), num_points // 4, seed + 1)]
    parts.append(box((0.6, 0.3, 0.25), num_points // 4, seed + 2))
    offsets = [(0.0, 0.0, 0.0), (0.3, 0.1, 0.5), (0.1, 0.25, 1.0)]
    return np.concatenate([part + np.float32(offset) for part, offset in zip(parts, offsets)])


def motion(angle=2.0, translation=(3.0, -1.0, 0.5)):
    """A turn about (1, 2, 3) and a translation, (4, 4)."""
    k = np.array([1.0, 2.0, 3.0]) / np.sqrt(14.0)
    cross = np.array([[0, -k[2], k[1]], [k[2], 0, -k[0]], [-k[1], k[0], 0]])
    result = np.eye(4)
    result[:3, :3] = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    result[:3, 3] = translation
    return result


def has_pcl():
    return any(Path(pcl_symmetry.__file__).parent.glob("_recognition*"))


@unittest.skipUnless(has_pcl(), "the module was built without PCL")
class WithPCL(unittest.TestCase):
    def test_registers_from_any_pose(self):
        source, truth = lamp(), motion()
        target = (lamp(seed=5) @ truth[:3, :3].T + truth[:3, 3]).astype(np.float32)
        found = pcl_symmetry.register(source, target, source_viewpoint=None, target_viewpoint=None)
        self.assertLess(np.abs(found.transform - truth).max(), 0.02)
        self.assertGreater(found.score.merit, 0.5)
        np.testing.assert_array_equal(found.poses[0][0], found.transform)
        self.assertEqual(found.poses[0][1].merit, found.score.merit)
        self.assertAlmostEqual(found.score.merit, found.score.support - found.score.conflict / 2)
        self.assertEqual(found.covariance.shape, (6, 6))
        self.assertTrue((np.linalg.eigvalsh(found.covariance) > 0).all())
        self.assertRegex(repr(found), r"^Registration\(transform=\[\[.*score=PoseScore\(support=")
        tracked = pcl_symmetry.register(
            source, target, guess=truth, around=(0.2, 0.1), source_viewpoint=None, target_viewpoint=None
        )
        self.assertLess(np.abs(tracked.transform - truth).max(), 0.02)
        with self.assertRaisesRegex(ValueError, "around"):
            pcl_symmetry.register(source, target, around=(-1, 0.1))
        with self.assertRaisesRegex(ValueError, "guess"):
            pcl_symmetry.register(source, target, guess=np.ones((4, 4)))
        with self.assertRaisesRegex(ValueError, "source"):
            pcl_symmetry.register(np.zeros((5, 3), dtype=np.float32), target)

    def test_a_database_finds_what_it_holds(self):
        with tempfile.TemporaryDirectory() as folder:
            path = str(Path(folder) / "models.db")
            database = pcl_symmetry.Database(path, unit="m")
            database.add("box", box())
            database.add("lamp", lamp())
            database.add("plate", box((1.0, 0.9, 0.1)))
            self.assertEqual((len(database), database.names), (3, ["box", "lamp", "plate"]))
            self.assertIn("lamp", database)
            truth = motion()
            seen = (lamp(seed=9) @ truth[:3, :3].T + truth[:3, 3]).astype(np.float32)
            matches = database.match(seen, viewpoint=None)
            self.assertEqual(matches[0].name, "lamp")
            self.assertEqual(sorted(match.distance for match in matches), [match.distance for match in matches])
            recognized = database.recognize(seen, viewpoint=None)
            self.assertEqual(recognized[0].name, "lamp")
            self.assertRegex(repr(recognized[0]), r"^Recognized\(name='lamp', confidence=")
            self.assertEqual(repr(database), "Database(models=3)")
            self.assertEqual(database.recognize(seen, viewpoint=None, min_confidence=1.0), [])
            self.assertLess(np.abs(recognized[0].transform @ truth - np.eye(4)).max(), 0.05)
            self.assertEqual(database.cloud("box").shape[1], 3)
            database.remove("plate")
            self.assertEqual(pcl_symmetry.Database(path).names, ["box", "lamp"])
            with self.assertRaisesRegex(ValueError, "name"):
                database.cloud("nothing")
            with self.assertRaisesRegex(ValueError, "viewpoint = there"):
                database.match(seen, viewpoint="there")
            wrong = Path(folder) / "wrong.db"
            wrong.write_text("no database at all")
            with self.assertRaisesRegex(OSError, "wrong.db"):
                pcl_symmetry.Database(str(wrong))

    def test_many_models_are_stored_at_once(self):
        database, shares = pcl_symmetry.Database(":memory:"), []
        models = {"box": box(), "flat": np.zeros((50, 3)), "lamp": lamp(), "words": "none", "plate": box((1.0, 0.9, 0.1))}
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
        with self.assertRaises(ZeroDivisionError):
            pcl_symmetry.Database(":memory:").build(models, progress=lambda share: 1 / 0)
        with self.assertRaises(TypeError):
            pcl_symmetry.Database(":memory:").build(5)
        with self.assertRaisesRegex(TypeError, "models: item 0 is no pair"):
            pcl_symmetry.Database(":memory:").build([("box", box(), 3)])

    def test_members_have_stubs_and_words(self):
        stub = Path(pcl_symmetry.__file__).with_suffix(".pyi").read_text()
        for name in ("BuildReport", "Database", "Match", "PoseScore", "Recognized", "Registration", "register"):
            self.assertRegex(stub, rf"(class|def) {name}\b")
            self.assertTrue(getattr(pcl_symmetry, name).__doc__)
        with self.assertRaises(AttributeError):
            pcl_symmetry.nothing


class OtherObjects(unittest.TestCase):
    def test_lists_and_objects_like_arrays_pass(self):
        class Like:
            def __array__(self, *arguments, **keywords):
                return box()

        expected = pcl_symmetry.planes(box())[0].coefficients
        for points in (box().tolist(), Like()):
            np.testing.assert_allclose(pcl_symmetry.planes(points)[0].coefficients, expected, atol=1e-12)
        for wrong in (None, "box", [[1, 2, 3], [4]]):
            with self.assertRaises((TypeError, ValueError)):
                pcl_symmetry.planes(wrong)


class Open3D(unittest.TestCase):
    def test_its_objects_pass_as_they_are(self):
        try:
            import open3d
        except ImportError:
            self.skipTest("Open3D is not installed (Debian package python3-open3d)")
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(box().astype(float)))
        self.assertEqual(len(pcl_symmetry.planes(cloud.points)), 3)
        mesh = open3d.geometry.TriangleMesh.create_box(1.0, 2.0, 3.0)
        points = pcl_symmetry.sample_mesh(mesh.vertices, mesh.triangles, 5000)
        self.assertEqual(len(pcl_symmetry.planes(points)), 3)
        self.assertEqual(len(pcl_symmetry.segment(mesh.vertices, mesh.triangles)), len(mesh.triangles))


class Package(unittest.TestCase):
    def test_stubs_name_what_the_module_has(self):
        stub = Path(pcl_symmetry.__file__).with_suffix(".pyi").read_text()
        for name in pcl_symmetry.__all__:
            self.assertRegex(stub, rf"(class|def) {name}\b")
            if inspect.isclass(getattr(pcl_symmetry, name)):
                body = re.search(rf"class {name}\b.*?(?=\nclass |\ndef )", stub, re.S).group(0)
                for member, value in vars(getattr(pcl_symmetry, name)).items():
                    if not member.startswith("_"):
                        self.assertRegex(body, rf"def {member}\b", name)
                        self.assertTrue(value.__doc__, name + "." + member)

    def test_the_example_of_the_package_is_true(self):
        import doctest

        self.assertEqual(doctest.testmod(pcl_symmetry).failed, 0)

    def test_importing_is_quick(self):
        code = "import time; t = time.perf_counter(); import pcl_symmetry; print(time.perf_counter() - t)"
        seconds = min(float(subprocess.check_output([sys.executable, "-c", code])) for _ in range(3))
        print(f"import: {1000 * seconds:.0f} ms")
        self.assertLess(seconds, 0.5)  # ten times what an idle machine takes


if __name__ == "__main__":
    unittest.main()
