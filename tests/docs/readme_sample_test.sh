#!/usr/bin/env bash
# The C++ sample of README.md equals the compiled one. Usage: readme_sample_test.sh SOURCE_DIR
set -eu
source_dir=$1
in_readme=$(sed -n '/^```cpp$/,/^```$/p' "$source_dir/README.md" | sed '1d;$d')
compiled=$(sed -n '/\/\/ README sample$/,/\/\/ README sample end$/p' "$source_dir/tests/docs/readme_sample.cpp" | sed '1d;$d' | sed 's/^  //')
if [ "$in_readme" != "$compiled" ]; then
  diff <(echo "$in_readme") <(echo "$compiled") || true
  echo "README.md's sample differs from tests/docs/readme_sample.cpp"
  exit 1
fi
