#!/usr/bin/env bash
# Makes three.min.js of the package three of npm, with the classes that viewer.js uses.
set -euo pipefail

version=0.170.0 esbuild=0.25.0
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
case "${1-}" in
  -h | --help)
    echo "usage: bash apps/pictures/make_three.sh [-h]"
    echo "Fetches three $version and esbuild $esbuild with npm and writes three.min.js beside this file."
    exit 0 ;;
esac
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
npm init -y >/dev/null
npm install --silent "three@$version" "esbuild@$esbuild"
cat >entry.js <<'END'
export {
  BufferAttribute, BufferGeometry, Color, DirectionalLight, DoubleSide, Group, HemisphereLight, LineBasicMaterial, LineLoop,
  LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PerspectiveCamera, Points, Scene, ShaderMaterial, Vector3, WebGLRenderer
} from 'three';
export {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
END
npx esbuild entry.js --bundle --minify --format=iife --global-name=THREE --legal-comments=none --outfile=three.min.js
{
  echo "/* three.js $version, the classes that viewer.js uses; made by make_three.sh."
  sed 's/^/   /' node_modules/three/LICENSE
  echo "*/"
  cat three.min.js
} >"$here/three.min.js"
