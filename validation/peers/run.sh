#!/usr/bin/env bash
# Runs the peers that are installed and keeps what they say in validation/peers/results.
set -euo pipefail
here=$(dirname -- "${BASH_SOURCE[0]}")
case ${1:-} in
  -h | --help)
    echo "usage: validation/peers/run.sh [FOLDER]   (default: validation/peers/results)"
    exit 0
    ;;
esac
results=${1:-$here/results}
if ! command -v blender >/dev/null; then
  echo "validation/peers: skipped, there is no blender in PATH; the report shows the stored results"
  exit 0
fi
# Blender ends with 0 even after an error in the script, so that what it wrote is what counts.
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
blender -b --factory-startup --python-exit-code 1 -P "$here/blender_cloth.py" -- "$fresh"
for scene in hang drape_sphere; do
  [[ -s $fresh/blender_$scene.json ]] || { echo "validation/peers: Blender wrote no $scene" >&2; exit 1; }
done
mkdir -p "$results"
cp "$fresh"/blender_*.json "$results"/
