#!/usr/bin/env bash
# A page that a tool wrote opens in a browser without network. Without Chromium the test is skipped (77).
set -euo pipefail

case "${1-}" in
  -h | --help)
    echo "usage: bash test/tools/check_page.sh [-h] APPS [PICTURE.png]"
    echo "Writes pages of a box with pcl_symmetry_planes and pcl_symmetry_align of the folder APPS, opens them in headless Chromium and"
    echo "looks whether their scripts came to their end. With PICTURE.png keeps a screenshot of the planes."
    exit 0 ;;
  "") echo "check_page.sh: missing folder of the tools" >&2; exit 2 ;;
esac
chromium=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
  echo "check_page.sh: skipped, Chromium is not installed (Debian package chromium)"
  exit 77
}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cat >"$work/box.off" <<'END'
OFF
8 6 0
-1 -1.5 -2
1 -1.5 -2
1 1.5 -2
-1 1.5 -2
-1 -1.5 2
1 -1.5 2
1 1.5 2
-1 1.5 2
4 0 3 2 1
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
4 3 0 4 7
END
"$1/pcl_symmetry_planes" "$work/box.off" -quiet -html "$work/box.html" >/dev/null
"$1/pcl_symmetry_align" "$work/box.off" -quiet -target "$work/box.off" -html "$work/pose.html" >/dev/null
# browse PAGE ARGUMENT...
# A proxy that is not there: what the page asked of the network would fail.
browse() {
  local page=$1
  shift
  timeout 300 "$chromium" --headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update \
    --disable-sync --disable-quic --proxy-server=127.0.0.1:9 --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
    --user-data-dir="$work/profile" --window-size=1300,800 --virtual-time-budget=4000 "$@" "file://$work/$page.html" 2>"$work/log"
}
if (($# > 1)); then browse box --screenshot="$(realpath "$2")"; fi
echo '<script>{ const t = document.getElementById("text"); document.body.dataset.cut = t.scrollWidth > t.clientWidth; }</script>' >>"$work/box.html"
for page in box pose; do
  browse $page --dump-dom >"$work/$page"
  grep -q 'data-ready="true"' "$work/$page" || {
    echo "check_page.sh: the script of the page did not come to its end: $page" >&2
    tail -5 "$work/log" >&2
    exit 1
  }
done
grep -q 'data-cut="false"' "$work/box" || { echo "check_page.sh: the table of planes is cut off" >&2; exit 1; }
[[ $(grep -o '<button class=' "$work/box" | wc -l) == 3 ]] || { echo "check_page.sh: the page does not list three planes" >&2; exit 1; }
[[ $(grep -o '<span class="swatch"' "$work/pose" | wc -l) == 2 ]] || { echo "check_page.sh: the pose has no two colors" >&2; exit 1; }
echo "The pages open and list three planes, and two clouds in one frame."
