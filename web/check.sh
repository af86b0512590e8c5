#!/bin/sh
# Types, then a fresh build; fails if it differs from the committed dist/report.html in any byte.
set -eu
cd "$(dirname "$0")"
npx --no-install tsc --noEmit
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
npx --no-install vite build --outDir "$fresh" --logLevel warn
if ! cmp "$fresh/report.html" dist/report.html; then
  echo "web/dist/report.html is not what web/src gives; run: npm run build" >&2
  exit 1
fi
echo "web: types are right and dist/report.html is up to date"
