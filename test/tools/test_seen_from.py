"""Where the scanner stood: told by the rays of an organized cloud, by the header, by the density of the points, or by the user."""
from test_scene import block, camera, look
from tool_run import ToolTest, np, pcd, points_on_box, points_on_sphere, random_pose

WIDTH, HEIGHT = 160, 120
BOX = [((0, 0, 0), (1, 0.7, 0.45))]  # centers and half sizes
L = [((0, 0, 0), (1, 0.25, 0.45)), ((-0.7, 0.85, 0), (0.3, 0.6, 0.45))]
CHAIR = [((0, 0, 0), (0.5, 0.5, 0.06)), ((0, 0.44, 0.55), (0.5, 0.06, 0.5)),
         *(((a * 0.43, b * 0.43, -0.45), (0.07, 0.07, 0.4)) for a in (1, -1) for b in (1, -1))]


def scan(blocks, eye):
    """The pixels that a camera sees which looks at the origin, and its motion from the object to the camera."""
    eye = np.array(eye, float)
    reach, distance = max(np.linalg.norm(np.abs(center) + half) for center, half in map(np.array, blocks)), np.linalg.norm(eye)
    rays = camera(eye, (0, 0, 0), WIDTH, HEIGHT, 0.48 * HEIGHT * np.sqrt(distance ** 2 - reach ** 2) / reach, 0.3)
    points, _ = look(eye, rays, [block(*each) for each in blocks])
    forward = -eye / distance
    right = (rays[1] - rays[0]) / np.linalg.norm(rays[1] - rays[0])
    turn = np.stack([right, np.cross(forward, right), forward])
    return points, (turn, -turn @ eye)


def finite(points):
    return points[np.isfinite(points).all(axis=1)]


def moved(points, pose):
    return points @ pose[0].T + pose[1]


