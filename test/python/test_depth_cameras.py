"""What a depth camera needs of the Python module: organized arrays, parts of scenes, scenes, and calls that can be ended."""
import dataclasses
import importlib.util
import inspect
import json
import os
import pickle
import re
import shutil
import signal
import subprocess
import sys
import threading
import time
import types
import unittest
from pathlib import Path

import pcl_symmetry
from test_scene import block
from test_shape_input import CORNERS, SQUARE_STL, XYZ, meshes
from test_shape_input import rows as rows_of_text
from tool_run import ToolTest, needs, np, off, pcd, points_on_sphere, triangles, turned
from test_pcl_symmetry import Mesh, bar, box, box_mesh, bumped, has_pcl, lamp, needs_pcl, warned

INTRINSICS = (300.0, 300.0, 160.0, 120.0)


def table(blocks=(((-0.2, -0.15, 0.025), (0.15, 0.15, 0.125)), ((0.225, -0.1, 0.025), (0.125, 0.1, 0.075))), dome=0.0):
    """(240, 320) depths of blocks (center, half size) on a table, seen from above and in front, and the block of each pixel, from 1.

    dome: where it is not 0, x^2 + z^2 = dome (0.4 - height) is on the table.
    """
    v, u = np.indices((240, 320)).reshape(2, -1)
    fx, fy, cx, cy = INTRINSICS
    rays = np.stack([(u - cx) / fx, (v - cy) / fy, np.ones(u.shape)], axis=1) @ np.array([[1, 0, 0], [0, 0.8, 0.6], [0, -0.6, 0.8]]).T
    eye = np.array([0, -0.9, -1.2])
    with np.errstate(divide="ignore", invalid="ignore"):
        distances = [np.where(rays[:, 1] > 1e-9, -eye[1] / rays[:, 1], np.inf), *(block(*each)(eye, rays) for each in blocks)]
        if dome:
            a, b, c = (rays[:, ::2] ** 2).sum(axis=1), -2.4 * rays[:, 2] - dome * rays[:, 1], 1.44 + 0.5 * dome
            distances[0] = np.fmin(distances[0], (-b - np.sqrt(b**2 - 4 * a * c)) / (2 * a))
    depth = np.min(distances, axis=0)
    return np.where(depth < 4, depth, 0).reshape(240, 320), np.argmin(distances, axis=0).reshape(240, 320)


def seen_half(points, viewpoint):
    """The points of a box about the origin on the sides that face a viewpoint."""
    half = np.abs(points).max(axis=0)
    faces = np.isclose(np.abs(points), half, atol=1e-6) & (np.sign(points) * viewpoint > half)
    return points[faces.any(axis=1)]


