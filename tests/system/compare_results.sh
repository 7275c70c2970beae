#!/usr/bin/env bash
# The comparing tool itself: it passes over times and finds a changed number, a changed word and a lost key.
. "$(dirname "$0")/common.sh"

a=$WORK/a.json b=$WORK/b.json
printf '{"status": "done", "steps": [{"rms": 1.0e-3, "wall_seconds": 1.5}], "program": {"ranks": 1}}' >"$a"
differs() { sed "$1" "$a" >"$b"; expect "$2" "$COMPARE" "$a" "$b"; }

differs 's/1.5}/7.5}/; s/"ranks": 1/"ranks": 2/' 0
differs 's/1.0e-3/1.0000000005e-3/' 0
differs 's/1.0e-3/1.000000002e-3/' 1
says "$WORK/out" '/steps/0/rms'
differs 's/1.0e-3/0/' 1
differs 's/1.0e-3/null/' 1
differs 's/done/not_converged/' 1
differs 's/"rms"/"RMS"/' 1
differs 's/}$//' 2
done_testing
