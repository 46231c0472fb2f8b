/// Poses of a symmetric object without flips: an estimator is free to return any pose that looks the same.
#include <pcl/io/pcd_io.h>
#include <pcl_symmetry/object_symmetries.h>

#include <iostream>
#include <vector>

int main(int argc, char** argv) {
  pcl::PointCloud<pcl::PointXYZ>::Ptr model(new pcl::PointCloud<pcl::PointXYZ>);
  if (argc != 2 || pcl::io::loadPCDFile(argv[1], *model) < 0) {
    std::cerr << "usage: 09_symmetric_poses MODEL.pcd\n";
    return 2;
  }
  const pcl_symmetry::ObjectSymmetries symmetries = pcl_symmetry::detectObjectSymmetries(*model);
  std::cout << "group " << symmetries.name() << ", confidence " << symmetries.confidence << "\n";

  // An object that rotates by 0.1 radians per frame; in each frame the estimator returns another pose that looks the
  // same.
  const double degrees = 57.2957795;
  std::vector<Eigen::Isometry3d> estimates;
  for (int frame = 0; frame < 6; ++frame) {
    const Eigen::Isometry3d truth(Eigen::AngleAxisd(0.1 * frame, Eigen::Vector3d(0.6, 0.0, 0.8)));
    const auto same = symmetries.equivalents(truth);
    estimates.push_back(same[frame % same.size()]);
  }
  Eigen::Isometry3d shown = symmetries.canonical(estimates[0]);
  for (int frame = 1; frame < 6; ++frame) {
    const Eigen::Isometry3d next = symmetries.closestTo(estimates[frame], shown);
    const auto turned = [](const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
      return Eigen::AngleAxisd(a.linear().transpose() * b.linear()).angle();
    };
    std::cout << "frame " << frame << ": the estimate turns by "
              << turned(estimates[frame - 1], estimates[frame]) * degrees << " degrees, the track by "
              << turned(shown, next) * degrees << "\n";
    shown = next;
  }

  const Eigen::Isometry3d first = estimates.front(), last = estimates.back();
  const pcl_symmetry::PoseDistance apart = symmetries.distance(first, last);
  std::cout << "first and last look " << apart.angle * degrees << " degrees and " << apart.offset
            << " apart, the surface " << symmetries.surfaceDistance(first, last, model->getMatrixXfMap(3, 4, 0))
            << "\n";
}
