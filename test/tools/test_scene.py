"""The tool of scenes: objects on a table, bodies that touch, vehicles around a LiDAR, and what is written of them."""
from tool_run import TETRAHEDRON, Image, ToolTest, np, pcd, ply_points, points_on_box, rotation, xyz

EYE = np.array([0.1, -1.6, 1.0])
TABLE = (0, 0, -0.02), (0.7, 0.7, 0.02)  # center and half size
BOXES = ((-0.35, 0.2, 0.12), (0.2, 0.1, 0.12)), ((0.4, -0.25, 0.1), (0.12, 0.08, 0.1))  # apart, with room between them in the picture
FEW = "-max_points 1000"  # to save time


def camera(eye, target, width, height, focal, roll=0.0):
    """The rays of all pixels, row by row; their depth is 1."""
    forward = (np.array(target) - eye) / np.linalg.norm(np.array(target) - eye)
    right = np.cross(forward, [0, 0, 1])
    right = rotation(forward, roll) @ right / np.linalg.norm(right)
    y, x = np.divmod(np.arange(width * height), width)
    return forward + np.outer((x - (width - 1) / 2) / focal, right) + np.outer((y - (height - 1) / 2) / focal, np.cross(forward, right))


RAYS = camera(EYE, (0, 0, 0), 320, 240, 190)


def block(center, half, turn=0.0):
    """A body, as the distances at which rays meet it, in their lengths: a box, turned about z."""
    back = rotation((0, 0, 1), -turn)

    def hits(eye, rays):
        eye, rays = back @ (eye - np.array(center)), rays @ back.T
        with np.errstate(divide="ignore", invalid="ignore"):
            a, b = ((side * np.array(half) - eye) / rays for side in (-1, 1))
        enters, leaves = np.minimum(a, b).max(axis=1), np.maximum(a, b).min(axis=1)
        return np.where((enters <= leaves) & (enters > 0), enters, np.inf)
    return hits


def cone(axis, radius, slope, low, high, lid=False):
    """The wall of an upright cone or cylinder, seen from outside and inside, perhaps with a lid."""
    def hits(eye, rays):
        origin, along = eye[:2] - axis, rays[:, :2]
        u, w = radius + slope * eye[2], slope * rays[:, 2]
        a, b = (along ** 2).sum(axis=1) - w ** 2, along @ origin - u * w
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(b ** 2 - a * (origin @ origin - u ** 2))
            found = np.stack([(-b - root) / a, (-b + root) / a, np.where(lid, (high - eye[2]) / rays[:, 2], np.nan)])
            at = eye + found[..., None] * rays
            on_wall = (found[:2] > 0) & (at[:2, :, 2] >= low) & (at[:2, :, 2] <= high)
            on_lid = (found[2:] > 0) & (np.hypot(*np.moveaxis(at[2:, :, :2] - axis, -1, 0)) <= radius + slope * high)
        return np.where(np.vstack([on_wall, on_lid]), found, np.inf).min(axis=0)
    return hits


def look(eye, rays, bodies):
    """The points that rays meet first, NaN where they meet none, and the body of each; -1: none."""
    distances = np.stack([body(eye, rays) for body in bodies])
    nearest = distances.min(axis=0)
    with np.errstate(invalid="ignore"):
        points = np.where(np.isfinite(nearest)[:, None], eye + nearest[:, None] * rays, np.nan)
    return points, np.where(np.isfinite(nearest), distances.argmin(axis=0), -1)


POINTS, IDS = look(EYE, RAYS, [block(*TABLE), *(block(*box) for box in BOXES)])


def with_depth_errors(window=1):
    """The errors of structured light: 1.4 mm at 1 m, growing with the square of the depth; means over squares of pixels, as of
    sensors that match windows."""
    deviates = np.random.default_rng(5).normal(size=(240 + window, 320 + window))
    means = sum(deviates[i:i + 240, k:k + 320] for i in range(window) for k in range(window)) / window
    offsets = POINTS - EYE
    depth = offsets @ (-EYE / np.linalg.norm(EYE))
    return EYE + (1 + 1.4e-3 * depth * means.ravel())[:, None] * offsets


