#!/bin/bash
# What databases cost that several processes build: shared_build.sh TOOLS MESHES [-points N] [-together] NUMBERxPROCESSES...
#
# Builds databases of NUMBER models, those of the folder MESHES again and again under other names, each by PROCESSES processes
# that mpirun starts, 0: by one without mpirun. Prints wall and processor time, memory of the largest process, bytes of the
# file, and whether it holds the same as the first one of as many models. -points N: points of a model, 20 000 where it is not
# given. -together: all at the same time, on a machine with a core for each process.
set -e
if [ $# -lt 3 ]; then
  sed -n '2,7s/^# \?//p' "$0"
  exit 2
fi
tools=$(realpath "$1") meshes=$(realpath "$2")
shift 2
points=20000 together=
while [ "${1:0:1}" = - ]; do
  case $1 in
    -points) points=$2 && shift 2 ;;
    -together) together=1 && shift ;;
    *) echo "unknown flag $1" >&2 && exit 2 ;;
  esac
done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
list() { # NUMBER: makes a folder of as many models
  [ -d "models$1" ] && return
  mkdir "models$1"
  local i=0
  while [ $i -lt "$1" ]; do
    for mesh in "$meshes"/*.off; do
      [ $i -lt "$1" ] || break
      ln -s "$mesh" "models$1/$(printf '%07d' $i)_$(basename "$mesh")"
      i=$((i + 1))
    done
  done
}
build() { # NUMBER PROCESSES
  local start=
  [ "$2" = 0 ] || start="mpirun -n $2 --allow-run-as-root --oversubscribe --bind-to none"
  # Meshes that cannot be used are left out, with exit status 1.
  /usr/bin/time -o "$1x$2.txt" -f '%e %U %S %M' $start "$tools"/pcl_symmetry_database build "$1x$2.db" "models$1" \
    -points "$points" -threads 1 -quiet 2>"$1x$2.errors" || true
}
contents() { # NUMBER PROCESSES
  "$tools"/pcl_symmetry_database list "$1x$2.db" -json "$1x$2.json" >"$1x$2.list"
  grep -v '"time"' "$1x$2.json" | md5sum
}
declare -A first
report() { # NUMBER PROCESSES
  local wall user system memory same
  read -r wall user system memory < <(tail -n 1 "$1x$2.txt")
  first[$1]=${first[$1]:-$(contents "$1" "$2")}
  same=$([ "$(contents "$1" "$2")" = "${first[$1]}" ] && echo same || echo DIFFERENT)
  awk -v n="$1" -v p="$2" -v w="$wall" -v u="$user" -v s="$system" -v k="$memory" -v b="$(stat -c %s "$1x$2.db")" -v e="$same" \
    'BEGIN { printf "%8d models %3d processes %8.1f s wall %8.1f s of processors, %5.1f ms each %6.0f MB memory %8.1f kB each on disk  %s\n",
             n, p, w, u + s, 1000 * (u + s) / n, k / 1024, b / n / 1000, e }'
}
for job in "$@"; do
  list "${job%x*}"
  build "${job%x*}" "${job#*x}" &
  [ -n "$together" ] || wait $!
done
wait
for job in "$@"; do report "${job%x*}" "${job#*x}"; done
