"""Scenes whose pictures are known, and how answers are matched with their objects."""
import unittest

from needed import need

need("open3d", "scipy", "pcl_symmetry")
import numpy as np

import bench
import pcl_symmetry
import scenes


class Judging(unittest.TestCase):
    def test_objects_match_by_the_share_of_common_points(self):
        found, truth = np.array([0, 0, 0, 1, -1, 1]), np.array([1, 1, -1, 0, 0, 0])
        np.testing.assert_allclose(scenes.overlaps(found, truth, (2, 2)), [[0, 2 / 3], [2 / 3, 0]])

    def test_bands_of_occlusion(self):
        self.assertEqual([scenes.band_of(x) for x in (0, 0.1, 0.69, 0.7)], [0, 1, 3, None])


class Pictures(unittest.TestCase):
    def test_a_camera_sees_a_square_where_it_is(self):
        square = np.array([(-0.1, -0.1, 2), (0.1, -0.1, 2), (0.1, 0.1, 2), (-0.1, 0.1, 2)])[[[0, 1, 2], [0, 2, 3]]]
        depths = scenes.depths_of(square)
        hit = np.isfinite(depths)
        np.testing.assert_allclose(depths[hit], 2, atol=1e-9)
        self.assertLess(np.abs(scenes.rays()[hit, :2]).max(), 0.05)
        self.assertLess(abs(hit.sum() / 53**2 - 1), 0.1)  # 105 / 2 pixels

    def test_disparities_come_in_steps(self):
        noisy = scenes.with_noise(np.full((20, 20), 1.3), 1.0, bench.generator(1))
        steps = 1 / (scenes.STEP * noisy)
        np.testing.assert_allclose(steps, np.round(steps), atol=1e-6)
        self.assertGreater(noisy.std(), 0)


def stone(seed, radii, at):
    """(T, 3, 3) triangles of a body without symmetry."""
    random = np.random.default_rng(seed)
    theta, phi = np.meshgrid(np.linspace(0, np.pi, 41), np.linspace(0, 2 * np.pi, 81), indexing="ij")
    u = np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)], -1)
    bumps = random.normal(size=(6, 3))
    bumps /= np.linalg.norm(bumps, axis=1, keepdims=True)
    swell = (random.uniform(-0.45, 0.45, 6) * np.exp(4 * (u @ bumps.T - 1))).sum(-1)
    p = at + np.array(radii) * (1 + swell)[..., None] * u
    a, b, c, d = p[:-1, :-1], p[1:, :-1], p[1:, 1:], p[:-1, 1:]
    return np.concatenate([np.stack(corners, -2).reshape(-1, 3, 3) for corners in ((a, b, c), (a, c, d))])


class Names(unittest.TestCase):
    def test_models_cut_objects_that_touch_where_no_symmetry_does(self):
        c, s = np.cos(0.6), np.sin(0.6)
        toward_camera = np.array([[1, 0, 0], [0, -s, -c], [0, c, -s]])
        stones = [stone(11, (0.06, 0.05, 0.07), (-0.045, 0, 0)), stone(12, (0.05, 0.06, 0.05), (0.05, 0, 0))]
        low = min(each[..., 2].min() for each in stones)
        table = np.array([(-0.5, -0.4, low), (0.5, -0.4, low), (0.5, 0.4, low), (-0.5, 0.4, low)])[[[0, 1, 2], [0, 2, 3]]]
        depths = np.stack([scenes.depths_of(each @ toward_camera.T + (0, 0, 0.8)) for each in (table, *stones)])
        frame = (scenes.rays() * np.where(np.isfinite(depths.min(0)), depths.min(0), np.nan)[..., None]).astype(np.float32)
        database = pcl_symmetry.Database(":memory:")
        mesh = lambda corners: bench.Mesh(corners.reshape(-1, 3), np.arange(3 * len(corners)).reshape(-1, 3))
        database.build({name: bench.sample(mesh(each), 20_000, bench.generator(0)) for name, each in zip("ab", stones)})
        united = pcl_symmetry.scene(frame, complete=False)
        self.assertEqual(len(united), 1)
        found = pcl_symmetry.scene(frame, complete=False, database=database)
        self.assertEqual([object.models[0].name for object in found], ["a", "b"])
        for k in (1, 2):
            self.assertGreater((depths.argmin(0)[found.labels == k] == k).mean(), 0.97)
        self.assertEqual([junction.objects for junction in found.junctions], [(0, 1)])


if __name__ == "__main__":
    unittest.main()
