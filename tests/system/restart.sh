#!/usr/bin/env bash
# restart.sh [LAUNCHER...]: a run that was killed goes on from its checkpoints to the same numbers, on as many ranks or fewer; a deck
# of which only later steps differ takes up what is done; another structure is refused.
. "$(dirname "$0")/common.sh"

signal=KILL
[ $# -eq 0 ] || signal=TERM     # mpirun passes it on to its processes
launcher=("$@")

# interrupted NAME DECK [OPTION...]: runs it whole into NAME, broken off within a step, and resumed; displacements agree to 1e-10 of the largest.
interrupted() {
  local whole=$WORK/$1 broken=$WORK/$1_broken resumed=$WORK/$1_resumed deck=$2
  shift 2
  expect 0 "$TAUTLINE" run "$deck" -o "$whole" "$@"
  "${launcher[@]}" "$TAUTLINE" run "$deck" -o "$broken" "$@" >"$WORK/out" 2>"$WORK/err" &
  local pid=$!
  for _ in $(seq 600); do
    [ ! -s "$broken/checkpoints/point.bin" ] || break
    sleep 0.02
  done
  kill -"$signal" "$pid" 2>/dev/null || true
  wait "$pid" 2>/dev/null || true
  has "$broken/checkpoints/point.bin"
  expect 0 "$TAUTLINE" run "$deck" -o "$resumed" --from "$broken" "$@"
  valid "$resumed" done
  says "$resumed/results.json" '"resumed"'
  paste -d, "$whole/nodes.csv" "$resumed/nodes.csv" | awk -F, '
    NR == 1 { n = NF / 2; next }
    { for (i = 2; i <= n; ++i) if ($i + 0 == $i) { d = $i - $(i + n); if (d < 0) d = -d; if (d > worst) worst = d
        u = $i < 0 ? -$i : $i; if (i >= 9 && u > most) most = u } }
    END { exit !(worst <= 1e-10 * most + 1e-15) }' || fail "the resumed run of $deck came to other displacements"
}

deck=$SOURCE/inputs/frame.yaml
whole=$WORK/frame
options=(--quiet --no-pictures --set 'steps.vertical and side.increments=400')
interrupted frame "$deck" "${options[@]}"
# A path followed by its length goes on from its last point, critical points and all.
interrupted lee "$SOURCE/inputs/lee_frame.yaml" --quiet --no-pictures --set steps.path.arc_length.largest_step=0.1 --set steps.path.arc_length.max_points=10000
points() { sed -n '/"critical_points"/,/\]/p' "$1/results.json" | grep -E '"(kind|lambda|stage)"' | tr -d ' ,"'; }
# Load factors to 1e-8: what two ranks sum up differs in the last digits from run to run.
paste -d: <(points "$WORK/lee") <(points "$WORK/lee_resumed") | awk -F: '
  $1 != $3 { exit worst = 1 }
  $1 == "lambda" { ++n; d = $2 - $4; if (d < 0) d = -d; if (d > 1e-8 * ($2 < 0 ? -$2 : $2)) worst = 1; next }
  $2 != $4 { worst = 1 }
  END { exit worst || n == 0 }' || fail "the resumed path has other critical points"
says "$WORK/lee/results.json" '"limit"'

expect 0 "$TAUTLINE" run "$deck" -o "$WORK/more" --from "$whole" "${options[@]}" --set steps.modal.modes=6
says "$WORK/more/results.json" '"steps": 3'
expect 0 "$TAUTLINE" run "$deck" -o "$WORK/again" --from "$whole" "${options[@]}"   # nothing is left to do but the tables
[ "$(wc -l <"$WORK/again/reactions.csv")" -eq "$(wc -l <"$whole/reactions.csv")" ] || fail "reactions are missing after a resumption"
expect 5 "$TAUTLINE" run "$deck" -o "$WORK/other" --from "$whole" --quiet --set parameters.side=2000
says "$WORK/err" 'another structure'
expect 5 "$TAUTLINE" run "$deck" -o "$WORK/other" --from "$WORK/nowhere" --quiet
says "$WORK/err" 'no checkpoints'
done_testing
