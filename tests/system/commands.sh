#!/usr/bin/env bash
# The commands that solve nothing.
. "$(dirname "$0")/common.sh"

expect 0 "$TAUTLINE" --version
says "$WORK/out" '^tautline [0-9]+\.[0-9]+\.[0-9]+$'
expect 0 "$TAUTLINE" --help
says "$WORK/out" 'run a deck'
for command in run check study new explain schema report compare; do
  expect 0 "$TAUTLINE" "$command" --help
  says "$WORK/out" 'Example: tautline '"$command"
done

for deck in "$SOURCE"/inputs/*.yaml; do
  expect 0 "$TAUTLINE" check "$deck"
  has "$WORK/out"
done

for kind in perimeter-truss umbrella net membrane frame rod-umbrella; do
  expect 0 "$TAUTLINE" new "$kind"
  says "$WORK/out" '^# '
  cp "$WORK/out" "$WORK/$kind.yaml"
  expect 0 "$TAUTLINE" check "$WORK/$kind.yaml"
  expect 0 bash -c "'$TAUTLINE' new $kind | '$TAUTLINE' check /dev/stdin"
  expect 0 "$TAUTLINE" run "$WORK/$kind.yaml" -o "$WORK/$kind" --quiet --no-pictures
  valid "$WORK/$kind" done
done
expect 2 "$TAUTLINE" new perimeter-trus
says "$WORK/err" 'perimeter-truss'

expect 0 "$TAUTLINE" explain
says "$WORK/out" 'reflector'
expect 0 "$TAUTLINE" explain reflector.gap
says "$WORK/out" '\bm\b'
expect 0 "$TAUTLINE" explain steps.tuning.method
expect 2 "$TAUTLINE" explain reflector.gab
says "$WORK/err" 'gap'

expect 0 "$TAUTLINE" schema
cp "$WORK/out" "$WORK/schema.json"
expect 0 "$COMPARE" "$WORK/schema.json" "$WORK/schema.json"

expect 0 "$TAUTLINE" compare "$WORK/net" "$WORK/frame"
says "$WORK/out" '[0-9]'
rm "$WORK/net/report.html"
expect 0 "$TAUTLINE" report "$WORK/net"
has "$WORK/net/report.html"
expect 0 "$TAUTLINE" report "$WORK/net" "$WORK/frame"
expect 5 "$TAUTLINE" report "$WORK/nowhere"
says "$WORK/err" 'nowhere'
done_testing
