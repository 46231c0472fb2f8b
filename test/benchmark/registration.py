"""Registration of scans to whole models, or to other scans, from any pose, and of tracks around a guess (Section 5.1).

Right is within 5 degrees and 2 % of the diagonal, up to the rotations that map the model onto itself. With --impostors
each scan is also brought to the model before its own in the list, where nothing should fit.

registration.py PSB --classes train.cla --fold 1 --every 2 --views 1 --impostors
"""
import contextlib
import dataclasses
import itertools
import time

import numpy as np
import pcl_symmetry
from scipy.spatial.transform import Rotation

import bench
import references
from frames import by_mass, cloud_of, make_parser

RIGHT_ANGLE, RIGHT_DISTANCE = 5.0, 0.02  # degrees, diagonals
ACROSS = np.cos(np.radians(3.0))  # a plane that lies across an axis, within the angle at which planes count as found
AROUND_DISTANCE = 0.1  # diagonals that a guess is off
SEARCHED = 1.5  # tracks are searched half as far again as the guess is off: the search has to find where to stop
VOXEL = 0.015  # of ICP and features, diagonals of the target


def reflection(plane):
    """(4, 4) of coefficients a, b, c, d."""
    return np.eye(4) - 2 * np.outer([*plane[:3], 0], plane)


def pose_error(T_model_scan, T_model_scan_true, symmetries):
    """(degrees, diagonals at the center of the model) of the error that comes closest to being right.

    Two planes of symmetry make a rotation about their common line, and every rotation that a finite set of planes
    generates is made by two of them. About an axis of revolution any angle is right, and a half turn of it where a
    plane lies across; about the center of a sphere any rotation is.
    """
    error, center = T_model_scan @ np.linalg.inv(T_model_scan_true), np.array(symmetries["center"])
    reflections = [reflection(plane["coefficients"]) for plane in symmetries["planes"]]
    found = []  # (degrees, distance)
    for symmetry in [np.eye(4)] + [a @ b for a, b in itertools.permutations(reflections, 2)]:
        difference = Rotation.from_matrix(error[:3, :3] @ symmetry[:3, :3].T)
        found.append((np.degrees(difference.magnitude()), bench.moved(error, center) - bench.moved(symmetry, center)))
    for axis in symmetries["axes"]:
        start, direction = np.array(axis["point"]), np.array(axis["direction"])
        point = start + direction @ (center - start) * direction
        moved, turned = bench.moved(error, point), error[:3, :3] @ direction
        found.append((angle_between(turned, direction), moved - point))
        for plane, mirror in zip(symmetries["planes"], reflections):
            if abs(direction @ plane["coefficients"][:3]) > ACROSS:
                found.append((angle_between(turned, -direction), moved - bench.moved(mirror, point)))
    for sphere in symmetries["centers"]:
        found.append((0.0, bench.moved(error, np.array(sphere["point"])) - sphere["point"]))
    errors = [(angle, np.linalg.norm(way) / symmetries["diagonal"]) for angle, way in found]
    return min(errors, key=lambda e: max(e[0] / RIGHT_ANGLE, e[1] / RIGHT_DISTANCE))


def angle_between(a, b):
    return np.degrees(np.arctan2(np.linalg.norm(np.cross(a, b)), a @ b))


# Methods: functions of (source, its viewpoint), (target, its viewpoint) and a guess, None or (pose, (angle, distance)),
# that return T_target_source and whether they say that it fits


def by_symmetry(source, target, guess):
    found = register(source, target, **({} if guess is None else {"guess": guess[0], "around": guess[1]}))
    return found.transform, found.converged


def register(source, target, **options):
    """pcl_symmetry.register() of clouds with their viewpoints."""
    (points, viewpoint), (onto, seen_from) = source, target
    return pcl_symmetry.register(points, onto, source_viewpoint=viewpoint, target_viewpoint=seen_from, threads=1, **options)


