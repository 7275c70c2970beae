#!/usr/bin/env bash
# clang-format 14 over every source. Without arguments it rewrites; with --check it only names the files that differ.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

command -v clang-format >/dev/null || { echo "format: clang-format is not installed (apt-get install clang-format)" >&2; exit 2; }
mapfile -d '' files < <(find include src tests verification/metamorphic \( -name '*.hpp' -o -name '*.cpp' \) -print0 | sort -z)

if [ "${1:-}" != --check ]; then
  clang-format -i "${files[@]}"
  exit
fi
bad=0
for file in "${files[@]}"; do
  if ! clang-format "$file" | cmp -s - "$file"; then
    echo "format: $file"
    bad=$((bad + 1))
  fi
done
echo "format: $bad of ${#files[@]} files differ from .clang-format$([ "$bad" -eq 0 ] || echo "; scripts/format.sh puts them right")"
[ "$bad" -eq 0 ]
