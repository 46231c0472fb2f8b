#!/usr/bin/env bash
# Do two builds of the tools write the same bytes?
set -euo pipefail

usage() {
  cat <<'END'
usage: bash test/compare_outputs.sh [-h] TOOLS_BEFORE TOOLS_AFTER [FOLDER]

Runs the tools of two folders on the same 54 inputs (whole, scanned, noisy, cut into parts, aligned, matched, turned) and
compares the JSON, PCD and label files that they write, byte by byte but for times. Files go to FOLDER (build/outputs).
Exit status 0 if all are the same.

example: bash test/compare_outputs.sh ../pcl_symmetry_0.1/build/apps build/apps
END
}

case "${1-}" in
  -h | --help) usage; exit 0 ;;
esac
(($# == 2 || $# == 3)) || { usage >&2; exit 2; }
before=$(realpath "$1") after=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
folder=$(realpath -m "${3-build/outputs}")
mkdir -p "$folder/models"
bash apps/fetch_meshes.sh "$folder/models" bull cow elephant hand >/dev/null
/usr/bin/python3 apps/gallery/shapes.py "$folder/models"

# Everything that one build writes, into the current folder.
run_all() {
  local tools=$1 model name
  for model in ../models/*.{off,ply}; do
    name=$(basename "${model%.*}")
    "$tools/pcl_symmetry_scan" "$model" "$name.scan.pcd" -quiet
    "$tools/pcl_symmetry_scan" "$model" "$name.noisy.pcd" -noise 0.005 -quiet
    "$tools/pcl_symmetry_planes" "$model" -json "$name.planes.json" -quiet >"$name.planes.txt" || true
    "$tools/pcl_symmetry_planes" "$name.scan.pcd" -json "$name.scan.json" -support "$name.support.pcd" -quiet >/dev/null || true
    "$tools/pcl_symmetry_planes" "$name.noisy.pcd" -json "$name.noisy.json" -viewpoint none -quiet >/dev/null || true
  done
  for name in bull car octopus hand; do
    "$tools/pcl_symmetry_segment" "$(echo ../models/$name.*)" "$name.seg" -json "$name.segments.json" -quiet >/dev/null
  done
  "$tools/pcl_symmetry_segment" ../models/bull.off bull.splitting.seg -method splitting -quiet >/dev/null
  "$tools/pcl_symmetry_segment" cow.scan.pcd cow.parts.pcd -quiet >/dev/null
  "$tools/pcl_symmetry_planes" ../models/bull.off -approximate -json bull.approximate.json -quiet >/dev/null
  for name in cow mug chair airplane; do
    model=$(echo ../models/$name.*)
    "$tools/pcl_symmetry_align" "$model" "$name.aligned.pcd" -json "$name.frame.json" -quiet >/dev/null
    "$tools/pcl_symmetry_align" "$name.scan.pcd" -target "$model" -json "$name.pose.json" -quiet >/dev/null || true
  done
  "$tools/pcl_symmetry_bop" ../models/{car,carton,chair,mug}.ply -json models_info.json -quiet >/dev/null
  "$tools/pcl_symmetry_map" ../models/cow.off cow.map.pcd -json cow.map.json -quiet >/dev/null
  "$tools/pcl_symmetry_viewpoint" ../models/elephant.off -json elephant.views.json -quiet >/dev/null
  "$tools/pcl_symmetry_describe" descriptors ../models/{cow,bull}.off -quiet >/dev/null
  "$tools/pcl_symmetry_describe" descriptors_prst ../models/cow.off -type prst -quiet >/dev/null
  rm -rf models.db
  "$tools/pcl_symmetry_database" build models.db ../models/*.{off,ply} -quiet >/dev/null
  "$tools/pcl_symmetry_match" models.db cow.noisy.pcd -json cow.match.json -quiet >/dev/null
  "$tools/pcl_symmetry_match" models.db elephant.scan.pcd -recognize -json elephant.recognized.json -quiet >/dev/null || true
}

for build in before after; do
  rm -rf "${folder:?}/$build"
  mkdir -p "$folder/$build"
  (cd "$folder/$build" && run_all "${!build}" && rm -rf models.db)
  # Times are the one thing that may differ: timing_ms holds numbers only.
  find "$folder/$build" -name '*.json' -exec perl -0pi -e 's/"(timing_ms|seconds)": *(\{[^}]*\}|[0-9.e+-]+)/"$1": 0/g' {} +
done
differing=$(diff -rq "$folder/before" "$folder/after" || true)
num_files=$(find "$folder/before" -type f | wc -l)
if [[ -n $differing ]]; then
  echo "$differing"
  echo "compare_outputs.sh: $(wc -l <<<"$differing") of $num_files files differ"
  exit 1
fi
echo "$num_files files, all the same"