def open3d_cloud(points, viewpoint=None, voxel=None):
    import open3d

    cloud = open3d.geometry.PointCloud(open3d.utility.Vector3dVector(points.astype(float)))
    if voxel:
        cloud = cloud.voxel_down_sample(voxel)
        cloud.estimate_normals(open3d.geometry.KDTreeSearchParamHybrid(2.5 * voxel, 30))
        cloud.orient_normals_towards_camera_location(cloud.get_center() if viewpoint is None else viewpoint)
        if viewpoint is None:  # outwards
            cloud.normals = open3d.utility.Vector3dVector(-np.asarray(cloud.normals))
    return cloud


def icp(source, target, pose, reach):
    import open3d

    registration = open3d.pipelines.registration
    criteria = registration.ICPConvergenceCriteria(max_iteration=50)
    found = registration.registration_icp(source, target, reach, pose, criteria=criteria)
    return found.transformation, found.fitness, found.inlier_rmse


def by_principal_axes(source, target, guess):
    """Open3D's ICP on voxels from the principal axes in their four orders of signs, the best on all points."""
    voxel = VOXEL * np.linalg.norm(np.ptp(target[0], axis=0))
    coarse = [open3d_cloud(*cloud, voxel) for cloud in (source, target)]
    frames = [by_mass(points, None, 0) for points, _ in (source, target)]
    tried = []
    for signs in ((1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)):
        rotation = frames[1].axes * signs @ frames[0].axes.T
        tried.append(icp(*coarse, bench.rigid(rotation, frames[1].center - rotation @ frames[0].center), 10 * voxel))
    pose = max(tried, key=lambda t: (round(t[1], 2), -t[2]))[0]
    pose, fitness, _ = icp(open3d_cloud(source[0]), open3d_cloud(target[0]), pose, 5 * voxel)
    return pose, fitness > 0


def by_features(source, target, guess):
    """Open3D's FPFH and RANSAC on voxels, then ICP on all points."""
    import open3d

    registration = open3d.pipelines.registration
    voxel = VOXEL * np.linalg.norm(np.ptp(target[0], axis=0))
    open3d.utility.random.seed(1)
    coarse = [open3d_cloud(*cloud, voxel) for cloud in (source, target)]
    near = open3d.geometry.KDTreeSearchParamHybrid(6 * voxel, 100)
    features = [registration.compute_fpfh_feature(cloud, near) for cloud in coarse]
    found = registration.registration_ransac_based_on_feature_matching(
        *coarse, *features, True, 2.5 * voxel, registration.TransformationEstimationPointToPoint(False), 3,
        [registration.CorrespondenceCheckerBasedOnEdgeLength(0.9),
         registration.CorrespondenceCheckerBasedOnDistance(2.5 * voxel)],
        registration.RANSACConvergenceCriteria(100_000, 0.999))  # fmt: skip
    if found.fitness < 0.25:
        return found.transformation, False
    return icp(open3d_cloud(source[0]), open3d_cloud(target[0]), found.transformation, 5 * voxel)[0], True


METHODS = {"symmetry": by_symmetry, "principal axes": by_principal_axes, "features": by_features}


def seen(points, scan, pose):
    """((points, viewpoint), T_cloud_model)"""
    return (points, None if scan is None else scan.viewpoint), pose


def target_of(mesh, model, view, arguments):
    """What a scan is brought to, and the pose of the model in it: the model, or the scan from the next corner."""
    if arguments.target == "model":
        return seen(*cloud_of(mesh, model, -1, arguments, clean=True))
    return seen(*cloud_of(mesh, model, view ^ 1, arguments))  # corners of one edge differ in one bit


def guess_for(T_target_source, target, diagonal, random, arguments):
    """The true pose, turned about the middle of the target and moved, and how far a search around it goes."""
    angle, distance = np.radians(arguments.around), AROUND_DISTANCE * diagonal
    middle, (axis, way) = target.mean(axis=0), bench.random_directions(random, 2)
    off = bench.rotation_about(middle, axis, angle)
    off[:3, 3] += distance * way
    # The center of a scan is at most a diagonal from the middle that the guess is turned about.
    reach = SEARCHED * distance + 2 * np.sin(SEARCHED * angle / 2) * diagonal
    return off @ T_target_source, (SEARCHED * angle, reach)


