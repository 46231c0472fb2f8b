"""Poses of scans of bodies without symmetry: what overlaps decides."""
import unittest

import pcl_symmetry
from test_pcl_symmetry import moved, needs_pcl, warned
from tool_run import np, points_on_sphere, random_pose


def body(seed, num_points=40_000):
    """(points, normals) of a potato without symmetry: a ball with bumps and dents, scaled along its axes."""
    random = np.random.default_rng(seed)
    bumps, heights = random.normal(size=(7, 3)), random.choice([-0.4, 0.5, 0.7], 7)
    bumps /= np.linalg.norm(bumps, axis=1)[:, None]
    directions, scale = points_on_sphere(num_points, seed), np.array([1, 0.8, 0.65])
    swell = heights * np.exp(8 * (directions @ bumps.T - 1))
    radius, slope = 1 + swell.sum(axis=1, keepdims=True), 8 * swell @ bumps
    slope -= (slope * directions).sum(axis=1, keepdims=True) * directions  # along the ball
    normals = (directions - slope / radius) / scale
    return radius * directions * scale, normals / np.linalg.norm(normals, axis=1, keepdims=True)


def scan(shape, angle, noise=0.0, seed=0):
    """What faces parallel rays from an angle about y, degrees: a third of the points, thinned where the surface slants."""
    points, normals = shape
    random, facing = np.random.default_rng(seed), normals @ [np.sin(np.radians(angle)), 0, np.cos(np.radians(angle))]
    seen = facing > np.maximum(0.17, random.uniform(0, 1.6, len(points)))
    return points[seen] + noise * random.normal(size=(seen.sum(), 3))


def motion(seed):
    return np.vstack([np.c_[random_pose(seed)], (0, 0, 0, 1)])


def degrees(a, b):
    return np.degrees(np.arccos(np.clip((np.trace(a[:3, :3].T @ b[:3, :3]) - 1) / 2, -1, 1)))


@needs_pcl
class Registration(unittest.TestCase):
    def assert_converges(self, seed, source, target, **options):
        """Brings the source to the target that is moved. Returns the evidence."""
        found = pcl_symmetry.register(source, moved(target, motion(seed)), threads=1, **options)
        self.assertTrue(found.converged and found, (seed, found.reason))
        self.assertEqual(found.reason, "")
        self.assertLess(degrees(found.transform, motion(seed)), 3, seed)
        return found.evidence

    def test_two_scans_that_share_a_half_converge(self):
        for seed in range(4):
            evidence = self.assert_converges(seed, scan(body(seed), 0), scan(body(seed), 60, seed=1))
            for share in (evidence.overlap_source, evidence.overlap_target):
                self.assertTrue(0.25 < share < 0.9, share)
            self.assertGreater(evidence.agreement, 0.8)

    def test_two_scans_that_share_a_quarter_converge(self):
        for angle in (90, 100):
            evidence = self.assert_converges(1, scan(body(1), 0), scan(body(1), angle, seed=1))
            self.assertLess(evidence.overlap_source, 0.4, angle)

    def test_noise_and_a_whole_model(self):
        self.assert_converges(5, scan(body(5), 20, noise=0.01), body(5)[0][::4], target_viewpoint=None)

    def test_a_model_that_lacks_a_part_of_the_scan_is_refused(self):
        for seed in (3, 5):
            points, normals = body(seed)
            part = points_on_sphere(6000, seed)
            whole = np.r_[points, [0, 1.1, 0] + 0.3 * part], np.r_[normals, part]
            views = dict(source_viewpoint=20 * np.array([np.sin(np.radians(20)), 0, np.cos(np.radians(20))]), target_viewpoint=None)
            self.assert_converges(seed, scan(whole, 20), whole[0][::4], **views)
            found = pcl_symmetry.register(scan(whole, 20), points[::4], threads=1, **views)
            self.assertFalse(found.converged, found)
            self.assertGreater(found.evidence.outside, 0.06)
            self.assertIn("% belong to parts that only one of them has", found.reason)

    def test_scans_of_other_bodies_and_of_other_sides_are_refused(self):
        for seed in range(4):
            for target in (scan(body(seed + 50), 0, seed=1), scan(body(seed), 180, seed=1)):
                with self.subTest(seed=seed):
                    found = pcl_symmetry.register(scan(body(seed), 0), moved(target, motion(seed)), threads=1)
                    self.assertFalse(found.converged or found, found.evidence)
                    self.assertRegex(found.reason, r"^(nothing|another pose) fits.*, \d+ % of the source lie on the target and \d+ % of the target")

    def test_handles_decide_between_the_poses_of_a_can(self):
        random, n = np.random.default_rng(0), 40_000
        angle, height, tube = random.uniform(0, 2 * np.pi, n), random.uniform(-1, 1, n), random.uniform(0, 2 * np.pi, n // 12)
        wall = np.c_[np.cos(angle), height, np.sin(angle)]
        along = random.uniform(-0.5 * np.pi, 0.5 * np.pi, n // 12)
        out = np.c_[np.cos(along), np.sin(along), 0 * along]
        normals = np.cos(tube)[:, None] * out + np.sin(tube)[:, None] * [0, 0, 1]
        can = np.r_[wall, [1, 0, 0] + 0.6 * out + 0.12 * normals], np.r_[wall * (1, 0, 1), normals]

        def register(source, a, b):
            at = lambda angle: 20 * np.array([np.sin(np.radians(angle)), 0, np.cos(np.radians(angle))])
            views = dict(source_viewpoint=at(a), target_viewpoint=at(b))
            return pcl_symmetry.register(scan(source, a), scan(can, b, seed=1), threads=1, **views)

        for angles in ((330, 210), (270, 330), (20, 160), (45, 80)):
            with self.subTest(both_show_it=angles):
                found = register(can, *angles)
                self.assertTrue(found.converged, found.reason)
                # The handle stays in place; the can may be turned upside down about it.
                np.testing.assert_allclose(found.transform[:, [0, 3]], np.eye(4)[:, [0, 3]], atol=0.02)
        for angles in ((270, 0), (270, 10), (280, 0)):
            with self.subTest(one_shows_it=angles):
                found = register((wall, wall * (1, 0, 1)), *angles)
                self.assertFalse(found.converged, found)
                self.assertLess(found.evidence.uniqueness, 0.51)
                self.assertIn("% of the odds of all poses that fit", found.reason)

    def test_a_mirrored_model_and_one_of_another_unit_are_refused(self):
        for seed, scale, reason in ((7, (-1, 1, 1), "."), (3, 1000, r"one cloud is \d+ times as large as the other \(another unit\?\)")):
            shape = body(seed)
            found = pcl_symmetry.register(scan(shape, 0), shape[0][::4] * scale, target_viewpoint=None, threads=1)
            self.assertFalse(found.converged, found.evidence)
            self.assertRegex(found.reason, reason)

    def test_the_same_scan_twice(self):
        source = scan(body(3), 0)
        found = pcl_symmetry.register(source, source, threads=1)
        self.assertTrue(found.converged)
        np.testing.assert_allclose(found.transform, np.eye(4), atol=1e-3)

    def test_thirty_points_are_refused(self):
        source = scan(body(3), 0)
        found = warned("source: 30 points, must be at least 100", pcl_symmetry.register, source[:30], source, threads=1)
        self.assertEqual((found.converged, found.reason), (False, "source: 30 points, must be at least 100"))