@unittest.skipUnless(os.environ.get("TOOLS") and has_pcl(), "needs the tools")
class SameBytes(ToolTest):
    """The tool is the C++ class with a command line: what it writes is what the module returns, to the last bit."""

    NAMES = ("confidence", "share", "support", "score", "seen", "residual", "deviation")

    def assert_same(self, name, file, flags, found):
        with self.subTest(name):
            read = self.report(self.folder / file, flags, "-quiet", tool="planes")
            self.assertEqual([p["kind"] for p in read["planes"]], [p.kind for p in found.every])
            self.assertEqual([p["coefficients"] for p in read["planes"]], [p.coefficients.tolist() for p in found.every])
            for field in self.NAMES:
                expected = [getattr(p, field) for p in found.every]  # NaN where JSON has null
                np.testing.assert_array_equal(np.array([p[field] for p in read["planes"]], float), expected, field)
            self.assertEqual(read["tolerance"], found.tolerance)
            self.assertEqual(len(read["axes"]), len(found.axes))

    def test_of_defaults(self):
        functions = dict(planes=pcl_symmetry.planes, align=pcl_symmetry.frame, segment=pcl_symmetry.segment, map=pcl_symmetry.transform,
                         bop=pcl_symmetry.rotations, scene=pcl_symmetry.scene, describe=pcl_symmetry.describe)  # fmt: skip
        for tool, function in functions.items():
            self.run_tool("-h", tool=tool)
            for name in ("seed", "max_planes")[: 2 if tool == "planes" else 1]:
                default = re.search(rf"-{name} N\s[^()]*\((\d+)\)", self.output)
                self.assertIsNotNone(default, tool)
                self.assertEqual(int(default[1]), inspect.signature(function).parameters[name].default, tool)

    def test_of_twelve_inputs(self):
        depth, labels = table()
        random = np.random.default_rng(1)
        frame = pcl_symmetry.from_depth(depth, INTRINSICS)
        noisy_frame = pcl_symmetry.from_depth(depth + 0.002 * random.normal(size=depth.shape) * (depth > 0), INTRINSICS)
        cloud, viewpoint = box(), np.array([2.0, 3.0, 2.5])
        holes = cloud.copy()
        holes[::7] = np.nan
        noisy = (cloud + 0.004 * random.normal(size=cloud.shape)).astype(np.float32)
        one_side = seen_half(box(num_points=20_000), viewpoint)
        large = box(num_points=120_000)
        at = ",".join(map(repr, viewpoint.tolist()))

        def check(name, points, flags="", labels=None, **options):
            width = points.shape[1] if points.ndim == 3 else 0
            self.write("cloud.pcd", pcd(points.reshape(-1, 3), width, **({} if labels is None else {"label": labels.ravel()})))
            self.assert_same(name, "cloud.pcd", flags, pcl_symmetry.planes(points, **options))

        check("cloud", cloud)
        check("with NaN", holes)
        check("with noise", noisy)
        check("large", large)
        check("one side", one_side)
        check("viewpoint", one_side, f"-viewpoint {at}", viewpoint=viewpoint)
        check("ground", one_side, f"-viewpoint {at} -ground 0,0,1,0.2", viewpoint=viewpoint, ground=(0, 0, 1, 0.2))
        warned("ground: has no effect without a viewpoint", pcl_symmetry.planes, cloud, ground=(0, 0, 1, 0.2))
        check("organized", np.where((labels == 1)[..., None], frame, np.nan))
        check("organized, without viewpoint", frame, "-viewpoint none", viewpoint=None)
        check("label", frame, "-label 1", labels=labels, indices=labels == 1)
        check("label in noise", noisy_frame, "-label 2", labels=labels, indices=labels == 2)
        vertices, faces = box_mesh()
        self.write("mesh.off", off(vertices, faces))
        self.assert_same("mesh", "mesh.off", "", pcl_symmetry.planes(Mesh(vertices, faces)))
        x, y, z = np.meshgrid(np.arange(32), np.arange(36), np.arange(30), indexing="ij")
        body = (((x - 15.5) / 11) ** 2 + ((y - 17) / 14) ** 2 + ((z - 14) / 9) ** 2 < 1).astype("<f4")
        head = "NRRD0004\ntype: float\ndimension: 3\nsizes: 32 36 30\nspace dimension: 3\nspace directions: (2,0,0) (0,2,0) (0,0,3)\n"
        self.write("body.nrrd", (head + "space origin: (5,7,-9)\nencoding: raw\nendian: little\n\n").encode() + body.tobytes(order="F"))
        self.assert_same("volume", "body.nrrd", "", pcl_symmetry.planes(volume=body, spacing=(2, 2, 3), origin=(5, 7, -9)))

    def test_of_descriptors(self):
        random = np.random.default_rng(1)
        shapes = [lamp(2000, i) if i % 2 else box(random.uniform(0.2, 1, 3), 2000, i) for i in range(4)]
        shapes = [(each @ np.linalg.qr(random.normal(size=(3, 3)))[0]).astype(np.float32) for each in shapes]
        described = [pcl_symmetry.descriptors(each) for each in shapes]
        files = [self.write(f"{i}.pcd", pcd(points)) for i, points in enumerate(shapes)]
        for k, kind in enumerate(("prst", "prsd", "gedt")):
            self.run_tool(kind, *files, f"-type {kind} -quiet", tool="describe")
            for file, values in zip(files, (each[k] for each in described)):
                body = (self.folder / kind / file.name).read_bytes().split(b"DATA binary\n", 1)[1]
                read = np.frombuffer(body, "<f4", count=values.size)  # PCL fills the last page of the file
                np.testing.assert_array_equal(read, values.ravel(), err_msg=f"{kind} {file.name}")

    def test_of_poses(self):
        source = seen_half(box(num_points=30_000), np.array([3.0, 2.0, 1.5]))
        depth, labels = table()
        pixels = pcl_symmetry.from_depth(np.where(labels == 1, depth, 0), INTRINSICS)
        clouds = dict(source=source, pixels=pixels, lamp=lamp(24_000), box=box(num_points=25_000))
        for name, points in clouds.items():
            self.write(f"{name}.pcd", pcd(points.reshape(-1, 3), points.shape[1] if points.ndim == 3 else 0))
        for scan, known in (("source", "lamp"), ("source", "box"), ("pixels", "box")):
            found = pcl_symmetry.register(clouds[scan], clouds[known])
            self.run_tool(f"{scan}.pcd -target {known}.pcd -json report.json -quiet", tool="align", code=not found.converged)
            read = json.loads(self.text("report.json"))
            self.assertEqual((read["confidence"], read["converged"]), (found.confidence, found.converged), (scan, known))
            self.assertEqual(read.get("reason", ""), found.reason)
            np.testing.assert_array_equal(read["transform"], found.transform.ravel(), (scan, known))

    def test_of_views(self):
        points = lamp()
        self.write("lamp.pcd", pcd(points))
        read = self.report("lamp.pcd -up 0,1,0 -views 3 -separation 30 -quiet", tool="viewpoint")
        options = dict(up=(0, 1, 0), number=3, separation=30 * np.pi / 180)
        self.assertEqual([view.to_dict() for view in pcl_symmetry.viewpoints(points, **options)], read["good"])
        self.assertEqual([view.to_dict() for view in pcl_symmetry.viewpoints(points, worst=True, **options)], [read["worst"]])


