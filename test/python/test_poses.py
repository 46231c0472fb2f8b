"""How frames, registrations and groups of rotations are judged, on shapes whose symmetries are known."""

import unittest

from needed import need

need("open3d", "scipy", "pcl_symmetry")
import numpy as np

import bench
import frames
import registration
import rotations
import solids

Z = {"point": [0, 0, 0], "direction": [0, 0, 1]}


def pose(degrees, axis, way=(0, 0, 0)):
    matrix = bench.rotation_about(np.zeros(3), np.array(axis) / np.linalg.norm(axis), np.radians(degrees))
    matrix[:3, 3] = way
    return matrix


def rotated(degrees, axis):
    return pose(degrees, axis)[:3, :3]


def symmetries(planes=(), axes=(), centers=()):
    planes = [{"coefficients": [*row, 0]} for row in np.eye(3)[list(planes)]]
    return {"planes": planes, "axes": axes, "centers": centers, "center": [0, 0, 0], "diagonal": 2.0}


class TestPoseError(unittest.TestCase):
    def error(self, estimate, **known):
        true = pose(50, (1, 2, 3), (4, 5, 6))
        return registration.pose_error(estimate @ true, true, symmetries(**known))

    def test_without_symmetry(self):
        np.testing.assert_allclose(pose(90, (0, 0, 1))[:3, 0], (0, 1, 0), atol=1e-9)
        np.testing.assert_allclose(self.error(pose(30, (1, 1, 0), (0.2, 0, 0))), (30, 0.1), atol=1e-9)
        np.testing.assert_allclose(self.error(pose(180, (0, 0, 1)), planes=[0]), (180, 0), atol=1e-5)

    def test_two_planes_make_a_half_turn(self):
        np.testing.assert_allclose(self.error(pose(180, (0, 0, 1)), planes=[0, 1]), (0, 0), atol=1e-5)
        np.testing.assert_allclose(self.error(pose(177, (0, 0, 1)), planes=[0, 1]), (3, 0), atol=1e-5)

    def test_axis_of_revolution(self):
        self.assertLess(self.error(pose(77, (0, 0, 1)), axes=[Z])[0], 1e-5)
        self.assertAlmostEqual(self.error(pose(180, (1, 0, 0)), axes=[Z])[0], 180, 5)
        self.assertLess(self.error(pose(180, (1, 1, 0)), axes=[Z], planes=[2])[0], 1e-5)  # over the plane across

    def test_sphere(self):
        error = self.error(pose(77, (3, 1, 2), (0, 0, 0.5)), centers=[{"point": [0, 0, 0]}])
        np.testing.assert_allclose(error, (0, 0.25), atol=1e-9)


class TestFrames(unittest.TestCase):
    def test_order_and_signs_do_not_matter(self):
        axes = rotated(40, (1, 2, 0)) @ np.array([[0, 0, 1], [-1, 0, 0], [0, -1, 0]])
        self.assertAlmostEqual(frames.angle_of_axes(rotated(4, (1, 0, 0)) @ axes, rotated(40, (1, 2, 0))), 4, 5)

    def test_ties_of_a_prism_and_of_a_body_of_revolution(self):
        triangle = [{"coefficients": [np.cos(a), np.sin(a), 0, 0]} for a in np.radians([0, 60, 120])]
        ties = frames.Ties({"planes": triangle, "axes": [], "centers": []})
        self.assertAlmostEqual(ties.angle(rotated(62, (0, 0, 1)), np.eye(3)), 2, 5)
        self.assertAlmostEqual(ties.angle(rotated(45, (0, 0, 1)), np.eye(3)), 15, 5)
        ties = frames.Ties({"planes": [], "axes": [Z], "centers": []})
        self.assertLess(ties.angle(rotated(45, (0, 0, 1)), np.eye(3)), 1e-5)
        self.assertAlmostEqual(ties.angle(rotated(30, (1, 0, 0)), np.eye(3)), 30, 5)


class TestRotations(unittest.TestCase):
    def test_solids_have_the_rotations_that_they_are_said_to_have(self):
        golden = (1 + 5**0.5) / 2
        known = {"rim of 5 spokes": ((0, 0, 1), 5), "gear of 16 teeth on a hub": ((0, 0, 1), 16), "goblet": ((0, 0, 1), 0),
                 "cube": ((1, 1, 1), 3), "tetrahedron": ((1, 1, 1), 3), "icosahedron": ((0, 1, golden), 5)}  # fmt: skip
        for solid in (solid for solid in solids.solids() if solid.name in known):
            mesh, (axis, order) = bench.make_mesh(solid.vertices, solid.faces), known[solid.name]
            points, axis = bench.sample(mesh, 500, np.random.default_rng(1)), np.array(axis) / np.linalg.norm(axis)
            about = lambda degrees: [bench.rotation_about(np.zeros(3), axis, np.radians(degrees))]
            with self.subTest(solid.name):
                self.assertLessEqual(rotations.excess(mesh, points, about(360 / order if order else 77)), 1)
                if order:
                    self.assertGreater(rotations.excess(mesh, points, about(360 / order) + about(180 / order)), 1)

    def test_surface_distance_is_the_least_over_the_symmetries(self):
        corners, thirds = np.array([[2, 0, 0], [0, 0, 1.0]]), [pose(120 * k, (0, 0, 1)) for k in range(3)]
        distance = rotations.surface_distance(pose(125, (0, 0, 1)), np.eye(4), corners, thirds)
        self.assertAlmostEqual(distance, 4 * np.sin(np.radians(2.5)))


if __name__ == "__main__":
    unittest.main()