class SeenFrom(ToolTest):
    tool = "planes"

    def answers(self, *clouds, flags=""):
        """What is found of each cloud: its points, organized where they are pixels, and the viewpoint of its header."""
        names = []
        for k, (points, viewpoint) in enumerate(clouds):
            width = WIDTH if len(points) == WIDTH * HEIGHT else len(points)
            names.append(str(self.write(f"{k}.pcd", pcd(points, width, viewpoint=viewpoint))))
        if len(names) == 1:
            return [self.report(*names, "-quiet", flags)]
        self.run_tool(*names, "-quiet -json all.json", flags)
        return self.lines("all.json")

    def sources(self, *clouds):
        return [answer["viewpoint"]["from"] for answer in self.answers(*clouds)]

    def test_of_rows_and_columns_that_are_no_picture_is_none(self):
        pixels, _ = scan(BOX, (2.5, -3, 2))
        whole, shuffled = self.sources((points_on_box(num_points=WIDTH * HEIGHT), (0, 0, 0)), (np.random.default_rng(3).permutation(pixels), (0, 0, 0)))
        self.assertEqual(whole, "none")
        self.assertNotEqual(shuffled, "rays")

    def test_makes_the_planes_of_a_scan_symmetries(self):
        pixels, to_camera = scan(BOX, (2.5, -3, 2))
        for turn, shift in ((np.eye(3), np.zeros(3)), to_camera, random_pose(9)):  # of the first 0 0 0 lies in the middle of the box
            cloud = moved(pixels, (turn, shift)), (0, 0, 0)
            seen, = self.answers(cloud)
            self.assertEqual(seen["viewpoint"]["from"], "rays")
            planes = np.array([plane["coefficients"] for plane in seen["planes"]])
            for axis in turn.T:
                near = (abs(planes[:, :3] @ axis) > np.cos(np.radians(2))) & (abs(planes @ np.append(shift, 1)) < 0.05)
                self.assertTrue(near.any(), axis)
            self.assertLessEqual({plane["kind"] for plane in seen["planes"]}, {"symmetry", "possible"})
            without, = self.answers(cloud, flags="-viewpoint none")
            self.assertEqual(without["viewpoint"], {"from": "none"})
            # Half a box may be a box of which a half is missing; it is no whole one.
            self.assertTrue(all(plane["seen"] < 0.9 for plane in without["planes"]))
        points = finite(pixels)
        given, = self.answers((points, (0, 0, 0)), flags="-viewpoint 2.5,-3,2")
        self.assertEqual(given["viewpoint"]["from"], "given")
        np.testing.assert_allclose(given["viewpoint"]["position"], (2.5, -3, 2), atol=1e-9)
        planes = abs(np.array([plane["coefficients"][:3] for plane in given["planes"]]))
        self.assertGreater(planes.max(axis=0).min(), np.cos(np.radians(2)), "all three")

    def test_gives_true_planes_more_confidence_than_others(self):
        """Views that show two or three sides of everything."""
        num_wrong, views = 0, [(blocks, axes, eye) for blocks, axes in ((BOX, (0, 1, 2)), (L, (2,)), (CHAIR, (0,)))
                               for eye in ((2.5, -3, 2), (1.5, 3, 2.5), (-2, 3.2, -1.8))]
        clouds = [scan(blocks, eye)[0] for blocks, _, eye in views]
        for (_, axes, eye), cloud, answer in zip(views, clouds, self.answers(*((cloud, (0, 0, 0)) for cloud in clouds))):
            points = finite(cloud)
            center, size = points.mean(axis=0), np.linalg.norm(np.ptp(points, axis=0))
            true, wrong = {}, []
            for plane in answer["planes"]:
                self.assertIn(plane["kind"], ("symmetry", "possible"))
                self.assertTrue(0 < plane["seen"] <= 1)
                c = np.array(plane["coefficients"])
                axis = abs(c[:3]).argmax()
                off = abs(c @ np.append(center, 1) - c[axis] * center[axis])
                if axis in axes and abs(c[axis]) > np.cos(np.radians(2)) and off < 0.02 * size:
                    true[axis] = max(true.get(axis, 0), plane["confidence"])
                else:
                    wrong.append(plane["confidence"])
                    num_wrong += plane["kind"] == "symmetry"
            self.assertEqual(len(true), len(axes), eye)
            self.assertGreater(max(true.values()), max(wrong, default=0), eye)
        # The README's rate of scans of asymmetric objects that are called symmetric is 21 %: 1.9 of nine scans.
        self.assertLessEqual(num_wrong, 1)

    def test_is_none_for_wires_whole_objects_and_views_put_together(self):
        clouds = []
        for seed in range(5):
            t = np.random.default_rng(seed).random(80 + 40 * seed)
            wire = np.stack([(0.3 + t) * np.cos(5 * t), (0.3 + t) * np.sin(5 * t), t], axis=1)
            wire[:, 2] += 0.003 * np.random.default_rng(seed + 99).normal(size=len(t))
            clouds.append((wire, (0.1, 0.2, 0.3)))
        for count in (1000, 10_000):
            clouds += [(points_on_box(num_points=count), viewpoint) for viewpoint in ((0, 0, 0), (3, 1, 2))]
            clouds.append((points_on_sphere(count), (3, 1, 2)))
        for second in ((-2.5, -3, 2), (-2.5, 3, -2)):
            for blocks in (BOX, L, CHAIR):
                clouds.append((np.vstack([finite(scan(blocks, eye)[0]) for eye in ((2.5, -3, 2), second)]), (0.1, 0.2, 0.3)))
        # Half a sphere and a sheet are seen once from many positions. Their even density is not that of a scan.
        half = points_on_sphere(20_000)
        half = half[half[:, 2] > 0.01]
        clouds += [(half, (0, 0, 0)), (np.c_[np.random.default_rng(6).uniform(-1, 1, (4000, 2)), np.zeros(4000)], (0, 0, 0))]
        self.assertEqual(self.sources(*clouds), ["none"] * len(clouds))

    def test_is_believed_where_somebody_set_it(self):
        """0 0 0 is believed in the frame of the camera, where it is true, but for an open shell that is merely seen once from there."""
        clouds = [scan(L, eye) for eye in ((2.5, -3, 2), (-2, 2.5, 2), (2.2, 3, -1.8))]
        self.assertEqual(self.sources(*((moved(finite(pixels), to_camera), (0, 0, 0)) for pixels, to_camera in clouds)), ["stored"] * 3)
        elsewhere = [(moved(finite(scan(blocks, (2.5, -3, 2))[0]), random_pose(0)), (0, 0, 0)) for blocks in (L, CHAIR)]
        self.assertEqual(self.sources(*elsewhere), ["inferred"] * 2, "from the density of the points")
        shell = points_on_sphere(20_000)
        shell = shell[(shell * ((0, 0, 5) - shell)).sum(axis=1) > 0] - (0, 0, 5)
        self.assertEqual(self.sources((shell, (0, 0, 0)), (shell, (0, 0, 0.1))), ["none", "stored"])
        self.run_tool("1.pcd -viewpoint 0,0.3,1")
        self.assertNotRegex(self.error, "otherwise|behind others")
        for elsewhere in ("0,0,-19", "0,2,0"):  # 180 and 21 degrees away
            self.run_tool(f"1.pcd -viewpoint {elsewhere}")
            self.assertIn("0.1 by its stored viewpoint, -viewpoint says otherwise", self.error)
        self.run_tool(self.write("whole.pcd", pcd(points_on_box(num_points=2000))), "-viewpoint 3,2,1")
        self.assertRegex(self.error, r"whole.pcd: \d\d % of the points lie behind others as seen from the viewpoint given")
        path = self.write("turned.pcd", pcd(shell, len(shell)).replace(b"0 0 0 1 0 0 0", b"0 0 0 0 1 0 0"))
        self.assertEqual(self.report(path, "-quiet")["viewpoint"]["from"], "stored", "who turns the sensor has set its pose")
