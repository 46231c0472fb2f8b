"""Groups of points that show no surface: samples of solids, atoms."""

import unittest

import pcl_symmetry
from tool_run import np, random_pose

HALF = np.array([1, 0.8, 0.55])


def solid_ball(count, random, half=HALF):
    points = random.uniform(-1, 1, (3 * count, 3))
    return points[np.linalg.norm(points, axis=1) < 1][:count] * half


def solid_box(count, random, half=HALF):
    return random.uniform(-1, 1, (count, 3)) * half


def stepped_cylinder(count, random):
    points = random.uniform(-1, 1, (8 * count, 3))
    radius = np.where(points[:, 2] < 0.2, 1, 0.6)
    return points[np.hypot(points[:, 0], points[:, 1]) < radius][:count]


class Solids(unittest.TestCase):
    """Points that fill a body show its surface only to their spacing."""

    def test_have_no_group_that_they_do_not_resolve(self):
        for shape, allowed in ((solid_ball, ("C1", "C2", "D2")), (solid_box, ("C1", "C2", "D2")), (stepped_cylinder, ("C1", "Cinf"))):
            for count in (200, 1000, 5000):
                for seed in range(2):
                    with self.subTest(shape=shape.__name__, count=count, seed=seed):
                        random = np.random.default_rng(seed)
                        found = pcl_symmetry.rotations(shape(count, random) @ random_pose(seed)[0].T)
                        self.assertTrue(found.reason or found.name in allowed, found.name)

    def test_say_at_which_tolerance_they_would_have_one(self):
        found = pcl_symmetry.rotations(solid_box(2000, np.random.default_rng(1)))
        self.assertIn("show no surface at the tolerance", found.reason)
        least = float(found.reason.split()[-1])
        self.assertGreater(least, found.tolerance)
        self.assertEqual(found.confidence, 0)
        self.assertEqual(pcl_symmetry.rotations(solid_box(2000, np.random.default_rng(1)), absolute_tolerance=1.01 * least).reason, "")

    def test_keep_groups_that_take_points_to_points(self):
        """A body of atoms in three copies about an axis: exact, whatever the points resolve, for every seed."""
        random = np.random.default_rng(3)
        unit = solid_box(700, random, np.array([0.5, 0.45, 0.6])) + [0.8, 0.1, 0]
        third = np.array([[-0.5, -(0.75**0.5), 0], [0.75**0.5, -0.5, 0], [0, 0, 1]])
        turn, _ = random_pose(3)
        atoms = np.concatenate([unit, unit @ third.T, unit @ third]) @ turn.T
        for seed in range(3):
            found = pcl_symmetry.rotations(atoms, seed=seed)
            self.assertEqual(found.name, "C3")
            for motion in found.discrete:
                axis = np.linalg.svd(motion[:3, :3] - np.eye(3))[2][2]
                self.assertGreater(abs(axis @ turn[:, 2]), np.cos(np.radians(0.1)))