class SceneObjects(ToolTest):
    tool = "scene"

    def found(self, content, flags="-no_frames", num_objects=None):
        """The report, and the points of the completed scene with the number of their object; num_objects: on one supporting plane."""
        self.write("s.pcd", content)
        report = self.report("s.pcd out.ply", FEW, flags, "-quiet")
        if num_objects is not None:
            self.assertEqual([len(report["supports"]), len(report["objects"])], [1, num_objects])
        points, _ = ply_points(self.folder / "out.ply")
        return report, xyz(points), points["object"], points["completed"]

    def assert_planes_across_axes(self, report):
        """Boxes of three different sides have no other planes."""
        for item in report["objects"]:
            for plane in item["planes"]:
                if plane["kind"] == "symmetry":
                    self.assertGreater(np.abs(plane["coefficients"][:3]).max(), np.cos(np.radians(3)))

    def test_stand_on_the_table_with_their_feet(self):
        report, points, numbers, completed = self.found(pcd(POINTS, 320), "", 2)
        self.assertEqual(report["viewpoint"]["from"], "rays")
        np.testing.assert_allclose(report["supports"][0]["coefficients"], (0, 0, 1, 0), atol=1e-5, err_msg="toward the viewer; no noise")
        near = 0.25 * report["plane_distance"]
        seen = completed == 0
        boxes = set()
        for k, item in enumerate(report["objects"], 1):
            own = points[seen & (numbers == k)]
            # Points of one box and none of the table.
            box, = (i for i, (center, half) in enumerate(BOXES) if (abs(own - center) < np.array(half) + 1e-4).all())
            boxes.add(box)
            self.assertLess(own[:, 2].min(), near, "rows of pixels are as far apart")
            self.assertLess(np.linalg.norm(np.array(item["frame"]["center"]) - BOXES[box][0]), 0.25 * np.linalg.norm(BOXES[box][1]))
        self.assertEqual(boxes, {0, 1})
        self.assert_planes_across_axes(report)
        on_table = points[seen & (numbers == -1)]
        self.assertLessEqual((on_table[:, 2] > near).sum(), 8, "single pixels on the sides of the boxes, far from their other points")

    def test_are_completed_into_space_that_was_not_seen(self):
        report, points, numbers, completed = self.found(pcd(POINTS, 320))
        for k, item in enumerate(report["objects"], 1):
            self.assertEqual("completed" in item, bool(item["planes"]) and item["planes"][0]["kind"] == "symmetry")
            added = points[(completed == 1) & (numbers == k)]
            self.assertEqual(len(added), item.get("completed", {"num_added": 0})["num_added"])
            first = np.min([block(*body)(EYE, added - EYE) for body in (TABLE, *BOXES)], axis=0)
            in_front = (first - 1) * np.linalg.norm(added - EYE, axis=1) > 0.05
            self.assertLessEqual(in_front.sum(), 0.02 * len(added))

    def test_are_completed_by_the_sure_plane_that_adds_most(self):
        """The best plane of a box seen from a corner lies along the view and adds nothing."""
        picture = look(EYE, RAYS, [block(*TABLE), block((0, 0, 0.2), (0.3, 0.3, 0.2), 0.45)])[0]
        _, points, numbers, completed = self.found(pcd(picture, 320), num_objects=1)
        added = points[completed == 1]
        self.assertGreater(len(added), 0.4 * ((numbers == 1) & (completed == 0)).sum())
        own = (added - (0, 0, 0.2)) @ rotation((0, 0, 1), 0.45)
        self.assertLess(np.median(abs((abs(own) / (0.3, 0.3, 0.2)).max(axis=1) - 1)), 0.02, "on its faces")

    def test_have_the_plane_whose_far_half_is_hidden_with_every_seed(self):
        eye, turn = np.array([0.35, -1.15, 0.92]), rotation((0, 0, 1), 0.6)
        bodies = [block((0, 0, -0.02), (0.5, 0.4, 0.02)), block((0, 0, 0.06), (0.1, 0.06, 0.06), 0.6)]
        points, _ = look(eye, camera(eye, (0, 0, 0), 320, 240, 420), bodies)
        deviates = np.random.default_rng(1).normal(size=(len(points), 1))
        self.write("s.pcd", pcd(eye + (1 + 0.0005 * deviates) * (points - eye), 320))
        for seed in (4, 5, 6):
            item, = self.report(f"s.pcd -no_frames -no_completion -seed {seed}")["objects"]
            normals = [plane["coefficients"][:3] for plane in item["planes"] if plane["kind"] == "symmetry"]
            self.assertGreater(np.abs(normals @ turn[:, 1]).max(), 0.999, seed)

    def test_are_decided_through_the_errors_of_a_camera(self):
        report, *_ = self.found(pcd(with_depth_errors(), 320), num_objects=2)
        self.assertEqual([item["planes"][0]["kind"] for item in report["objects"]], ["symmetry", "symmetry"], "left and right of a box")
        self.assert_planes_across_axes(report)

    def test_are_the_same_of_an_unorganized_scene(self):
        finite = POINTS[np.isfinite(POINTS).all(axis=1)]
        report, *_ = self.found(pcd(finite, len(finite), viewpoint=EYE), num_objects=2)
        self.assertEqual(report["viewpoint"]["from"], "stored")

    def test_are_the_same_in_any_unit(self):
        def answers(unit):
            report, *_ = self.found(pcd(unit * POINTS, 320), num_objects=2)
            return [[plane["confidence"] for plane in item["planes"]] for item in report["objects"]]
        expected = answers(1.0)
        for unit in (1024.0, 1.0 / 1024.0):
            self.assertEqual(answers(unit), expected)

    def test_are_neither_tables_nor_bulges_nor_parts_of_a_large_box(self):
        self.found(pcd(look(EYE, camera(EYE, (0, 0, 0), 160, 120, 94), [block(*TABLE)])[0], 160), num_objects=0)
        # 45 mm high, as stereo cameras measure walls in waves; more than three times what belongs to the plane.
        bulged = POINTS.copy()
        bulged[IDS == 0, 2] += 0.045 * np.exp(-((POINTS[IDS == 0, :2] - (-0.2, -0.35)) ** 2).sum(axis=1) / 0.15 ** 2)
        self.found(pcd(bulged, 320), num_objects=2)
        # Its front is more than half of the picture; what lies behind the front is the rest of the box.
        eye = np.array([0.8, -2.5, 1.2])
        box, ids = look(eye, camera(eye, (0, 0, 0), 160, 120, 110), [block((0, 0, 0), (1, 0.7, 0.45))])
        (item,) = self.found(pcd(box, 160))[0]["objects"]
        self.assertGreater(item["num_points"], 0.9 * (ids == 0).sum())

    def test_are_the_same_for_any_number_of_threads(self):
        self.write("s.pcd", pcd(POINTS, 320))
        for k in (1, 2):
            own = POINTS[IDS == k]
            self.write(f"box{k}.pcd", pcd(own, len(own)))
        self.run_tool("build models.db box1.pcd box2.pcd -quiet", tool="database")

        def report(threads):
            found = self.report(f"s.pcd -quiet {FEW} -database models.db -accept 0 -threads {threads}")
            return {**found, "timing_ms": {}, "made_by": {}}

        one = report(1)
        self.assertTrue(one["objects"][0]["models"])
        strict = self.report(f"s.pcd -quiet {FEW} -database models.db -accept 1")["objects"]
        self.assertEqual({each["model_reason"] for each in strict}, {"none of 2 reaches a confidence of 1"})
        self.assertEqual(self.output.count(", no model fits: none of 2 reaches a confidence of 1"), len(strict))
        for threads in (2, 3):  # with 3, one object after the other
            self.assertEqual(report(threads), one)

    def bodies(self, *bodies):
        """The report of bodies on a table, and of each object the body of most of its points and the share of it."""
        eye = np.array([0.25, -0.75, 0.6])
        rays = camera(eye, (0, 0, 0.05), 640, 480, 700)
        points, ids = look(eye, rays, [*bodies, block((0, 0, -1), (0.5, 0.5, 1))])
        report, _, numbers, completed = self.found(pcd(points, 640))
        shares = []
        for k in range(1, len(report["objects"]) + 1):
            counts = np.bincount(ids[ids >= 0][numbers[completed == 0] == k])
            shares.append((int(counts.argmax()), counts.max() / counts.sum()))
        return report, shares

    def test_are_apart_where_two_bodies_touch(self):
        for bodies in ((block((-0.1, 0, 0.1), (0.1, 0.06, 0.1)), block((0.08, -0.02, 0.05), (0.08, 0.1, 0.05))),
                       (block((0, 0, 0.05), (0.15, 0.12, 0.05)), block((0.01, 0.02, 0.15), (0.08, 0.06, 0.05), 0.4)),
                       (cone((0, 0.1), 0.07, 0, 0, 0.2, lid=True), block((0, -0.03, 0.05), (0.1, 0.06, 0.05)))):
            report, shares = self.bodies(*bodies)
            self.assertEqual({body for body, _ in shares}, {0, 1})
            self.assertGreater(min(share for _, share in shares), 0.95)
            junction, = report["junctions"]
            self.assertEqual((junction["joined"], sorted(junction["objects"])), (False, [1, 2]))
            self.assertTrue(0 <= junction["apart"] and junction["together"] <= 1)
            self.assertIn(" explains ", self.output)
            together = self.report("s.pcd", "-no_frames -no_separation", FEW)
            self.assertEqual([len(together["objects"]), together["junctions"]], [1, []])

    def test_are_one_with_a_handle_or_an_inside(self):
        report, _ = self.bodies(cone((0, 0), 0.08, 0, 0, 0.2, lid=True), block((0.12, -0.04, 0.11), (0.06, 0.012, 0.06), -0.3))
        junction, = report["junctions"]  # convexity cuts the handle off
        self.assertTrue(junction["joined"])
        self.assertGreater(junction["together"], 0.9)
        mug, = report["objects"]
        self.assertEqual((mug["planes"][0]["kind"], mug["axes"]), ("symmetry", []), "through the handle")
        bowl, _ = self.bodies(cone((0, 0), 0.05, 0.5, 0, 0.16))  # its inside bends inward everywhere
        for item in bowl["objects"]:
            self.assertGreater(item["num_points"], 5000, "in a piece")

    def test_stand_on_the_ground_that_is_given(self):
        report, *_ = self.found(pcd(POINTS, 320), "-no_frames -ground 0,0,-2,0", 2)
        self.assertEqual(report["supports"][0]["coefficients"], [0, 0, 1, 0], "toward the viewer")


