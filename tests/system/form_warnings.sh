#!/usr/bin/env bash
# What form-finding finds and warns of.
source "$(dirname "$0")/common.sh"
here=$(cd "$(dirname "$0")" && pwd)

# T (w/l) 2 = 200 N with T = EA (l/L0 - 1), l^2 = 1 + w^2, L0 = 1/(1 + 100/EA): 505.399 N.
expect 0 "$TAUTLINE" run "$here/decks/relaxed_rope.yaml" -o "$WORK/rope" --no-pictures
says "$WORK/rope/results.json" 'rope.* was given 100 N and carries 505.399 to 505.399 N.*constant_tension: \[rope\]'
# With its tension kept it carries what it was given, and says nothing: 2 x 100 N x 0.1 under 20 N.
sed 's/dynamic_relaxation,/dynamic_relaxation, constant_tension: [rope],/; s/-200\]/-20]/' "$here/decks/relaxed_rope.yaml" >"$WORK/kept.yaml"
expect 0 "$TAUTLINE" run "$WORK/kept.yaml" -o "$WORK/kept" --no-pictures
if grep -q 'was given' "$WORK/kept/results.json"; then fail 'a rope of constant tension is said to have changed it'; fi

# Unequal stresses on Scherk's surface: no mesh can mend that; the range that was met is told.
film="$SOURCE/verification/form_film_meshes"
sed "s|prestress: 1}|prestress: [2, 1], orientation: [1, 0, 0]}|; s|\"\${mesh}.msh\"|\"$film/\${mesh}.msh\"|" "$film/deck.yaml" >"$WORK/uneven.yaml"
"$TAUTLINE" run "$WORK/uneven.yaml" -o "$WORK/uneven" --no-pictures >"$WORK/out" 2>&1 || true
says "$WORK/uneven/results.json" 'principal stresses of [0-9.]+ to [0-9.]+ N/m.*2 N/m along and 1 N/m across.*geodesics'
done_testing
