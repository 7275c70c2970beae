#!/usr/bin/env bash
# study.sh [LAUNCHER...]: the refinement study leaves its table, with an extrapolated value for the RMS; a study over parameters
# goes on past a run that fails.
. "$(dirname "$0")/common.sh"

expect 0 "$@" "$TAUTLINE" study "$SOURCE/inputs/dish_4m.yaml" --subdivisions 2,4,6 -o "$WORK/study" --quiet --no-pictures
has "$WORK/study"/{study.json,study.csv}
says "$WORK/out" 'extrapolated'
[ "$(wc -l <"$WORK/study/study.csv")" -eq 4 ] || fail "study.csv has not three rows"
expect 0 "$COMPARE" "$WORK/study/study.json" "$WORK/study/study.json"
for s in 2 4 6; do valid "$WORK/study/s$s" done; done

rms='RMS [m]=/steps/tuning/surface/rms'
expect 4 "$@" "$TAUTLINE" study "$SOURCE/inputs/dish_4m.yaml" --over subdivisions=2,0 --over net_tension=5 --report "$rms" -o "$WORK/over" --quiet --no-pictures
has "$WORK/over"/{study.json,study.csv}
says "$WORK/out" '^ +0 +5 +- .*subdivisions = 0 is out of range'
[ "$(grep -c ',done,' "$WORK/over/study.csv")" -eq 1 ] || fail "one run should have come to its end"
valid "$WORK/over/subdivisions=2,net_tension=5" done
expect 2 "$@" "$TAUTLINE" study "$SOURCE/inputs/dish_4m.yaml" --over net_tensions=5 -o "$WORK/none" --quiet
says "$WORK/err" 'no parameter "net_tensions"'
says "$WORK/err" 'did you mean "net_tension"'
done_testing