class Scene(ToolTest):
    tool = "scene"
    files = dict(scene=("scene.pcd", pcd(POINTS, 320, rgb=np.full(len(POINTS), 200 << 16))))

    def test_writes_what_it_finds(self):
        report = self.report(self.scene, "completed.ply -max_points 1000 -png objects.png -html page.html")
        count = np.isfinite(POINTS).all(axis=1).sum()
        self.assertEqual((self.output.splitlines()[0], report["num_points"]), ("1 supporting plane, 2 objects", count))
        self.assertEqual([len(report[key]) for key in ("objects", "supports", "junctions")], [2, 1, 0], "the boxes do not touch")
        self.assertEqual({len(item["frame"]["transform"]) for item in report["objects"]}, {16})
        self.assertGreater(min(item["num_points"] for item in report["objects"]), 300)
        num_added = sum(item.get("completed", {"num_added": 0})["num_added"] for item in report["objects"])
        self.assertEqual(len(ply_points(self.folder / "completed.ply")[0]), count + num_added)
        self.assertGreater(min(Image.open(self.folder / "objects.png").size), 100)
        page = self.text("page.html")
        for part in ("1 supporting plane, 2 objects", "</html>", '"picture":{"pixels":"yAAA', "2: ", "decided at 1.0 % of the diameter"):
            self.assertIn(part, page)
        (self.folder / "again.pcd").write_bytes((self.folder / self.scene).read_bytes())
        self.run_tool("*.pcd", "{}.ply -max_points 1000 -json o.jsonl -csv o.csv")
        self.assertEqual([line["objects"] for line in self.lines("o.jsonl")], 2 * [report["objects"]], "of many, each as alone")
        self.assertEqual((self.folder / "again.ply").read_bytes(), (self.folder / "completed.ply").read_bytes())
        self.assertEqual(len(self.text("o.csv").splitlines()), 5)

    def test_reads_depth_images(self):
        depth = (POINTS - EYE) @ (-EYE / np.linalg.norm(EYE))
        values = np.round(5000 * np.nan_to_num(depth)).astype(np.uint16).reshape(240, 320)
        Image.fromarray(values).save(self.folder / "depth.png")
        report = self.report("depth.png out.ply", FEW, "-intrinsics 190,190,159.5,119.5 -depth_scale 5000 -no_completion")
        self.assertEqual([len(report["supports"]), len(report["objects"]), report["viewpoint"]["from"]], [1, 2, "rays"])
        of_camera = xyz(ply_points(self.folder / "out.ply")[0])
        seen = POINTS[np.isfinite(depth)] - EYE
        np.testing.assert_allclose(np.linalg.norm(of_camera, axis=1), np.linalg.norm(seen, axis=1), atol=2e-4)
        np.testing.assert_allclose(np.diff(of_camera, axis=0) ** 2 @ np.ones(3), np.diff(seen, axis=0) ** 2 @ np.ones(3), atol=1e-3)
        self.fails(2, "a depth image needs -intrinsics FX,FY,CX,CY", "depth.png")
        self.fails(1, f"{self.scene}: is no depth image", self.scene, "-intrinsics 190,190,159.5,119.5")

    def test_says_what_its_planes_have_their_confidence_from(self):
        self.run_tool(self.scene, FEW, "-explain")
        self.assertRegex(self.output, r"\nobject 1\nplane 1: symmetry, confidence 0[.]\d+\n  [\d.]+ % of the surface within ")
        self.assertNotIn("warning", self.error)

    def test_warns_of_one_object_alone(self):
        points = look(EYE, RAYS, [block(*BOXES[0])])[0]
        self.run_tool(self.write("box.pcd", pcd(points[np.isfinite(points).all(axis=1)], viewpoint=EYE)), FEW)
        self.assertIn("box.pcd: no supporting plane (table, floor, wall) was found; if this is one object, pcl_symmetry_planes", self.error)
        self.run_tool(self.write("all.pcd", pcd(points_on_box((2, 2, 2), 20_000))))
        self.assertIn("all.pcd: no supporting plane is much wider than the object; if this is one object, pcl_symmetry_planes", self.error)

        slopes = (np.mgrid[:60, :80] - np.array([29.5, 39.5])[:, None, None]) / 80
        across = np.hypot(*slopes)  # a wave around the middle of a picture without background, tops of which are clusters
        depth = np.where(across < 0.3, 1 - 0.12 * np.cos(25 * across), np.nan)
        wave = np.stack([slopes[1] * depth, slopes[0] * depth, depth], axis=2).reshape(-1, 3)
        self.run_tool(self.write("wave.pcd", pcd(wave, 80)))
        self.assertIn("wave.pcd: no point is near the border of the picture; if this is one object, pcl_symmetry_planes", self.error)

    def test_is_named_where_planes_has_the_whole_frame(self):
        report = self.report(self.scene, tool="planes")
        self.assertNotIn("symmetry", {plane["kind"] for plane in report["planes"]})
        self.assertIn("if this is a whole frame, pcl_symmetry_scene finds its objects", self.error)
        self.report(self.scene, "-viewpoint none", tool="planes")
        self.assertNotIn("pcl_symmetry_scene", self.error)

    def test_refuses_what_is_no_scene(self):
        mesh = self.write("t.off", TETRAHEDRON)
        self.fails(1, f"{mesh}: is a mesh, must be a cloud as a sensor sees it", mesh)
        self.fails(1, "none.db", self.scene, "-database none.db")
        self.fails(2, "-ground = 0,0,1, must be four numbers A,B,C,D", self.scene, "-ground 0,0,1")
        for arguments in ((self.scene, "-min_points 3"), (self.scene, "out.txt"), ()):
            self.run_tool(*arguments, code=2)


