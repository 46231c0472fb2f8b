#!/usr/bin/env bash
# Makes the pictures of all pages.
set -euo pipefail

usage() {
  cat <<'END'
usage: bash apps/gallery/make.sh [-h] [--estimators] [--only REGEX] [FOLDER]

Builds the tools, fetches or makes the models (Debian package libcgal-demo, own shapes) and writes the pictures of
the pages to FOLDER/gallery and FOLDER/pictures (build/pictures). FOLDER = apps replaces the pictures of the pages.
Prints each command. Needs no screen.

  --estimators  also the chart of the estimators' error against time: minutes
  --only REGEX  only pictures whose name matches, such as figure_15

example: bash apps/gallery/make.sh --only cow
END
}

estimators=false only=.
while (($# > 0)); do
  case "$1" in
    -h | --help) usage; exit 0 ;;
    --estimators) estimators=true ;;
    --only)
      (($# >= 2)) || { usage >&2; exit 2; }
      only=$2
      shift ;;
    -*) usage >&2; exit 2 ;;
    *) break ;;
  esac
  shift
done
(($# <= 1)) || { usage >&2; exit 2; }
folder=$(realpath -m "${1-build/pictures}")
gallery=$folder/gallery pictures=$folder/pictures

cd "$(dirname "${BASH_SOURCE[0]}")/../.."
cmake --preset release --log-level=WARNING >/dev/null
cmake --build build --parallel "$(nproc)" --target pcl_symmetry_map pcl_symmetry_planes \
  pcl_symmetry_scan pcl_symmetry_scene pcl_symmetry_segment pcl_symmetry_viewpoint \
  pcl_symmetry_python pcl_symmetry_python_recognition
repository=$PWD
export PATH=$PWD/build/apps:$PATH PYTHONPATH=$PWD/build/src/python
python=/usr/bin/python3

models=$PWD/build/pictures_models
mkdir -p "$gallery" "$pictures" "$models"
bash apps/fetch_meshes.sh "$models" bull camel cow dino elephant hand
"$python" -B apps/gallery/shapes.py "$models"
cp apps/gallery/planar.py "$models"
drawings=("$python" -B "$PWD/apps/gallery/drawings.py")
planar=("$python" -B "$PWD/apps/gallery/planar.py")
cd "$models"

# draw PICTURE COMMAND...: prints and runs a command that draws the picture; its output only if it fails.
draw() {
  local picture=$1
  shift
  [[ $picture =~ $only ]] || return 0
  echo "$*"
  "$@" >"$models/last.txt" 2>&1 || { cat "$models/last.txt" >&2; exit 1; }
}

draw_scans_and_parts() {
  pcl_symmetry_scan cow.off cow_scan.pcd -quiet
  draw first_look "${drawings[@]}" first_look "$pictures/first_look.png" cow.off
  draw bull_parts pcl_symmetry_planes bull.off -approximate -max_planes 6 -up 0,1,0 -png "$pictures/bull_parts.png"
  draw frames "${drawings[@]}" frames "$pictures/frames.png"
}

draw_figure_1() {
  draw figure_1_contours "${planar[@]}" "$gallery/figure_1_contours.png" --size 150 "mug 0" "mug 0.45" "flower 5" "flower 4" "flower 3"
  local model
  for model in 0.2 0.5 1; do
    draw "scale_$model" pcl_symmetry_map bull.off -scale "$model" -size 280 -png "$gallery/scale_$model.png"
  done
  for model in bull cow; do
    draw "figure_1_$model" pcl_symmetry_map "$model.off" -size 200 -slices "$gallery/figure_1_$model.png"
  done
}

draw_figure_2() {
  draw figure_2 "${planar[@]}" "$gallery/figure_2.png" --columns 6 --size 100 "polygon "{3,4,5,6,8,48} \
    "rectangle 1 "{1.0,0.9,0.8,0.7,0.6,0.5} "starfish 0.0"{0,1,2,4,6,8}
}

draw_figure_3() {
  draw figure_3 "${planar[@]}" "$gallery/figure_3.png" "rectangle 1 0.5" "rectangle 1 0.5 0.1"
  draw figure_3_medial_axis "${drawings[@]}" medial_axis "$gallery/figure_3_medial_axis.png" "rectangle 1 0.5" "rectangle 1 0.5 0.1"
}

# draw_parts PICTURE ARGUMENTS...
draw_parts() {
  local picture=$1
  shift
  draw "$picture" pcl_symmetry_segment "$@" -size 240 -png "$gallery/$picture.png"
}

draw_figure_15() {
  draw_parts figure_15_bull_2 bull.off -up 0,1,0 -method splitting -depth 1
  draw_parts figure_15_bull_4 bull.off -up 0,1,0 -method splitting -depth 2
  draw_parts figure_15_bull_8 bull.off -up 0,1,0 -method splitting -depth 3
  draw_parts figure_15_bull bull.off -up 0,1,0
  draw_parts figure_15_hand_4 hand.off -up 0,1,0 -method splitting -depth 2
  draw_parts figure_15_hand hand.off -up 0,1,0
  draw_parts figure_15_teapot_4 teapot.ply -method splitting -as_published -depth 2
  draw_parts figure_15_teapot teapot.ply
  draw_parts figure_15_octopus_8 octopus.ply -method splitting -as_published -depth 4
  draw_parts figure_15_octopus octopus.ply
  draw_parts figure_15_dino_8 dino.off -up 0,-1,0 -method splitting -as_published -depth 3
  draw_parts figure_15_dino dino.off -up 0,-1,0
  pcl_symmetry_scan elephant.off elephant_scan.pcd -quiet
  draw_parts figure_15_scan elephant_scan.pcd -up 0,1,0 -evidence concavity
}

draw_figure_16() {
  local model
  for model in bull cow elephant hand; do
    draw "figure_16_$model" pcl_symmetry_viewpoint "$model.off" -up 0,1,0 -size 150 -png "$gallery/figure_16_$model.png"
  done
  for model in teapot mug chair car airplane carton; do
    draw "figure_16_$model" pcl_symmetry_viewpoint "$model.ply" -size 150 -png "$gallery/figure_16_$model.png"
  done
  draw figure_16_published pcl_symmetry_viewpoint chair.ply -as_published -size 150 -png "$gallery/figure_16_published.png"
}

# Beyond the paper: the transform of turns about axes.
draw_axes() {
  local model
  for model in propeller rim bottle chair; do
    draw "axes_$model" pcl_symmetry_map "$model.ply" -of axes -size 260 -png "$gallery/axes_$model.png"
  done
}

draw_decision() {
  local frame=${PCL_SYMMETRY_SCANS-$repository/../shared/data/scans}/milk_cartoon_all_small_clorox.pcd
  if [[ -f $frame ]]; then draw decision "${drawings[@]}" decision "$gallery/decision.png" "$frame" 1 4 3; fi
}

# Where algorithms go wrong, for their pages.
draw_failures_of_all() {
  draw failure_transform pcl_symmetry_map hand.off -size 200 -slices "$gallery/failure_transform.png"
  pcl_symmetry_scan mug.ply mug_scan.pcd -direction=-1,0,0.3 -quiet
  draw failure_planes pcl_symmetry_planes mug_scan.pcd -png "$gallery/failure_planes.png"
  pcl_symmetry_scan cow.off cow_scan.pcd -quiet
  draw failure_scene pcl_symmetry_scene cow_scan.pcd -png "$gallery/failure_scene.png"
  local name
  for name in frame completion; do
    draw "failure_$name" "${drawings[@]}" "failure_$name" "$gallery/failure_$name.png" hand.off
  done
  for name in pose name rotations volume; do
    draw "failure_$name" "${drawings[@]}" "failure_$name" "$gallery/failure_$name.png"
  done
}

draw_scans_and_parts
draw_figure_1
draw_figure_2
draw_figure_3
draw figure_7 "${drawings[@]}" refinement "$gallery/figure_7.png" cow.off
draw figure_10 "${drawings[@]}" animals "$gallery/figure_10.png" cow.off elephant.off
draw volume "${drawings[@]}" volume "$gallery/volume.png"
draw figure_11 "${drawings[@]}" scan_centers "$gallery/figure_11.png" car.ply
draw_figure_15
draw_figure_16
draw_axes
draw scene "${drawings[@]}" scene "$gallery/scene.png" teapot.ply bottle.ply chair.ply
draw_decision
draw_failures_of_all
if $estimators; then
  draw error_against_time "$python" "$repository/test/benchmark/error_against_time.py" "$pictures/error_against_time.png" \
    {bull,cow,elephant,hand,camel}.off
fi
rm -f "$models/last.txt"
echo "Pictures: $gallery $pictures"
