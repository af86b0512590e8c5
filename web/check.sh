#!/bin/sh
# Types, then fresh builds; fails if one differs from the committed page in dist/ in any byte.
set -eu
cd "$(dirname "$0")"
npx --no-install tsc --noEmit
fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
for page in report player; do
  npx --no-install vite build --mode "$page" --outDir "$fresh" --logLevel warn
  if ! cmp "$fresh/$page.html" "dist/$page.html"; then
    echo "web/dist/$page.html is not what web/src gives; run: npm run build" >&2
    exit 1
  fi
done
echo "web: types are right and the pages in dist/ are up to date"