class PartsOfAFrame(ToolTest):
    """The planes of the pixels of a frame that have a label."""
    tool = "planes"

    def box(self, points, label, flags=""):
        return self.report(self.write("f.pcd", pcd(points, 320, label=np.maximum(IDS, 0))), f"-label {label} -quiet", flags)

    def test_lose_the_errors_of_their_frame(self):
        count = (IDS == 1).sum()
        self.assertLess(self.box(with_depth_errors(), 1)["num_points"], count, "pixels that fly are left out")
        self.assertEqual(self.box(with_depth_errors(), 1, "-as_published")["num_points"], count, "the paper leaves them in")

    def test_are_decided_at_what_the_sensor_resolves(self):
        noisy = with_depth_errors(3)  # errors of single pixels would be taken out
        for label in (1, 2):
            clean = self.box(POINTS, label)
            self.assertLess(clean["resolution"], clean["tolerance"])
            blurred = self.box(noisy, label)
            self.assertGreater(blurred["tolerance"], 1.5 * clean["tolerance"], "errors of 4 mm at 1.8 m")
            self.assertEqual(blurred["planes"][0]["kind"], "symmetry", "left and right of a box")
            fixed = self.box(noisy, label, "-tolerance 0.01")
            self.assertNotIn("symmetry", [plane["kind"] for plane in fixed["planes"]], "the sensor does not show whether it is")
            self.assertAlmostEqual(fixed["tolerance"], clean["tolerance"], delta=0.1 * clean["tolerance"])


