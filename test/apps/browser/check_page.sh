#!/usr/bin/env bash
# A page that a tool wrote opens in a browser without network. Without Chromium the test is skipped (77).
set -euo pipefail

case "${1-}" in
  -h | --help)
    echo "usage: bash test/apps/browser/check_page.sh [-h] APPS [PICTURE.png]"
    echo "Writes a page of a box with pcl_symmetry_planes of the folder APPS, opens it in headless Chromium and looks whether its"
    echo "script came to its end. With PICTURE.png keeps a screenshot."
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
# A proxy that is not there: what the page asked of the network would fail.
browse() {
  timeout 100 "$chromium" --headless --no-sandbox --no-first-run --disable-background-networking --disable-component-update \
    --disable-sync --disable-quic --proxy-server=127.0.0.1:9 --use-gl=angle --use-angle=swiftshader --enable-unsafe-swiftshader \
    --user-data-dir="$work/profile" --window-size=1300,800 --virtual-time-budget=4000 "$@" "file://$work/box.html" 2>"$work/log"
}
if (($# > 1)); then browse --screenshot="$(realpath "$2")"; fi
browse --dump-dom >"$work/dom"
grep -q 'data-ready="true"' "$work/dom" || {
  echo "check_page.sh: the script of the page did not come to its end" >&2
  tail -5 "$work/log" >&2
  exit 1
}
[[ $(grep -o '<button' "$work/dom" | wc -l) == 3 ]] || { echo "check_page.sh: the page does not list three planes" >&2; exit 1; }
echo "The page opens and lists three planes."
