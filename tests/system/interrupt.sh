#!/usr/bin/env bash
# interrupt.sh [LAUNCHER...]: Ctrl-C in the middle of a long run leaves a valid results.json that says so, and what was reached.
. "$(dirname "$0")/common.sh"

out=$WORK/results
"$@" "$TAUTLINE" run "$SOURCE/inputs/perimeter_truss_12m.yaml" -o "$out" --quiet --no-pictures --set parameters.subdivisions=12 \
  >"$WORK/out" 2>"$WORK/err" &
pid=$!
for _ in $(seq 600); do   # until the mesh step is over and the equilibrium begins
  grep -qs '"subdivisions": 12,' "$out/results.json" && break
  sleep 0.1
done
sleep 0.5
kill -INT "$pid"
start=$SECONDS code=0
wait "$pid" || code=$?
[ "$code" -eq 130 ] || fail "exit code $code, not 130"
[ $((SECONDS - start)) -le 60 ] || fail "it took $((SECONDS - start)) s to stop"
valid "$out" interrupted
says "$out/results.json" '"kind": "mesh"'
has "$out"/{nodes.csv,form_finding_nodes.csv}
done_testing