@needs_pcl
class OrganizedArrays(ToolTest):
    def setUp(self):
        super().setUp()
        depth, self.labels = table()
        self.frame = pcl_symmetry.from_depth(depth, INTRINSICS)
        self.alone = np.where((self.labels == 1)[..., None], self.frame, np.nan)

    def test_what_the_picture_cuts_off_all_around_has_no_symmetry(self):
        for depth in (np.full((120, 160), 1.2), 1 / (0.8 + np.linspace(0, 0.3, 120)[:, None] + np.zeros(160))):
            found = warned("if this is a whole frame", pcl_symmetry.planes, pcl_symmetry.from_depth(depth, (150, 150, 80, 60)))
            self.assertEqual((found.planes, found.axes), ([], []))

    def assert_says_what_was_seen(self, found, mask):
        """Points have support where the camera could see their reflection."""
        support = found.point_support(0)
        self.assertFalse(np.isfinite(support[~mask]).any())
        self.assertAlmostEqual(np.isfinite(support[mask]).mean(), found[0].seen, delta=0.1)
        self.assertGreater(np.nanmean(support), 0.9)

    def test_show_what_the_camera_saw(self):
        found = pcl_symmetry.planes(self.alone)
        np.testing.assert_allclose(found.viewpoint, 0, atol=2e-3)
        self.assertEqual(found.point_support(0).shape, (240, 320))
        self.assert_says_what_was_seen(found, self.labels == 1)
        self.assertTrue(pcl_symmetry.frame(self.alone))
        values = pcl_symmetry.local_symmetry(self.alone[::4, ::4], 1.0)
        np.testing.assert_array_equal(np.isfinite(values), self.labels[::4, ::4] == 1)
        self.assertEqual(pcl_symmetry.segment(self.alone[::2, ::2]).shape, (120, 160))
        self.assertEqual(pcl_symmetry.describe(self.alone).shape[0], 2)
        self.assertEqual(found[0].pairs(self.alone)[0].shape, (240 * 320,))

    def test_a_part_stands_on_its_scene(self):
        mask = self.labels == 2
        found = pcl_symmetry.planes(self.frame, indices=mask)
        self.assertTrue(found)
        self.assertLess(np.abs(found[0].normal).argmax(), 1, "the plane across x")
        self.assertEqual(found, pcl_symmetry.planes(self.frame, indices=np.flatnonzero(mask)))
        self.assert_says_what_was_seen(found, mask)
        added, rows = pcl_symmetry.complete(self.frame, found[0], indices=mask)
        np.testing.assert_array_equal(pcl_symmetry.complete(self.frame, indices=mask)[1], rows)
        self.assertTrue(mask.ravel()[rows].all())
        np.testing.assert_allclose(found[0].reflect(self.frame.reshape(-1, 3)[rows]), added, atol=1e-6)
        self.assertTrue(pcl_symmetry.frame(self.frame, indices=mask))
        if importlib.util.find_spec("matplotlib"):
            drawn, of_part = found.plot(self.frame).get_xlim3d(), self.frame[mask][:, 0]
            self.assertTrue(drawn[0] > of_part.min() - 0.2 and drawn[1] < of_part.max() + 0.2, "the table is not drawn")
        for wrong in (mask[:, :5], np.ones(5), [[1, 2]], [10**6]):
            self.assertRaisesRegex(ValueError, "indices", pcl_symmetry.planes, self.frame, indices=wrong)
        one = warned("points: .*distinct point", pcl_symmetry.planes, self.frame, indices=[int(np.flatnonzero(mask)[0])])
        self.assertIn("distinct point", one.reason)
        self.assertTrue(warned("points: no symmetry; if this is a whole frame", pcl_symmetry.planes, self.frame).possible)

    def test_a_scene_has_a_small_ball(self):
        """Of 800 pixels, all that is not the table."""
        v, u = np.indices((480, 640))
        rays = np.stack([(u - 320) / 525, (v - 240) / 525, np.ones(u.shape)], axis=2)
        up, height, radius = np.array([0, -0.825, -0.565]) / np.hypot(0.825, 0.565), -0.565, 0.03
        table = height / (rays @ up)
        for x in (-0.2, 0, 0.15):
            center = np.array([x, 0, 1.0]) + up * (height + radius - up[2])
            along, squares = rays @ center, (rays**2).sum(axis=2)
            root = np.sqrt(np.maximum(along**2 - squares * (center @ center - radius**2), 0))
            depth = np.where(root > 0, (along - root) / squares, np.where((table > 0) & (table < 3), table, 0))
            scene = pcl_symmetry.scene(pcl_symmetry.from_depth(depth, (525, 525, 320, 240)))
            np.testing.assert_array_equal(scene.labels == 1, root > 0, str(x))
            ball = scene[0]
            self.assertEqual([len(ball.planes.every), len(ball.planes.axes), len(ball.planes.centers)], [0, 0, 1], str(x))
            for found in (ball.planes.centers[0].point, ball.frame.center):
                np.testing.assert_allclose(found, center, atol=0.02 * radius)
            self.assertGreater(len(ball.added), 0.9 * len(ball.rows), "its far side")
            self.assert_follow(scene, "scene", file="-", timing_ms={})
            np.testing.assert_allclose(np.linalg.norm(ball.added - center, axis=1), radius, atol=0.03 * radius)

    def test_a_scene_has_objects_on_a_table(self):
        scene = pcl_symmetry.scene(self.frame)
        self.assertEqual((len(scene), len(scene.supports)), (2, 1))
        for k in (1, 2):
            found = scene.labels == next(i + 1 for i, each in enumerate(scene) if self.labels.ravel()[each.rows[0]] == k)
            self.assertGreater((found & (self.labels == k)).sum(), 0.9 * (self.labels == k).sum())
        for each in scene:
            self.assertTrue(each.planes and each.completed_by is not None and len(each.added) and each.frame)
            self.assertTrue(each.planes.to_dict()["partial"])
            self.assertIn("plane 1", each.planes.show(self.frame).html)
            if importlib.util.find_spec("matplotlib"):
                self.assertTrue(each.planes.plot(self.frame).collections)
        self.assertRegex(repr(scene), r"^Scene\(objects=\[SceneObject\(rows=\d+, planes=\[0.*\], added=\d+\), .*supports=\[")
        self.assertRaisesRegex(ValueError, r"planes\(points, indices=object.rows\) has it", scene[0].planes.point_support, 0)
        page = scene.show(self.frame)
        shown = json.loads(page.html.split('id="scene">')[1].split("</script>")[0])
        self.assertEqual(len(shown["panels"]), 3)
        self.assertIn("Scene(2 objects, 1 supporting plane)", page.html)
        if importlib.util.find_spec("matplotlib"):
            squares = sum(len(each.planes) for each in scene if not each.planes.axes)
            axes = scene.plot(self.frame)
            self.assertEqual(len(axes.collections), 1 + squares)
            self.assertEqual([text.get_text()[:9] for text in axes.get_legend().get_texts()], ["object 1:", "object 2:"])
            middle, up = self.frame[self.labels == 1].mean(axis=0), scene.supports[0].coefficients[:3]
            x, y, *_ = axes.get_proj() @ np.append(np.stack([middle, middle + 0.1 * up, middle + (0.1, 0, 0)], axis=1), np.ones((1, 3)), axis=0)
            self.assertTrue(y[1] - y[0] > 10 * abs(x[1] - x[0]) and x[2] - x[0] > 10 * abs(y[2] - y[0]), "seen from the sensor, upright")
        shifted = pcl_symmetry.scene(self.frame.astype(float) + (4e5, 5e6, 0), viewpoint=(4e5, 5e6, 0))
        self.assertEqual(len(shifted), 2)
        for wrong, options, words in (
            (self.frame[..., 2], {}, "from_depth"), (box(), {}, "viewpoint: of rows without order"),
            (Mesh(*box_mesh()), {}, "points: are a mesh, must be a cloud as a sensor sees it"),
            (self.frame, dict(min_points=3), "min_points = 3, must be >= 20"),
        ):  # fmt: skip
            self.assertRaisesRegex(ValueError, words, pcl_symmetry.scene, wrong, **options)
        rows = pcl_symmetry.Shape(self.frame.reshape(-1, 3), np.empty((0, 3), np.int32), None)
        self.assertEqual(len(pcl_symmetry.scene(rows)), 2, "a file without a viewpoint was seen from the origin")
        self.assertEqual(len(warned("points: no finite point within max_range", pcl_symmetry.scene, self.frame, max_range=0.01)), 0)
        nothing = warned("points: no finite point", pcl_symmetry.scene, np.full((24, 32, 3), np.nan))
        self.assertEqual(len(nothing), 0)
        if importlib.util.find_spec("matplotlib"):
            self.assertIsNone(nothing.plot(np.full((24, 32, 3), np.nan)).get_legend())

    def test_files_keep_their_order_and_viewpoint(self):
        viewpoint, (vertices, faces) = np.array([3.0, 2.0, 1.5]), box_mesh()
        rows = seen_half(box((1.0, 0.7, 0.4), 8000), viewpoint)
        self.write("frame.pcd", pcd(self.frame.reshape(-1, 3), 320))
        self.write("scan.pcd", pcd(rows, viewpoint=viewpoint))
        self.write("cut.pcd", pcd(rows)[:-9])
        self.write("box.OFF", off(vertices, faces))
        frame, scan, mesh = (pcl_symmetry.read(self.folder / each) for each in ("frame.pcd", "scan.pcd", "box.OFF"))
        for wrong, error, words in (
            ("none.pcd", FileNotFoundError, "none.pcd"),
            ("cut.pcd", ValueError, "cut.pcd: "),
            ("box.glb", ValueError, r"box.glb: unknown extension '.glb', must be .pcd, .ply, .off, .* or .csv; trimesh.load\(\) reads"),
        ):
            self.assertRaisesRegex(error, words, pcl_symmetry.read, self.folder / wrong)
        for name, content in {**meshes(xyz=XYZ.replace("float", "double")), "a.STL": SQUARE_STL}.items():
            same = pcl_symmetry.read(self.write(name, content))
            np.testing.assert_array_equal(same.points[same.faces[0]], CORNERS[:3], name)
        np.testing.assert_array_equal(pcl_symmetry.read(self.write("a.xyz", rows_of_text(points=CORNERS))).points, CORNERS)
        found, of_mesh, scene = pcl_symmetry.planes(scan), pcl_symmetry.planes(mesh), pcl_symmetry.scene(frame)
        by_name = [pcl_symmetry.planes(self.folder / each) for each in ("scan.pcd", "box.OFF")] + [pcl_symmetry.scene(str(self.folder / "frame.pcd"))]
        self.assertEqual(by_name, [found, of_mesh, scene])
        self.assertEqual(found.show(self.folder / "scan.pcd").html, found.show(scan).html)
        database = pcl_symmetry.Database(":memory:")
        report = database.build({"box": self.folder / "box.OFF", "none": str(self.folder / "none.pcd"), "scan": scan})
        self.assertEqual((database.names, [name for name, _ in report.failures]), (["box", "scan"], ["none"]))
        self.assertRegex(report.failures[0][1], "No such file or directory: .*none.pcd'$")
        np.testing.assert_array_equal(frame.points, self.frame)
        np.testing.assert_array_equal(np.asarray(frame), self.frame)
        self.assertEqual((frame.viewpoint, len(frame.faces), scan.points.dtype), (None, 0, np.float32))
        self.assertEqual((len(scene), pcl_symmetry.planes(frame, indices=self.labels == 1)._viewpoint_from), (2, "rays"))
        np.testing.assert_array_equal(scan.viewpoint, viewpoint)
        given = pcl_symmetry.planes(rows, viewpoint=viewpoint)
        self.assertEqual([p.confidence for p in found], [p.confidence for p in given])
        np.testing.assert_allclose(found.viewpoint, viewpoint, atol=1e-12)
        self.assertEqual(found.to_dict()["viewpoint"]["from"], "stored")
        self.assertIsNone(pcl_symmetry.planes(scan, viewpoint=None).viewpoint)
        self.assertEqual(pcl_symmetry.frame(scan), pcl_symmetry.frame(rows, viewpoint=viewpoint))
        pose = pcl_symmetry.register(scan, box(), seed=2)
        self.assertEqual(pose, pcl_symmetry.register(rows, box(), source_viewpoint=viewpoint, seed=2))
        alone = warned(r"points: no supporting plane .* planes\(\) takes it as a whole", pcl_symmetry.scene, scan)
        self.assertIsNotNone(alone.viewpoint, "which rows alone are asked for")
        among = dataclasses.replace(scan, viewpoint=np.zeros(3))
        self.assertEqual(pcl_symmetry.planes(among, approximate=True).viewpoint is None, pcl_symmetry.planes(rows).viewpoint is None, "cannot be")
        np.testing.assert_array_equal(mesh.faces, faces)
        self.assertEqual(of_mesh, pcl_symmetry.planes(Mesh(vertices, faces)))
        self.assertEqual(pickle.loads(pickle.dumps(mesh)), mesh)
        self.assertEqual(repr(scan), f"Shape(points={rows.shape}, faces=0, viewpoint=[3, 2, 1.5])")

    def test_a_scan_has_no_group_of_rotations_but_a_reason(self):
        viewpoint = np.array([3.0, 2.0, 1.5])
        stored = pcl_symmetry.Shape(seen_half(box(num_points=8000), viewpoint), np.empty((0, 3), np.int32), viewpoint)
        for scan in (self.frame[self.labels == 1], self.alone, stored):
            found = warned("points: a scan from one side, must be a whole object", pcl_symmetry.rotations, scan)
            self.assertEqual((bool(found), found.name, found.confidence, found.reason[:6]), (False, "", 0, "a scan"))

    def test_a_database_names_what_is_in_a_frame(self):
        database = pcl_symmetry.Database(":memory:")
        database.build({"first": box((0.3, 0.3, 0.25)), "second": box((0.25, 0.2, 0.15)), "bar": bar()})
        self.assert_follow({"models": [each.to_dict() for each in database.recognize(self.frame, indices=self.labels == 1)], "known": True}, "recognition", file="")
        self.assert_follow(pcl_symmetry.scene(self.frame, database=database), "scene", file="-", timing_ms={})
        self.assertEqual(database.names, ["bar", "first", "second"])
        recognized = database.recognize(self.frame, indices=self.labels == 1, min_confidence=0.0)
        self.assertEqual(recognized[0].name, "first")
        self.assertEqual(len(database.match(self.alone)), 3)

    def assert_follow(self, found, schema, **only_of_tools):
        """The JSON of a result, or of a dict, is that of the tools."""
        text = found.to_json() if hasattr(found, "to_json") else json.dumps(found)
        self.assert_follows({**json.loads(text, parse_constant=self.fail), **only_of_tools}, schema)

    def test_results_have_the_json_of_the_tools(self):
        only = dict(file="-", timing_ms={})
        z, y, x = np.indices((40, 40, 40)) - 19.5
        points = [box(), points_on_sphere(3000), lamp(), self.alone]
        searches = [pcl_symmetry.planes(each, approximate=True) for each in points]
        searches.append(pcl_symmetry.planes(volume=(x**2 + 2 * y**2 + 3 * z**2 < 300).astype(float)))
        searches.append(warned("points: ", pcl_symmetry.planes, np.zeros((9, 3))))
        for found in searches:
            self.assert_follow(found, "planes", **only)
        of_scan = json.loads(searches[3].to_json())
        self.assertEqual((of_scan["viewpoint"]["from"], of_scan["num_points"]), ("rays", (self.labels == 1).sum()))
        np.testing.assert_array_equal(of_scan["planes"][0]["coefficients"], searches[3][0].coefficients)
        for each in points:
            frame = pcl_symmetry.frame(each)
            self.assert_follow(frame, "frame", timing_ms={})
            np.testing.assert_array_equal(json.loads(frame.to_json())["axes"][1], frame.axes[:, 1])
            symmetries = json.loads(pcl_symmetry.rotations(each).to_json())
            extent = {name: 1.0 for name in "diameter min_x min_y min_z size_x size_y size_z".split()}
            self.assert_follow({"1": {**extent, **{k: v for k, v in symmetries.items() if k.startswith("symm")}}}, "models_info")
        view = pcl_symmetry.viewpoints(box())[0]
        self.assert_follow(dict(up=[0, 0, 1], best=view.to_dict(), worst=view.to_dict(), good=[]), "views", **only)
        self.assert_follow(pcl_symmetry.register(self.alone, box((0.3, 0.3, 0.25))), "pose", fitness=0.0, timing_ms={})
        scans = [box(seed=1), box(seed=2) + np.float32(1), np.array([[0, 0, k] for k in range(500)])]
        merged = pcl_symmetry.register_all(scans, viewpoint=None)
        self.assertEqual((len(merged), len(list(merged)), merged[2]), (3, 3, None))
        self.assert_follow(merged, "merged", timing_ms={})
        self.assert_follow(pcl_symmetry.scene(self.frame), "scene", **only)
        self.assert_follow(pcl_symmetry.Database(":memory:").build({"box": box(), "words": "none"}), "database_build")