def evaluate(item, arguments):
    mesh, impostor_mesh = bench.read_mesh(item.path), None
    if arguments.impostors and item.before is not None:
        with contextlib.suppress(bench.BadInput):  # its own item says so
            impostor_mesh = bench.read_mesh(item.before.path)
    symmetries = references.find_references(mesh)
    rows = []
    for view in range(arguments.views):
        source, T_source_model = seen(*cloud_of(mesh, item, view, arguments))
        tried = [(target_of(mesh, item, view, arguments), None)]
        if impostor_mesh is not None:
            tried.append((target_of(impostor_mesh, item.before, view, arguments), item.before.name))
        for (target, T_target_model), impostor in tried:
            true = T_target_model @ np.linalg.inv(T_source_model)
            guess = None
            if arguments.around and impostor is None:
                random = bench.generator(arguments.seed, item.key, view, "guess")
                guess = guess_for(true, target[0], mesh.diagonal, random, arguments)
            for method in arguments.methods:
                (pose, fits), milliseconds = bench.timed(METHODS[method], source, target, guess, clock=time.process_time)
                row = {"scan": f"{item.name}_{view}", "impostor": impostor, "method": method, "fits": bool(fits), "ms": milliseconds}
                if impostor is None:
                    T_model_target = np.linalg.inv(T_target_model)
                    angle, way = pose_error(T_model_target @ pose, np.linalg.inv(T_source_model), symmetries)
                    right = angle <= RIGHT_ANGLE and way <= RIGHT_DISTANCE
                    row.update(degrees=float(angle), distance=float(way), right=bool(right))
                rows.append(row)
    return rows


def summarize(rows):
    own, others = [r for r in rows if r["impostor"] is None], [r for r in rows if r["impostor"] is not None]
    right = [row for row in own if row["right"]]
    median = lambda rows, key: float(np.median([row[key] for row in rows])) if rows else None
    return {
        "right": bench.Rate(row["right"] for row in own),
        "fits": bench.Rate(row["fits"] for row in own),
        "right_of_those": bench.Rate(row["right"] for row in own if row["fits"]),
        "impostors": bench.Rate(row["fits"] for row in others),
        "degrees": median(right, "degrees"),
        "distance": median(right, "distance"),
        "median_ms": median(own, "ms"),
    }


def models_in_turn(arguments):
    """The models of the command line, each with that `before` it in the list, or None."""
    models = bench.list_models(arguments)
    for model, before in zip(models, [None, *map(dataclasses.replace, models)]):
        model.before = before
    return models


def main(arguments):
    found, left_out = bench.run(models_in_turn(arguments), evaluate, arguments)
    rows = [row for each in found for row in each]
    results = {m: summarize([row for row in rows if row["method"] == m]) for m in arguments.methods}
    number = lambda value, digits: "-" if value is None else f"{value:.{digits}f}"
    bench.print_table(
        f"Scans brought to {'whole models' if arguments.target == 'model' else 'scans from the next corner'}",
        ["", "right", "says that it fits", "right of those", "impostors that fit", "degrees", "diagonals", "ms"],
        [[m, r["right"].text, r["fits"].text, r["right_of_those"].text, r["impostors"].text, number(r["degrees"], 2),
          number(r["distance"], 4), number(r["median_ms"], 0)] for m, r in results.items()],
    )  # fmt: skip
    print("Degrees, diagonals: median errors of those that are right. ms: median processor time.")
    bench.write_json(arguments, {"methods": results, "left_out": left_out, "rows": rows})


if __name__ == "__main__":
    parser = make_parser(__doc__, METHODS)
    parser.add_argument("--target", choices=["model", "scan"], default="model", help="what scans are brought to")
    parser.add_argument("--around", type=float, help="tracks: degrees that a guess is off; symmetry alone uses it")
    parser.add_argument("--impostors", action="store_true", help="also bring each scan to the model before its own")
    bench.main(main, parser.parse_args())