def vehicle(x, y, turn):
    """A box with a cabin behind its middle, in meters."""
    cabin = x - 0.7 * np.cos(turn), y - 0.7 * np.sin(turn), -0.5
    return [block((x, y, -1.15), (2.2, 0.9, 0.4), turn), block(cabin, (1.2, 0.8, 0.25), turn)]


def sweep(bodies):
    """What the rings of a LiDAR at 0 0 0 see of bodies around it, and of the ground 1.7 m below."""
    fall, turn = (a.ravel() for a in np.meshgrid(np.radians(np.linspace(-24.8, 2, 64)), np.arange(1800) * np.pi / 900, indexing="ij"))
    rays = np.stack([np.cos(fall) * np.cos(turn), np.cos(fall) * np.sin(turn), np.sin(fall)], axis=1)

    def ground(_, rays):
        with np.errstate(divide="ignore"):
            return np.where(rays[:, 2] < 0, -1.7 / rays[:, 2], np.inf)

    nearest = np.min([body(np.zeros(3), rays) for body in (ground, *bodies)], axis=0)
    kept = nearest < 60
    errors = 0.02 * (np.random.default_rng(7).random((3, kept.sum())).sum(axis=0) - 1.5)
    return rays[kept] * (nearest[kept] + errors)[:, None]