class ImagesAndMeshes(unittest.TestCase):
    def test_depth_images_become_points_in_the_frame_of_the_camera(self):
        depth, _ = table()
        points = pcl_symmetry.from_depth(depth, INTRINSICS)
        self.assertEqual((points.shape, points.dtype), ((240, 320, 3), np.float32))
        np.testing.assert_array_equal(np.isnan(points[..., 2]), depth == 0)
        fx, fy, cx, cy = INTRINSICS
        v, u = np.indices(depth.shape)
        seen = depth > 0
        np.testing.assert_allclose((fx * points[..., 0] / points[..., 2] + cx)[seen], u[seen], atol=1e-3)
        np.testing.assert_allclose((fy * points[..., 1] / points[..., 2] + cy)[seen], v[seen], atol=1e-3)
        matrix = [[fx, 0, cx], [0, fy, cy], [0, 0, 1]]
        millimeters = pcl_symmetry.from_depth((1000 * depth).round().astype(np.uint16), matrix, unit=0.001)
        np.testing.assert_allclose(millimeters[seen], points[seen], atol=1e-3)
        warned("unit=0.001 makes meters of millimeters", pcl_symmetry.from_depth, np.full((4, 4), 700, np.uint16), matrix)
        of_open3d = lambda **size: types.SimpleNamespace(intrinsic_matrix=matrix, **size)
        for *wrong, error, words in (
            (depth[0], INTRINSICS, ValueError, "depth = array of shape"),
            (depth, (0, 300, 1, 1), ValueError, "fx and fy > 0"),
            (depth, np.eye(4), ValueError, "intrinsics = "),
            (depth, of_open3d(width=640, height=480), ValueError, r"depth = .* \(240, 320\), must be \(480, 640\), that of the intrinsics"),
            ("a.png", INTRINSICS, TypeError, "depth = 'a.png', must be .* read files"),
        ):
            self.assertRaisesRegex(error, words, pcl_symmetry.from_depth, *wrong)
        for size in ({}, dict(width=320, height=240), dict(width=-1, height=-1)):
            np.testing.assert_array_equal(pcl_symmetry.from_depth(depth, of_open3d(**size)), points)

    def test_answers_index_what_was_given(self):
        mesh = bar()
        self.assertEqual(pcl_symmetry.segment(mesh).shape, (len(mesh.faces),))
        plane = pcl_symmetry.planes(mesh)[0]
        self.assertEqual(len(plane.pairs(mesh)[0]), len(mesh.vertices))
        self.assertEqual(pcl_symmetry.local_symmetry(mesh, 1.0).shape, (len(mesh.vertices),))
        vertices, faces = bumped(40, 80, 0.0, 0.5)
        half = Mesh(vertices[vertices[:, 0] > -0.2], [(0, 1, 2)])
        _, rows = pcl_symmetry.complete(half, pcl_symmetry.ReflectionPlane((1, 0, 0), 0.0), viewpoint=None)
        self.assertTrue(100 < max(rows) < len(half.vertices))
        found = pcl_symmetry.planes(mesh)
        self.assertEqual((found.samples.shape, found.point_support(0).shape), ((10_000, 3), (10_000,)))
        self.assertIn("plane 3", found.show(mesh).html)
        self.assertEqual(pcl_symmetry.sample_mesh(mesh).shape, (10_000, 3))

    @needs("open3d", "matplotlib")
    def test_objects_of_open3d_pass_everywhere(self):
        import open3d

        points = box(num_points=2000).astype(float)
        plain = pcl_symmetry.planes(points)
        cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points))
        mesh = open3d.geometry.TriangleMesh.create_box(1.0, 2.0, 3.0)
        objects = {"cloud": cloud, "mesh": mesh, "rows": cloud.points}
        self.assertEqual(pcl_symmetry.sample_mesh(mesh.vertices, mesh.triangles, 500).shape, (500, 3))
        self.assertEqual(len(pcl_symmetry.segment(mesh.vertices, mesh.triangles)), len(mesh.triangles))
        if hasattr(open3d, "t"):
            objects["tensor cloud"] = open3d.t.geometry.PointCloud.from_legacy(cloud)
            objects["tensor mesh"] = open3d.t.geometry.TriangleMesh.from_legacy(mesh)
        for name, each in objects.items():
            with self.subTest(name):
                found = pcl_symmetry.planes(each)
                self.assertEqual(len(found), 3)
                if name == "cloud":
                    self.assertEqual([p.coefficients.tolist() for p in found], [p.coefficients.tolist() for p in plain])
                self.assertIn("plane 3", found.show(each).html)
                found.plot(each)
                pcl_symmetry.frame(each).plot(each)
                self.assertEqual(pcl_symmetry.rotations(each).name, "D2")
                pcl_symmetry.segment(each)
                pcl_symmetry.describe(each)
                found[0].pairs(each)
                pcl_symmetry.symmetrize(each, found[0])
                if has_pcl():
                    report = pcl_symmetry.Database(":memory:").build({name: each})
                    self.assertEqual((report.num_added, report.failures), (1, []))

    def test_answers_are_false_where_there_is_no_symmetry(self):
        """Noise of half of the tolerance beside a bump: the plane may be one."""
        blob = points_on_sphere(4000, 3)
        blob *= 1 + 0.3 * np.sin(3 * blob @ (1, 2, 0.5))[:, None] + 0.2 * blob[:, :1] * blob[:, 1:2]
        found = pcl_symmetry.planes(blob)
        self.assertFalse(found, found)
        self.assertEqual({plane.kind for plane in found.possible} - {"possible"}, set())
        every = pcl_symmetry.planes(blob, approximate=True)
        self.assertFalse(every)
        self.assertTrue(every.approximate)
        plane = every.approximate[0]
        self.assertRaisesRegex(ValueError, "plane.kind = .*, must be symmetry or possible", pcl_symmetry.complete, blob, plane)
        as_they_are = [plane.coefficients, plane.coefficients.tolist(), pcl_symmetry.ReflectionPlane(plane.normal, plane.offset)]
        rows = {pcl_symmetry.complete(blob, each)[1].tobytes() for each in as_they_are}
        self.assertEqual(len(rows), 1)
        self.assertEqual([len(each) for each in warned("no symmetry, nothing is added", pcl_symmetry.complete, blob)], [0, 0])
        self.assertEqual([each["kind"] for each in json.loads(every.to_json())["planes"]], [each.kind for each in every.approximate])

    def test_answers_cannot_be_written_into(self):
        found = pcl_symmetry.planes(box())
        for array in (found[0].normal, found._rows, pcl_symmetry.frame(box()).axes, pcl_symmetry.ReflectionPlane((1, 0, 0), 1).normal,
                      found[0].coefficients, found[0].reflection):  # fmt: skip
            self.assertRaisesRegex(ValueError, "read-only", array.fill, 0)
        self.assertTrue(pcl_symmetry.symmetrize(box(), found[0]).points.flags.writeable, "as Open3D needs it")


