#!/usr/bin/env bash
# run_deck.sh DECK PICTURES [LAUNCHER...]: the deck runs to its end and leaves all its files. PICTURES: with or without.
. "$(dirname "$0")/common.sh"

deck=$1 pictures=$2
shift 2
options=(--quiet)
[ "$pictures" = with ] || options+=(--no-pictures)

expect 0 "$@" "$TAUTLINE" run "$deck" -o "$WORK/results" "${options[@]}"
valid "$WORK/results" done
files=(nodes.csv cables.csv beams.csv cut_list.csv fields.pvd)
if grep -q 'kind: rod-umbrella' "$deck"; then  # an umbrella's tables are those of its rod_shaping steps
  files=()
  while read -r step; do files+=("${step}"_{nodes,rod}.csv); done < <(
    awk -F'"' '/"name":/ {name = $4} /"kind": "rod_shaping"/ {print name}' "$WORK/results/results.json")
  [ ${#files[@]} -gt 0 ] || fail "no rod_shaping step in results.json"
fi
has "$WORK"/out "$WORK/results/report.html" "${files[@]/#/$WORK/results/}"
[ ! -s "$WORK/err" ] || { fail "stderr is not empty with --quiet:"; head -n 5 "$WORK/err" >&2; }
[ -z "$(find "$WORK/results" -name '*.tmp*' -o -name '.tautline_probe*')" ] || fail "temporary files were left"
if [ "$pictures" = with ]; then
  says "$WORK/results/results.json" '"file": "pictures/'
  while read -r picture; do has "$WORK/results/$picture"; done < <(sed -n 's/.*"file": "\(pictures[^"]*\)".*/\1/p' "$WORK/results/results.json")
fi
done_testing
