#!/usr/bin/env bash
# study.sh [LAUNCHER...]: the refinement study leaves its table, with an extrapolated value for the RMS.
. "$(dirname "$0")/common.sh"

expect 0 "$@" "$TAUTLINE" study "$SOURCE/inputs/dish_4m.yaml" --subdivisions 2,4,6 -o "$WORK/study" --quiet --no-pictures
has "$WORK/study"/{study.json,study.csv}
says "$WORK/out" 'extrapolated'
[ "$(wc -l <"$WORK/study/study.csv")" -eq 4 ] || fail "study.csv has not three rows"
expect 0 "$COMPARE" "$WORK/study/study.json" "$WORK/study/study.json"
for s in 2 4 6; do valid "$WORK/study/s$s" done; done
done_testing
