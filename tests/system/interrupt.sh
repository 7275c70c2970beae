#!/usr/bin/env bash
# interrupt.sh: a signal in the middle of a long run ends it soon, with a valid results.json that says so and names the step, what was
# reached, and no word of a solver that failed.
. "$(dirname "$0")/common.sh"

out=$WORK/results
for signal in INT TERM HUP; do
  rm -rf "$out"
  "$TAUTLINE" run "$SOURCE/inputs/perimeter_truss_12m.yaml" -o "$out" --quiet --no-pictures --set parameters.subdivisions=12 \
    >"$WORK/out" 2>"$WORK/err" &
  pid=$!
  for _ in $(seq 600); do   # until the mesh step is over and the equilibrium runs
    grep -qs '"kind": "equilibrium"' "$out/results.json" && break
    sleep 0.1
  done
  says "$out/results.json" '"reason": "the run ended within this step"'   # as a kill now would leave it
  sleep 0.5
  kill -"$signal" "$pid"
  start=$SECONDS code=0
  wait "$pid" || code=$?
  [ "$code" -eq 130 ] || fail "exit code $code, not 130, after $signal"
  [ $((SECONDS - start)) -le 5 ] || fail "it took $((SECONDS - start)) s to stop"   # 1.5 s, and what a loaded machine adds
  valid "$out" interrupted
  says "$out/results.json" '"kind": "mesh"'
  [ "$(grep -c '^      "status": "interrupted"' "$out/results.json")" -eq 1 ] || fail "not one step is interrupted"
  ! grep -q 'NOT CONVERGED\|not_converged' "$WORK/out" "$out/results.json" || fail "a solver is blamed for the signal"
done
done_testing