class LongCalls(ToolTest):
    CALLS = {
        "local_symmetry": lambda s, p: s.local_symmetry(p, 1.0),
        "transform": lambda s, p: [s.transform(p, (96, 96, 96), method="rotational", seed=i) for i in range(99)],
        "planes": lambda s, p: [s.planes(p, seed=i) for i in range(999)],
        "rotations": lambda s, p: [s.rotations(p, seed=i) for i in range(999)],
        "segment": lambda s, p: [s.segment(p, seed=i) for i in range(999)],
        "descriptors": lambda s, p: [s.descriptors(p, seed=i) for i in range(999)],
        "pairs": lambda s, p: [s.ReflectionPlane((1, 0.1, 0), 0).pairs(p) for i in range(999)],
    }

    def seconds_to_stop(self, call, after=0.3):
        sent = []
        old = signal.signal(signal.SIGINT, signal.default_int_handler)  # a shell's background ignores it
        self.addCleanup(signal.signal, signal.SIGINT, old)

        def interrupt():
            time.sleep(after)
            sent.append(time.monotonic())
            os.kill(os.getpid(), signal.SIGINT)

        threading.Thread(target=interrupt).start()
        self.assertRaises(KeyboardInterrupt, call)
        return time.monotonic() - sent[0]

    def test_end_with_ctrl_c(self):
        points = box(num_points=60_000)
        for name, call in self.CALLS.items():
            seconds = self.seconds_to_stop(lambda: call(pcl_symmetry, points))
            self.assertLess(seconds, 2.0, name)  # four times the limit on an idle machine

    @needs_pcl
    def test_keep_what_they_built(self):
        path = self.folder / "models.db"
        models = {f"{i:04}": box((1, 0.5 + 0.001 * i, 0.3), 2000, i) for i in range(400)}
        with pcl_symmetry.Database(path, create=True) as database:
            self.seconds_to_stop(lambda: database.build(models), after=0.5)
            stored = database.names
        self.assertTrue(0 < len(stored) < len(models), len(stored))
        with pcl_symmetry.Database(path) as database:
            self.assertEqual(database.names, stored)
            self.assertEqual(len(database.match(models[stored[0]], 1)), 1)
            few = {name: models[name] for name in list(models)[: len(stored) + 2]}
            self.assertEqual(database.build(few).failures, [])

    def test_tell_their_progress(self):
        calls = [(pcl_symmetry.local_symmetry, box(num_points=200), 1.0), (pcl_symmetry.segment, box(num_points=2000))]
        if has_pcl():
            calls += [(pcl_symmetry.register, lamp(), lamp(seed=5)), (pcl_symmetry.register_all, [lamp(), lamp(seed=5)])]
        for function, *arguments in calls:
            shares = []
            function(*arguments, progress=shares.append)
            self.assertTrue(shares and 0 <= min(shares) and max(shares) <= 1, function.__name__)
            if function is pcl_symmetry.local_symmetry:  # of the others several loops tell theirs
                self.assertEqual(shares, sorted(shares), function.__name__)
        self.assertRaises(ZeroDivisionError, pcl_symmetry.local_symmetry, box(num_points=600), 1.0, progress=lambda share: 1 / 0)
        self.assertRaisesRegex(TypeError, "progress = str", pcl_symmetry.planes, box(), progress="yes")
        pcl_symmetry.planes(box(), progress=True)


