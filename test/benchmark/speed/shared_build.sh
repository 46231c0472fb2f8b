#!/bin/bash
# What a database costs that several processes build: shared_build.sh TOOLS MESHES NUMBER PROCESSES...
#
# Builds a database of NUMBER models, those of the folder MESHES again and again under other names, by one process without
# mpirun, and then by each number of processes. Prints wall and processor time, memory of the largest process, bytes of the
# file, and whether it holds the same as that of one process.
set -e
if [ $# -lt 4 ]; then
  sed -n '2,6s/^# \?//p' "$0"
  exit 2
fi
tools=$(realpath "$1") meshes=$(realpath "$2") number=$3
shift 3
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
mkdir models
for ((i = 0; i < number;)); do
  for mesh in "$meshes"/*.off; do
    [ $i -lt "$number" ] || break
    ln -s "$mesh" "models/$(printf '%07d' $i)_$(basename "$mesh")"
    i=$((i + 1))
  done
done
contents() {
  "$tools"/pcl_symmetry_database list "$1" -json list.json >list.txt
  grep -v '"time"' list.json | md5sum
}
measure() { # NAME COMMAND...
  local name=$1
  shift
  # Meshes that cannot be used are left out, with exit status 1.
  /usr/bin/time -o time.txt -f '%e %U %S %M' "$@" build "$name.db" models -threads 1 -quiet 2>errors.txt || true
  read -r wall user system memory < <(tail -n 1 time.txt)
  same=$([ "$(contents "$name.db")" = "$(contents one.db)" ] && echo same || echo DIFFERENT)
  awk -v n="$name" -v m="$number" -v w="$wall" -v u="$user" -v s="$system" -v k="$memory" -v b="$(stat -c %s "$name.db")" -v e="$same" \
    'BEGIN { printf "%-12s %8d models %8.1f s wall %8.1f s of processors, %5.1f ms each %6.0f MB memory %8.1f kB each on disk  %s\n",
             n, m, w, u + s, 1000 * (u + s) / m, k / 1024, b / m / 1000, e }'
}
measure one "$tools"/pcl_symmetry_database
for processes in "$@"; do
  measure "$processes" mpirun -n "$processes" --allow-run-as-root --oversubscribe --bind-to none "$tools"/pcl_symmetry_database
done
