#!/usr/bin/env bash
# Makes the pictures of apps/gallery/README.md.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash apps/gallery/make.sh [-h] [FOLDER]

Builds the tools, fetches or makes the models (Debian package libcgal-demo, shapes of our own) and writes the pictures of the gallery to FOLDER
(build/gallery). Prints each command. Needs no screen.

example: bash apps/gallery/make.sh /tmp/pictures
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
  -*) usage >&2; exit 2 ;;
esac
(($# <= 1)) || { usage >&2; exit 2; }
pictures=$(realpath -m "${1-build/gallery}")

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cmake --preset release --log-level=WARNING >/dev/null
cmake --build build --parallel "$(nproc)" --target pcl_symmetry_lines pcl_symmetry_map pcl_symmetry_scan pcl_symmetry_segment \
  pcl_symmetry_viewer pcl_symmetry_viewpoint draw_medial_axis draw_scan_centers make_shapes
export PATH=$PWD/build/apps:$PATH

models=$PWD/build/gallery/models
mkdir -p "$pictures" "$models"
bash apps/fetch_meshes.sh "$models" bull cow elephant hand
make_shapes "$models"
contours=$PWD/apps/gallery/contour.awk
cd "$models"

contour() {
  awk -v shape="$2" -f "$contours" >"$1.pcd"
}

show() {
  echo "$*"
  "$@" >"$pictures/last.txt" 2>&1 || { cat "$pictures/last.txt" >&2; exit 1; }
}

contour mug "mug 0.45"
contour cup "mug 0"
contour flower "flower 5"
contour flower_4 "flower 4"
contour flower_3 "flower 3"
show pcl_symmetry_lines cup.pcd mug.pcd flower.pcd flower_4.pcd flower_3.pcd -size 150 -png "$pictures/figure_1_contours.png"
show pcl_symmetry_map bull.off -size 200 -slices "$pictures/figure_1_bull.png"
show pcl_symmetry_map cow.off -size 200 -slices "$pictures/figure_1_cow.png"

for n in 3 4 5 6 8 48; do contour "polygon_$n" "polygon $n"; done
for h in 1.0 0.9 0.8 0.7 0.6 0.5; do contour "rectangle_$h" "rectangle 1 $h"; done
for noise in 0.00 0.01 0.02 0.04 0.06 0.08; do contour "starfish_$noise" "starfish $noise"; done
show pcl_symmetry_lines polygon_{3,4,5,6,8,48}.pcd rectangle_{1.0,0.9,0.8,0.7,0.6,0.5}.pcd \
  starfish_0.0{0,1,2,4,6,8}.pcd -columns 6 -size 100 -png "$pictures/figure_2.png"

contour rectangle "rectangle 1 0.5"
contour bump "rectangle 1 0.5 0.1"
show pcl_symmetry_lines rectangle.pcd bump.pcd -size 220 -png "$pictures/figure_3.png"
show draw_medial_axis "$pictures/figure_3_medial_axis.png" 220 rectangle.pcd bump.pcd

figure_7() {
  show pcl_symmetry_viewer cow.off -up 0,1,0 -width 480 -height 360 -keys "$2" -screenshot "$pictures/figure_7_step_$1.png"
}
figure_7 1 i
figure_7 2 i,i
figure_7 5 i,i,i,i,i
show pcl_symmetry_viewer cow.off -up 0,1,0 -width 480 -height 360 -keys g -screenshot "$pictures/figure_7_support.png"

figure_8() {
  show pcl_symmetry_viewer bull.off -up 0,1,0 -width 480 -height 360 -keys "$2" -screenshot "$pictures/figure_8_$1.png"
}
figure_8 1 v
figure_8 2 n
figure_8 4 n,n,n
figure_8 7 n,n,n,n,n,n

for model in cow elephant; do
  show pcl_symmetry_viewer "$model.off" -up 0,1,0 -width 480 -height 360 -keys g,s,a -screenshot "$pictures/figure_10_$model.png"
done

show draw_scan_centers "$pictures/figure_11.png" car.ply

figure_15() {
  local name=$1
  shift
  show pcl_symmetry_segment "$@" -size 240 -png "$pictures/figure_15_$name.png"
}
figure_15 bull_2 bull.off -up 0,1,0 -method splitting -depth 1
figure_15 bull_4 bull.off -up 0,1,0 -method splitting -depth 2
figure_15 bull_8 bull.off -up 0,1,0 -method splitting -depth 3
figure_15 bull bull.off -up 0,1,0
figure_15 hand_4 hand.off -up 0,1,0 -method splitting -depth 2
figure_15 hand hand.off -up 0,1,0
figure_15 teapot teapot.ply
figure_15 octopus octopus.ply
show pcl_symmetry_scan elephant.off elephant_scan.pcd
figure_15 scan elephant_scan.pcd -up 0,1,0 -evidence concavity

for model in bull cow elephant hand; do
  show pcl_symmetry_viewpoint "$model.off" -up 0,1,0 -size 150 -png "$pictures/figure_16_$model.png"
done
for model in teapot mug chair car airplane carton; do
  show pcl_symmetry_viewpoint "$model.ply" -size 150 -png "$pictures/figure_16_$model.png"
done
rm -f "$pictures/last.txt"
echo "Pictures: $pictures"