class Pages(ToolTest):
    def picture(self, page, size=(700, 500)):
        """(H, W, 3) pixels of a page in a browser, in [0, 1]."""
        import matplotlib.image

        path = self.write("page.html", page)
        flags = ["--headless", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        shot = [f"--window-size={size[0]},{size[1]}", "--virtual-time-budget=8000", f"--screenshot={self.folder}/page.png", f"file://{path}"]
        subprocess.run(["chromium", *flags, f"--user-data-dir={self.folder}/user", *shot], check=True, capture_output=True, timeout=300)
        return matplotlib.image.imread(f"{self.folder}/page.png")[..., :3]

    @needs("matplotlib")
    @unittest.skipUnless(shutil.which("chromium"), "no browser (Debian package chromium)")
    def test_show_support_in_colors(self):
        """Yellow where a point has a counterpart, with and without normals; an axis is seen in front of what hides it."""
        points = box()
        vertices, quads = turned([(0.3, 0), (0.3, 1)], 96)
        can = pcl_symmetry.sample_mesh(vertices, triangles(quads), 20_000)
        pages = {"module": (pcl_symmetry.planes(points).show(points).html, (700, 500))}
        if os.environ.get("TOOLS"):
            self.write("box.pcd", pcd(points))
            self.run_tool("box.pcd -html box.html -quiet", tool="planes")
            pages["tool"] = (self.text("box.html"), (420, 700))
        for name, (page, size) in pages.items():
            red, green, blue = np.moveaxis(self.picture(page, size), 2, 0)
            yellow = ((red > 0.55) & (green > 0.45) & (blue < 0.6 * red)).sum()
            black = ((red < 0.1) & (green < 0.1) & (blue < 0.1)).sum()
            self.assertGreater(yellow, 5000, (name, size))
            self.assertLess(black, 0.1 * yellow, (name, size))
        red, green, blue = np.moveaxis(self.picture(pcl_symmetry.planes(can).show(can).html), 2, 0)
        rod = (red > 0.6) & (green < 0.6 * red) & (blue < 0.4 * red)
        self.assertGreater(rod[:, : rod.shape[1] // 2].any(axis=1).sum(), 100, "rows of pixels that show the axis")


@needs_pcl
class Example(ToolTest):
    def test_of_typical_use_runs(self):
        example = Path(__file__).resolve().parents[2] / "apps/examples/14_depth_camera.py"
        ran = subprocess.run([sys.executable, "-B", example, self.folder], capture_output=True, text=True)
        self.assertEqual(ran.returncode, 0, ran.stderr)
        self.assertIn("3 models stored, 3 in all\nobject 1: ", ran.stdout)
        self.assertIn("is large, confidence", ran.stdout)
        self.assertLessEqual({"models.db", "object_1.npy", "scene.html"}, set(os.listdir(self.folder)))
        depth = self.folder / "dome.npy"
        np.save(depth, table((), 0.1)[0])
        ran = subprocess.run([*ran.args, depth, *map(str, INTRINSICS)], capture_output=True, text=True)
        self.assertRegex(ran.stdout, r"  body of revolution about (.|\n)*mask: 0 planes, [1-9]", ran.stderr)