class Vehicles(ToolTest):
    def test_are_found_around_a_lidar(self):
        poses = (9, 3, -0.6), (-9, 6, 0.3), (2, -12, -0.5)
        points = sweep([part for pose in poses for part in vehicle(*pose)])
        report = self.report(self.write("l.pcd", pcd(points, len(points))), "-no_frames -no_completion -quiet", tool="scene")
        self.assertEqual(report["viewpoint"]["from"], "stored", "amid the points")
        self.assertGreater(report["supports"][0]["coefficients"][2], 0.99)
        self.assertEqual(len(report["objects"]), len(poses))
        for item in report["objects"]:
            self.assertEqual(item["planes"][0]["kind"], "symmetry")
            plane = np.array(item["planes"][0]["coefficients"])
            across = [abs(plane[:3] @ (-np.sin(turn), np.cos(turn), 0)) > np.cos(np.radians(5)) for _, _, turn in poses]
            through = [abs(plane @ (x, y, -1.2, 1)) < 0.2 for x, y, _ in poses]
            self.assertTrue(any(np.logical_and(across, through)), plane)

    def test_need_a_ground_for_their_box(self):
        points = sweep(vehicle(12, 4, -0.3))
        car = points[points[:, 2] > -1.5]
        path = self.write("c.pcd", pcd(car, len(car)))
        report = self.report(path, "-viewpoint 0,0,0 -ground 0,0,1,1.7 -support s.ply -quiet", tool="planes")
        plane, = report["planes"]
        self.assertEqual(plane["kind"], "symmetry")
        self.assertGreater(abs(np.dot(plane["coefficients"][:3], (np.sin(0.3), np.cos(0.3), 0))), 0.99)
        support = ply_points(self.folder / "s.ply")[0]["support_1"]
        self.assertAlmostEqual(np.isfinite(support).mean(), plane["seen"], delta=0.05)
