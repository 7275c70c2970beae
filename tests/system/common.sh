# Helpers of the system tests. A script that includes this gets: program, compare, work (an empty directory of its own), source.

set -euo pipefail
: "${TAUTLINE:?path of the program}" "${COMPARE:?path of compare_results}" "${WORK:?directory to work in}" "${SOURCE:?the repository}"
rm -rf "$WORK"
mkdir -p "$WORK"

failures=0
fail() { printf 'FAILED: %s\n' "$*" >&2; failures=$((failures + 1)); }

# expect CODE COMMAND...: runs the command with its output in $WORK/out and $WORK/err, and wants this exit code.
expect() {
  local wanted=$1 code=0
  shift
  "$@" >"$WORK/out" 2>"$WORK/err" || code=$?
  [ "$code" -eq "$wanted" ] && return
  fail "exit code $code, not $wanted: $*"
  head -n 20 "$WORK/err" >&2
}

# says FILE TEXT: the file has the text, an extended regular expression.
says() { grep -Eq -- "$2" "$1" || { fail "$1 does not say \"$2\". It says:"; head -n 12 "$1" >&2; }; }

# valid DIR STATUS: DIR/results.json is whole and has that status.
valid() {
  "$COMPARE" "$1/results.json" "$1/results.json" >/dev/null || { fail "$1/results.json is no valid JSON"; return 0; }
  says "$1/results.json" "^  \"status\": \"$2\""
}

# has FILE...: the files exist and are not empty.
has() { local file; for file in "$@"; do [ -s "$file" ] || fail "$file is missing or empty"; done; }

# nothing_in DIR: it does not exist or holds nothing.
nothing_in() { [ -z "$(ls -A "$1" 2>/dev/null)" ] || { fail "$1 holds what a failed run left:"; ls -A "$1" >&2; }; }

done_testing() { [ "$failures" -eq 0 ] || { printf '%s failures\n' "$failures" >&2; exit 1; }; }
